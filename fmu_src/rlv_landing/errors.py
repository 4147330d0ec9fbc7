"""The errors that users see, each in one line.

The line names the quantity, the value, the unit, the limit and the remedy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

LONGEST_LINE = 300
_LONGEST_WORDS = (60, 40, 30)
_PREFIX = "error: "


class LandingError(ValueError):
    """The user's input cannot be used; the message is one line and gives the remedy.

    A message that is too long for a line of 300 characters is shortened.
    """

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message, LONGEST_LINE - len(_PREFIX)))


def first_of(names: Sequence[str], count: int = 3) -> str:
    """The first names of a list, and dots for the others."""
    return f"{', '.join(names[:count])}{', ...' if len(names) > count else ''}"


def one_line(text: str, longest: int = LONGEST_LINE) -> str:
    """A text as one line of at most `longest` characters.

    Control characters are escaped. Where the line is too long, long words are shortened first, then
    its middle is left out, for the start says what is wrong and the end what to do.
    """
    # of a text of megabytes no more than its ends is looked at
    kept = 4 * longest
    text = text.strip() if len(text) <= 2 * kept else text[:kept] + text[-kept:]
    line = "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )
    for length in _LONGEST_WORDS:
        if len(line) > longest:
            line = " ".join(_cut(word, length) for word in line.split(" "))
    return _cut(line, longest)


def reason_of(error: BaseException) -> str:
    """What an exception says, in one line of words.

    An OSError says what the system says; an exception without a text its own name.
    """
    text = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return " ".join(text.split()) or type(error).__name__


def _cut(text: str, longest: int) -> str:
    if len(text) <= longest:
        return text
    end = (longest - 3) // 2
    return f"{text[: longest - 3 - end]}...{text[-end:]}"


class IntegrationError(LandingError):
    """The integrator cannot go on.

    All that would go on raises it again, until the landing is reset or given another state.
    """


class StepSizeError(IntegrationError):
    """No step is short enough: forces grow without bound, or are no numbers any more."""


class StepLimitError(IntegrationError):
    """More steps are needed for a second of landing than `solver.max_steps_per_second` allows."""


class OffGroundError(IntegrationError):
    """A footpad or a point of the body is beyond the height field."""


def nearest(name: str, known: Iterable[str]) -> str:
    """`; did you mean X?` for the known name nearest to `name`; empty where none is near.

    The last parts of dotted names count too, so that `mass` finds `vehicle.mass`.
    """
    # imported here: it takes longer to import than most of this package
    from difflib import get_close_matches

    known = list(known)
    close = get_close_matches(name, known, n=1, cutoff=0.6)
    if not close:
        last: dict[str, str] = {}
        for k in known:
            last.setdefault(k.rsplit(".", 1)[-1], k)
        close = [
            last[k] for k in get_close_matches(name.rsplit(".", 1)[-1], list(last), n=1, cutoff=0.6)
        ]
    return f"; did you mean {close[0]}?" if close else ""


def unknown(what: str, name: object, known: Iterable[str]) -> LandingError:
    """The error for a `name` that is not among the `known`; `what` is the word for it."""
    known = list(known)
    hint = nearest(str(name), known) or (
        f"; known are {', '.join(known)}" if len(known) <= 8 else ""
    )
    return LandingError(f"unknown {what} {name!r}{hint}")
