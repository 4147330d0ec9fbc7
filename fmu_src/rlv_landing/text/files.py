"""Text files as users have them: UTF-8 with or without a byte order mark, TOML, and CSV.

What is in another encoding or has other separators is refused with the remedy, for a guess may
change numbers.
"""

from __future__ import annotations

import codecs
import csv
import json
import re
import sys
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import TextIOWrapper
from pathlib import Path
from typing import Any, TextIO

from ..errors import LandingError, reason_of
from .pipes import is_pipe, open_input
from .units import is_zero

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LARGEST_TEXT = 4 * 1024**2
LONGEST_LINE = 1024**2
DEEPEST = 32
LARGEST_INTEGER = 2**63
# a text in quotes, on one line
_QUOTED = re.compile(r'"(?:[^"\\\n]|\\.)*"|' + r"'[^'\n]*'")
_TOO_LARGE = "a whole number of more than 64 bits; write it as 1e19"
_BYTE_ORDER_MARKS = {
    codecs.BOM_UTF32_LE: "UTF-32",
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}
_keeping: list[bool] = []
_kept: dict[Path, bytes] = {}
_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "strokes"}


def read_text(path: Path, what: str, missing: str = "") -> str:
    """The text of a file, with or without a byte order mark; its lines end in a line feed.

    Args:
        path: The file.
        what: The word for it in errors.
        missing: The error where it is missing [default: there is no `what` `path`].

    Raises:
        LandingError: The file is missing, cannot be read, is larger than 4 MiB, is not UTF-8, or
            has NUL characters.
    """
    try:
        data = _content(path)
    except FileNotFoundError:
        raise LandingError(missing or f"there is no {what} {path}") from None
    except (OSError, ValueError) as e:
        raise unreadable(what, path, e) from None
    if len(data) > LARGEST_TEXT:
        raise LandingError(f"{what} {path} is larger than 4 MiB, more than such a file can need")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as e:
        raise unreadable(what, path, e, data) from None
    if "\0" in text:
        raise _with_nuls(what, path)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _content(path: Path) -> bytes:
    """The bytes of a file, as far as a text may be large."""
    if path in _kept:
        return _kept[path]
    pipe = is_pipe(path)
    with open_input(path) as file:
        data = file.read(LARGEST_TEXT + 1)
    if pipe and _keeping:
        _kept[path] = data
    return data


@contextmanager
def pipes_kept() -> Iterator[None]:
    """Texts of pipes that the body reads are kept, so that it can read them again."""
    _keeping.append(True)
    try:
        yield
    finally:
        _keeping.pop()
        _kept.clear()


def unreadable(what: str, path: Path, error: Exception, start: bytes = b"") -> LandingError:
    """The error for a file that cannot be read; `start` are its first bytes."""
    if isinstance(error, UnicodeDecodeError):
        name = next((n for mark, n in _BYTE_ORDER_MARKS.items() if start.startswith(mark)), "")
        found = f"it is {name}" if name else "it is not UTF-8"
        return LandingError(f"{what} {path} cannot be read: {found}; save it as UTF-8")
    return LandingError(f"{what} {path} cannot be read: {reason_of(error)}")


def is_utf8(text: str) -> bool:
    """Whether a text can be written as UTF-8; names of files of other encodings cannot."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def shown_name(path: Path) -> str:
    """The name of a file for titles; bytes of it that are not UTF-8 are written as escapes."""
    return path.name.encode("utf-8", "backslashreplace").decode()


def read_record(path: Path) -> dict[str, Any]:
    """The table in a JSON file that one of the commands wrote.

    Raises:
        OSError: The file is missing or cannot be read.
        ValueError: It is torn, is no table, or is nested too deep.
    """
    if path.exists() and not path.is_file():
        raise ValueError("it is no file")
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except RecursionError:
        raise ValueError("it is nested too deep") from None
    if not isinstance(record, dict):
        raise ValueError("it is no table")
    return record


def check_sum(record: Mapping[str, Any]) -> int:
    """The CRC-32 of a record without its `check`, whatever the order of its keys.

    A changed digit makes another number, which may be as plausible; the sum shows the change.
    """
    kept = {key: value for key, value in record.items() if key != "check"}
    return zlib.crc32(json.dumps(kept, sort_keys=True).encode())


def toml_table(value: Any, key: str) -> dict[str, Any]:
    """The `value` that a TOML document has for the table [`key`].

    Raises:
        LandingError: It is no table.
    """
    if not isinstance(value, dict):
        raise LandingError(f"{key} = {value!r} must be a table: write [{key}] and its values below")
    return value


def parse_document(text: str, name: str) -> dict[str, Any]:
    """The document of a TOML text.

    Args:
        text: The text.
        name: The word for it in errors.

    Raises:
        LandingError: The syntax is wrong, tables or lists are nested more than 32 deep, or a whole
            number has more than 64 bits.
    """
    # the library takes a time that grows with the square of the parts of a key; dots in a text,
    # such as a list of numbers, divide none
    plain = re.sub(r"\.{2,}", "", _QUOTED.sub("", text))
    if max(part.count(".") for part in re.split(r"[\n,=\[\]{}#]", plain)) > DEEPEST:
        raise LandingError(f"{name}: TOML syntax: a key has more than {DEEPEST} parts")
    try:
        # a number that a float cannot distinguish from 0 is refused
        document = tomllib.loads(text, parse_float=_toml_float)
    except LandingError as e:
        raise LandingError(f"{name}: {e}") from None
    except RecursionError:
        raise LandingError(f"{name}: tables and lists are nested too deep; {DEEPEST} fit") from None
    except tomllib.TOMLDecodeError as e:
        raise LandingError(f"{name}: TOML syntax: {reason_of(e)}") from None
    except ValueError:
        # Python converts no whole number of more than 4300 digits
        raise LandingError(f"{name} has {_TOO_LARGE}") from None
    _check_size(document, name)
    return document


def _toml_float(text: str) -> float:
    value = float(text)
    if value == 0.0 and not is_zero(text):
        raise LandingError(f"{text} is below the smallest number, 4.9e-324; write 0")
    return value


def _check_size(document: dict[str, Any], name: str) -> None:
    below: list[tuple[str, Any, int]] = [("", document, 0)]
    while below:
        key, value, depth = below.pop()
        if depth > DEEPEST:
            raise LandingError(
                f"{name}: {key.split('.')[0]} is nested more than {DEEPEST} deep; write it flat"
            )
        if isinstance(value, int) and not -LARGEST_INTEGER <= value < LARGEST_INTEGER:
            raise LandingError(f"{name}: {key} is {_TOO_LARGE}")
        if isinstance(value, dict):
            below += [(f"{key}.{k}" if key else k, v, depth + 1) for k, v in value.items()]
        elif isinstance(value, list):
            below += [(key, v, depth + 1) for v in value]


def toml_text(text: str) -> str:
    """A text as a TOML string in ASCII, quotes included."""
    short = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}

    def escaped(c: str) -> str:
        if c in short:
            return short[c]
        if " " <= c <= "~":
            return c
        if 0xD800 <= ord(c) <= 0xDFFF:
            # half a character cannot be written
            return "?"
        return f"\\u{ord(c):04x}" if ord(c) <= 0xFFFF else f"\\U{ord(c):08x}"

    return '"' + "".join(map(escaped, text)) + '"'


def read_csv(path: Path, what: str, missing: str = "") -> Iterator[tuple[int, list[str]]]:
    """The rows of a CSV file that are not blank, each with the number of its last line, from 1.

    Args:
        path: The file.
        what: The word for it in errors.
        missing: The error where it is missing [default: there is no `what` `path`].

    Raises:
        LandingError: The file is missing or cannot be read, is not UTF-8, has NUL characters, or
            its first row is separated by semicolons, tabs or strokes.
    """
    try:
        with open_input(path) as data, TextIOWrapper(data, "utf-8-sig", newline="") as file:
            rows = csv.reader(_lines(file, what, path))
            first = True
            for row in rows:
                if not any(cell.strip() for cell in row):
                    continue
                if first:
                    _check_separator(path, row)
                    first = False
                yield rows.line_num, row
    except LandingError:
        raise
    except FileNotFoundError:
        raise LandingError(missing or f"there is no {what} {path}") from None
    except (OSError, ValueError, csv.Error) as e:
        raise unreadable(what, path, e, _start(path)) from None


def _lines(file: TextIO, what: str, path: Path) -> Iterator[str]:
    while line := file.readline(LONGEST_LINE + 1):
        if len(line) > LONGEST_LINE:
            raise LandingError(f"{what} {path} has a line of more than {LONGEST_LINE} characters")
        if "\0" in line:
            raise _with_nuls(what, path)
        yield line


def _with_nuls(what: str, path: Path) -> LandingError:
    return LandingError(
        f"{what} {path} has NUL characters: it is torn, no text, or UTF-16; save it as UTF-8"
    )


def _start(path: Path) -> bytes:
    try:
        if not path.is_file():
            return b""
        with path.open("rb") as file:
            return file.read(4)
    except (OSError, ValueError):
        return b""


def _check_separator(path: Path, headings: Sequence[str]) -> None:
    for separator, name in _SEPARATORS.items():
        if any(separator in heading for heading in headings):
            raise LandingError(
                f"{path} is separated by {name}; separate it by commas, "
                "and write numbers with a point"
            )
