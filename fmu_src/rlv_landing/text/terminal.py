"""Output on terminals and pipes whose encoding does not have every character."""

from __future__ import annotations

import codecs
import os
import sys
import unicodedata
from collections.abc import Iterable

from ..errors import LONGEST_LINE, one_line

ERRORS = "rlv_landing.legible"


def legible(error: UnicodeError) -> tuple[str, int]:
    """A handler of encoding errors: frames of tables in ASCII, and others as their escape."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_in_ascii, error.object[error.start : error.end])), error.end


def _in_ascii(character: str) -> str:
    name = unicodedata.name(character, "")
    if not name.startswith("BOX DRAWINGS"):
        return character.encode("ascii", "backslashreplace").decode("ascii")
    upright = any(word in name for word in ("VERTICAL", "UP", "DOWN"))
    level = any(word in name for word in ("HORIZONTAL", "LEFT", "RIGHT"))
    return "+" if upright and level else "|" if upright else "-"


def legible_lines(lines: Iterable[str]) -> str:
    """Lines with texts of a file that others have written, without what commands a terminal.

    Control characters are escaped, and lines of more than 300 characters shortened.
    """
    return "\n".join(
        line if line.isprintable() and len(line) <= LONGEST_LINE else one_line(line)
        for line in lines
    )


def columns() -> int | None:
    """The columns of the terminal: `COLUMNS`, else what the terminal says; None for a file."""
    given = os.environ.get("COLUMNS", "")
    if given.isascii() and given.isdecimal() and int(given) > 0:
        return int(given)
    try:
        return os.get_terminal_size(sys.stdout.fileno()).columns or None
    except (OSError, ValueError):
        return None


def make_legible() -> None:
    """Let standard output and error take every character, whatever their encoding."""
    codecs.register_error(ERRORS, legible)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors=ERRORS)
