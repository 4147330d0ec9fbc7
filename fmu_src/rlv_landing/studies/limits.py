"""Limits of loads and strokes, and the first of them that a landing passed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from ..errors import unknown
from ..history import History
from ..landing import Landing
from ..outputs import Extreme
from ..parameters import check_value
from ..quantities import RADIAL, TRIPOD, Quantity
from .replay import ReplayedHistory

# the quantities that may have a limit, by output name; the largest value is compared, of a load its
# magnitude
LIMITS: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity(
            "N",
            "main strut's axial force, either sign",
            0.0,
            1e12,
            name="main_strut.force",
            display_unit="kN",
        ),
        Quantity(
            "N",
            "auxiliary strut's axial force, either sign; of a tripod both struts'",
            0.0,
            1e12,
            name="auxiliary_strut.force",
            display_unit="kN",
        ),
        Quantity(
            "m",
            "damper's stroke in compression",
            0.0,
            100.0,
            name="main_strut.stroke",
            display_unit="mm",
        ),
        Quantity(
            "Pa",
            "absolute pressure in the upper chamber",
            0.0,
            1e12,
            name="main_strut.pressure_upper",
            display_unit="MPa",
        ),
        Quantity(
            "Pa",
            "absolute pressure in the lower chamber",
            0.0,
            1e12,
            name="main_strut.pressure_lower",
            display_unit="MPa",
        ),
        Quantity(
            "N",
            "force between ground and footpad, all directions together",
            0.0,
            1e12,
            name="contact.force",
            display_unit="kN",
        ),
        Quantity(
            "m/s2",
            "axial acceleration of the top, upward",
            0.0,
            1e6,
            name="body.top_axial_acceleration",
        ),
    )
}


@dataclass(frozen=True)
class PassedLimit:
    """A limit that a landing passed.

    Attributes:
        name: The limit's name in LIMITS.
        leg: The leg; None for the body.
        time: When it was first passed [s].
        limit: The limit itself [SI unit of the quantity].
    """

    name: str
    leg: int | None
    time: float
    limit: float


# of these either sign counts
EITHER_SIGN = ("main_strut.force", "auxiliary_strut.force")
OF_THE_BODY = ("body.top_axial_acceleration",)


def check_limits(limits: Mapping[str, float]) -> dict[str, float]:
    """The limits by name [SI], checked.

    Raises:
        LandingError: A name is not in LIMITS, or a value is negative, NaN or no number.
    """
    for name in limits:
        if name not in LIMITS:
            raise unknown("limit", name, LIMITS)
    return {name: float(check_value(LIMITS[name], value)) for name, value in limits.items()}


def first_limit_passed(
    history: History, legs: tuple[int, ...], limits: Mapping[str, float]
) -> PassedLimit | None:
    """The limit that the landing passed first.

    Of several passed at that time, it is the one exceeded by the largest part of itself. The
    landing's extremes decide, between the samples too. The time is as in `time_passed`.
    """
    limits = check_limits(limits)
    kind = RADIAL if history.parameters is None else history.parameters.leg.kind
    passed = _beyond(history.extreme, legs, limits, kind)
    if not passed:
        return None
    if isinstance(history, ReplayedHistory):
        names = [
            output
            for name in limits
            for leg in ((None,) if name in OF_THE_BODY else legs)
            for output in _outputs(name, leg, kind)
        ]
        time = history.first_time(
            lambda landing: bool(_beyond(landing.extremes(names).__getitem__, legs, limits, kind)),
            float(history.time[0]),
            float(history.time[-1]),
        )
        passed = _beyond(history.extremes_at(time).__getitem__, legs, limits, kind) or passed
        _, name, leg = max(passed, key=lambda p: p[0])
        return PassedLimit(name, leg, time, limits[name])
    timed = [
        (_time_beyond(history, name, leg, limits[name], kind), -excess, name, leg)
        for excess, name, leg in passed
    ]
    time, _, name, leg = min(timed, key=lambda p: p[:2])
    return PassedLimit(name, leg, time, limits[name])


def _beyond(
    extreme: Callable[[str], Extreme],
    legs: tuple[int, ...],
    limits: Mapping[str, float],
    kind: str,
) -> list[tuple[float, str, int | None]]:
    """The limits that the extremes are beyond: by what factor, name, and leg."""
    found: list[tuple[float, str, int | None]] = []
    for name, limit in limits.items():
        for leg in (None,) if name in OF_THE_BODY else legs:
            reached = max(
                _largest(extreme(output), magnitude=name in EITHER_SIGN)
                for output in _outputs(name, leg, kind)
            )
            if reached > limit:
                found.append((reached / limit if limit > 0.0 else inf, name, leg))
    return found


def _outputs(name: str, leg: int | None, kind: str) -> list[str]:
    """The outputs that a limit of a leg, or of the body, is of; `kind` is that of the legs."""
    if leg is None:
        return [name]
    names = [name]
    if kind == TRIPOD and name.startswith("auxiliary_strut."):
        names.append(name.replace("auxiliary_strut.", "auxiliary_strut_2."))
    return [f"leg[{leg}].{one}" for one in names]


def _time_beyond(history: History, name: str, leg: int | None, limit: float, kind: str) -> float:
    magnitude = name in EITHER_SIGN
    return min(
        time_passed(history, output, limit, magnitude=magnitude)
        for output in _outputs(name, leg, kind)
        if _largest(history.extreme(output), magnitude=magnitude) > limit
    )


def time_passed(
    history: History, output: str, limit: float, *, magnitude: bool = False, below: bool = False
) -> float:
    """Time at which an output first passed a `limit` that it has passed [s].

    Exact for a `ReplayedHistory`, else the time of the first sample beyond, or of the extreme where
    that is earlier.

    Args:
        history: The landing.
        output: The output's name.
        limit: The limit [SI].
        magnitude: Whether its magnitude is compared.
        below: Whether its negative is compared.
    """
    found, values = history.extreme(output), history[output]
    sides = [] if below else [(found.maximum, found.maximum_time)]
    if magnitude or below:
        sides.append((-found.minimum, found.minimum_time))
        values = -values if below else np.abs(values)
    beyond = np.flatnonzero(values > limit)[:1]
    latest: float = min([*(t for v, t in sides if v > limit), *history.time[beyond].tolist()])
    if not isinstance(history, ReplayedHistory) or latest <= history.time[0]:
        return latest

    def passed(landing: Landing) -> bool:
        now = landing.extremes([output])[output]
        return (-now.minimum if below else _largest(now, magnitude=magnitude)) > limit

    return history.first_time(passed, float(history.time[0]), latest)


def _largest(found: Extreme, *, magnitude: bool) -> float:
    """The largest value, or the largest magnitude."""
    return max(found.maximum, -found.minimum) if magnitude else found.maximum
