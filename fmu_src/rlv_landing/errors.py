"""The errors that users see, each in one line.

The line names the quantity, the value, the unit, the limit and the remedy.
"""

from __future__ import annotations

from collections.abc import Iterable


class LandingError(ValueError):
    """The user's input cannot be used; the message is one line and gives the remedy."""


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
