"""`Quantity`, one named number of the model, and the units that it may have."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import inf
from typing import Literal

Source = Literal["paper", "derived", "closure", "identified", "user"]
# what distinguishes the quantities of one leg from those of another
LEG_INDEX = re.compile(r"(?<![^.])leg\[\d+\]")


@dataclass(frozen=True)
class Quantity:
    """One named number (or choice) of the model.

    Attributes:
        unit: SI unit of the number.
        meaning: The meaning, in words.
        lo: Least value allowed.
        hi: Largest value allowed.
        symbol: The paper's and the kernel's name.
        source: Source of a default: the paper, derived from it, a closure that the paper leaves
            open, or identified from the paper's printed numbers.
        display_unit: The unit that people read.
        choices: The texts allowed, for a quantity that is no number; a string without choices is
            a text of a form of its own.
        name: The name.
        default: The default.
        kind: The FMI type.
    """

    unit: str
    meaning: str
    lo: float = -inf
    hi: float = inf
    symbol: str = ""
    source: Source = "closure"
    display_unit: str = ""
    choices: tuple[str, ...] = ()
    name: str = ""
    default: float | str = 0.0
    kind: Literal["real", "integer", "boolean", "string"] = "real"

    @property
    def nominal(self) -> float:
        """Order of magnitude [SI unit], by the display unit; 1 for plain numbers."""
        return NOMINALS.get(self.display_unit or self.unit, 1.0)


def flat_name(name: str) -> str:
    """A quantity's name without dots and brackets: `leg1_main_strut_force`.

    For hosts in which `a.b` is a part of a bus, or `a[1]` an element of an array.
    """
    return name.replace("[", "").replace("]", "").replace(".", "_")


def whole_name(name: str) -> str:
    """The array that a quantity is an element of, `leg.contact.force`; else its name.

    For FMI 3.0, in which the four legs are one array.
    """
    return LEG_INDEX.sub("leg", name)


# display unit -> (SI unit, factor): value_SI = factor * value_display
DISPLAY_UNITS = {
    "deg": ("rad", 0.017453292519943295),
    "deg/s": ("rad/s", 0.017453292519943295),
    "mm": ("m", 1e-3),
    "kN": ("N", 1e3),
    "MPa": ("Pa", 1e6),
    "mm2": ("m2", 1e-6),
    "cm3": ("m3", 1e-6),
}


def shown(q: Quantity) -> tuple[str, float]:
    """The unit that people read, and its size in the SI unit."""
    return (
        (q.display_unit, DISPLAY_UNITS[q.display_unit][1])
        if q.display_unit in DISPLAY_UNITS
        else (q.unit, 1.0)
    )


# display unit -> order of magnitude [SI unit]; 1 where none is listed
NOMINALS = {
    "mm": 1e-2,
    "deg": 0.1,
    "kN": 1e3,
    "N.m": 1e3,
    "MPa": 1e6,
    "J": 100.0,
    "m/s2": 10.0,
    "rad/s2": 10.0,
}

# SI unit -> exponents of its base units, for FMI's UnitDefinitions
BASE_UNITS: dict[str, dict[str, int]] = {
    "m": {"m": 1},
    "m2": {"m": 2},
    "m3": {"m": 3},
    "s": {"s": 1},
    "kg": {"kg": 1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "s/m": {"s": 1, "m": -1},
    "1/s": {"s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N/Pa": {"m": 2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "kg/m3": {"kg": 1, "m": -3},
    "kg.m2": {"kg": 1, "m": 2},
}
