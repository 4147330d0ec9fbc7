"""The extremes that the FMU gives; `Landing.extremes` has those of every output."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from .legs import LEGS
from .outputs import OUTPUT_QUANTITIES
from .quantity import Quantity


@dataclass(frozen=True)
class Peak:
    """One extreme of an output since the start, and when it first was.

    Attributes:
        output: The output's name.
        side: `min` or `max`.
        value: The quantity `peak.OUTPUT.SIDE`.
        time: The quantity `peak.OUTPUT.SIDE_time` [s].
    """

    output: str
    side: Literal["min", "max"]
    value: Quantity
    time: Quantity


def _peak(q: Quantity, side: Literal["min", "max"]) -> Peak:
    words = {"min": "least", "max": "greatest"}[side]
    name = f"peak.{q.name}.{side}"
    value = Quantity(
        q.unit,
        f"{words} value since the start, between steps too: {q.meaning}",
        q.lo,
        q.hi,
        name=name,
        display_unit=q.display_unit,
    )
    time = Quantity("s", f"time at which {name} was first reached", name=f"{name}_time")
    return Peak(q.name, side, value, time)


PEAKS_OF_A_LEG: tuple[tuple[str, tuple[Literal["min", "max"], ...]], ...] = (
    ("main_strut.force", ("min", "max")),
    ("main_strut.stroke", ("max",)),
    ("main_strut.pressure_lower", ("max",)),
    ("auxiliary_strut.force", ("min", "max")),
    ("auxiliary_strut_2.force", ("min", "max")),
    ("contact.force", ("max",)),
)


def peaks_of(outputs: Sequence[Quantity], legs: Sequence[int]) -> tuple[Peak, ...]:
    """The extremes that an FMU with these `outputs` and numbers of `legs` gives."""
    by_name = {q.name: q for q in outputs}
    return (
        _peak(by_name["body.top_axial_acceleration"], "max"),
        _peak(by_name["status.stability_margin"], "min"),
        *(_peak(q, "min") for q in outputs if q.name == "body.clearance"),
        *(
            _peak(by_name[f"leg[{leg}].{name}"], side)
            for leg in legs
            for name, sides in PEAKS_OF_A_LEG
            if f"leg[{leg}].{name}" in by_name
            for side in sides
        ),
    )


PEAKS: tuple[Peak, ...] = peaks_of(OUTPUT_QUANTITIES, LEGS)
PEAK_QUANTITIES: tuple[Quantity, ...] = tuple(q for p in PEAKS for q in (p.value, p.time))
