"""Limits of loads and strokes, and the first of them that a landing passed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import unknown
from ..history import History
from ..parameters import check_value
from ..quantities import Quantity

Array = NDArray[np.float64]

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
            "auxiliary strut's axial force, either sign",
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
        time: Time of the first sample beyond the limit [s].
        limit: The limit itself [SI unit of the quantity].
    """

    name: str
    leg: int | None
    time: float
    limit: float


def _resultant(history: History, leg: int) -> Array:
    x, y, z = (history[f"leg[{leg}].contact.force_{axis}"] for axis in "xyz")
    force: Array = np.sqrt(x * x + y * y + z * z)
    return force


def _magnitude(name: str) -> Callable[[History, int], Array]:
    return lambda history, leg: np.abs(history[f"leg[{leg}].{name}"])


def _plain(name: str) -> Callable[[History, int], Array]:
    return lambda history, leg: history[f"leg[{leg}].{name}"]


COMPARED: dict[str, Callable[[History, int], Array]] = {
    "main_strut.force": _magnitude("main_strut.force"),
    "auxiliary_strut.force": _magnitude("auxiliary_strut.force"),
    "main_strut.stroke": _plain("main_strut.stroke"),
    "main_strut.pressure_upper": _plain("main_strut.pressure_upper"),
    "main_strut.pressure_lower": _plain("main_strut.pressure_lower"),
    "contact.force": _resultant,
}


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
    """The limit that is passed at the earliest sample.

    Of several passed at that sample, it is the one exceeded by the largest part of itself.
    """
    found: list[tuple[int, float, PassedLimit]] = []
    for name, limit in check_limits(limits).items():
        whose = legs if name in COMPARED else (None,)
        for leg in whose:
            values = COMPARED[name](history, leg) if leg is not None else history[name]
            if not values.max() > limit:
                continue
            i = int(np.argmax(values > limit))
            excess = float(values[i]) / limit if limit > 0.0 else np.inf
            found.append((i, -excess, PassedLimit(name, leg, float(history.time[i]), limit)))
    return min(found, key=lambda f: f[:2])[2] if found else None
