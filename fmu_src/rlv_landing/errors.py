"""The errors that users see: one line that names the quantity, the value, the unit, the limit and
what to do.
"""

from __future__ import annotations

from collections.abc import Iterable


class LandingError(ValueError):
    """Something the user gave cannot be used; the message is one line and says what to do."""


class IntegrationError(LandingError):
    """The integrator cannot go on. All that would go on raises it again, until the landing is reset
    or given another state.
    """


class StepSizeError(IntegrationError):
    """No step is short enough: forces grow without bound, or are no numbers any more."""


class StepLimitError(IntegrationError):
    """More steps are needed for a second of landing than `solver.max_steps_per_second` allows."""


def nearest(name: str, known: Iterable[str]) -> str:
    """`; did you mean X?` for the known name nearest to `name`, or nothing where none is near.

    The last parts of dotted names count too, so that `mass` finds `vehicle.mass`.
    """
    from difflib import get_close_matches  # which takes longer to import than most of this package

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
    """The error for a `name` that is not among the `known`."""
    known = list(known)
    hint = nearest(str(name), known) or (
        f"; known are {', '.join(known)}" if len(known) <= 8 else ""
    )
    return LandingError(f"unknown {what} {name!r}{hint}")
