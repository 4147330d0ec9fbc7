"""The conditions that a physically sensible landing of the paper's prototype meets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..history import History
from ..parameters import AuxiliaryStrut

# the legs that differ in a symmetric landing
LEGS = (1, 2, 3)


@dataclass(frozen=True)
class Condition:
    """A condition on a landing: `measure` of its history is at most `limit`.

    Attributes:
        name: What is limited.
        unit: Its unit; empty for a plain number.
        limit: The limit, in that unit.
        scale: The departure from the limit that counts as a misfit of one, in that unit.
        reason: The reason for the limit.
        measure: The value of a history.
    """

    name: str
    unit: str
    limit: float
    scale: float
    reason: str
    measure: Callable[[History], float]

    def departure(self, history: History) -> float:
        """Distance of a history beyond the limit, in scales; 0 where the condition is met."""
        return max(0.0, (self.measure(history) - self.limit) / self.scale)


def _switches(history: History) -> float:
    return float(max(np.abs(np.diff(history[f"leg[{leg}].contact.active"])).sum() for leg in LEGS))


def _greatest(name: str, sign: float, history: History) -> float:
    return float(max((sign * history[f"leg[{leg}].{name}"]).max() for leg in LEGS))


def _auxiliary_yield(history: History) -> float:
    """The largest stroke beyond the joints' play on that side [m]: what the strut itself yields."""
    own = history.parameters.auxiliary_strut if history.parameters is not None else AuxiliaryStrut()
    strokes = [history[f"leg[{leg}].auxiliary_strut.stroke"] for leg in LEGS]
    return float(
        max(max(s.max() - own.play_compression, -s.min() - own.play_tension) for s in strokes)
    )


CONDITIONS: tuple[Condition, ...] = (
    Condition(
        "over-extension",
        "m",
        2e-4,
        1e-4,
        "a piston rests on its stop",
        partial(_greatest, "main_strut.stroke", -1.0),
    ),
    Condition(
        "contact switches of a leg",
        "",
        4.0,
        2.0,
        "a footpad lands, may lift once, and does not chatter",
        _switches,
    ),
    Condition(
        "lower chamber's pressure",
        "Pa",
        3.5e7,
        5e6,
        "what a reciprocating rod seal holds",
        partial(_greatest, "main_strut.pressure_lower", 1.0),
    ),
    Condition(
        "auxiliary strut's yield",
        "m",
        1.6e-3,
        3e-4,
        "4.9 kN on a twelfth of an aluminium strut's stiffness, without the joints' play",
        _auxiliary_yield,
    ),
    Condition(
        "penetration",
        "m",
        2.5e-3,
        5e-4,
        "a footpad does not sink into a test floor",
        partial(_greatest, "contact.penetration", 1.0),
    ),
)
