"""The marks of the paper's printed scalars on the curves of a landing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..history import History
from ..validation.paper import Comparison
from .plots import AUXILIARY_FORCE, MAIN_FORCE, MAIN_STROKE, TOP_ACCELERATION
from .style import INK, TEST

PAPER = INK


@dataclass(frozen=True)
class Curve:
    """A quantity over time.

    Attributes:
        quantity: The paper's name of it.
        column: Our column, with `{}` for the leg's number.
        label: The axis label.
        factor: Factor from SI to the label's unit.
    """

    quantity: str
    column: str
    label: str
    factor: float


def _of_legs(quantity: str, column: str, factor: float, label: str) -> Curve:
    return Curve(quantity, f"leg[{{}}].{column}", label, factor)


FORCE = _of_legs("main_strut_force", *MAIN_FORCE)
STROKE = _of_legs("main_strut_stroke", *MAIN_STROKE)
AUXILIARY = _of_legs("aux_strut_force", *AUXILIARY_FORCE)
ACCELERATION = Curve(
    "axial_acceleration_top", TOP_ACCELERATION[0], TOP_ACCELERATION[2], TOP_ACCELERATION[1]
)
PITCH = Curve("pose", "body.pitch", "pitch [deg]", 57.29577951308232)


@dataclass(frozen=True)
class Mark:
    """A printed number on a curve.

    Attributes:
        id: The paper's id.
        text: The tooltip.
        simulation: Time [s] and value of the printed simulation, in the scalar's unit.
        tests: The same of the printed tests.
        marker: A circle for a value (at the printed time, else at ours), a bar for a time (on our
            curve).
    """

    id: str
    text: str
    simulation: tuple[float, float]
    tests: tuple[tuple[float, float], ...]
    marker: str


def marks(
    curve: Curve, legs: Sequence[int], history: History, comparisons: Sequence[Comparison]
) -> Iterator[Mark]:
    """The printed scalars of a curve.

    Args:
        curve: The curve.
        legs: The legs that share it; (0,) for the body.
        history: The landing's columns over time.
        comparisons: The printed scalars beside ours.
    """
    own = {
        c.scalar.id: c
        for c in comparisons
        if c.scalar.quantity == curve.quantity and (c.scalar.leg in legs or c.scalar.leg == 0)
    }
    column = history[curve.column.format(legs[0])] * curve.factor
    for name, c in own.items():
        s = c.scalar
        text = (
            f"{name}: {s.event}: simulation {s.simulation:g} {s.unit}, ours {c.ours:.4g} {s.unit}"
        )
        if s.unit == "s":
            if name.removesuffix("-t") != name and name.removesuffix("-t") in own:
                continue
            at = float(
                np.interp(c.ours if np.isfinite(c.ours) else s.simulation, history.time, column)
            )
            yield Mark(
                name,
                text,
                (s.simulation, at),
                tuple((v, at) for v in (s.test_a, s.test_b) if v == v),
                "|",
            )
            continue
        factor = {"N": 1e-3}.get(s.unit, 1.0)
        timed = own.get(f"{name}-t")
        if timed is None and not np.isfinite(c.ours):
            continue  # no time at which to draw it
        ours = float(history.time[np.argmin(np.abs(column - c.ours * factor))])
        if "settled" in s.event:
            ours = min(float(history.time[-1]), 1.0) - 0.1
        when = timed.scalar.simulation if timed else ours
        test_time = timed.scalar.test if timed and timed.scalar.test == timed.scalar.test else when
        tests = tuple((test_time, v * factor) for v in (s.test_a, s.test_b) if v == v)
        yield Mark(name, text, (when, s.simulation * factor), tests, "o")
        if timed:
            t = timed.scalar
            text = f"{t.id}: {t.event}: simulation {t.simulation:g} s, ours {timed.ours:.4g} s"
            yield Mark(t.id, text, (when, s.simulation * factor), (), "|")


def draw_marks(ax: Any, found: Iterator[Mark]) -> dict[str, str]:
    """Draw the marks, each with the id `mark-ID`; return their tooltips by ID."""
    tooltips = {}
    for m in found:
        ax.plot(
            *m.simulation,
            m.marker,
            color=PAPER,
            markerfacecolor="none",
            markersize=7 if m.marker == "o" else 11,
            zorder=5,
            gid=f"mark-{m.id}",
        )
        for x, y in m.tests:
            ax.plot(x, y, "x", color=TEST, markersize=6, markeredgewidth=1.4, zorder=4)
        tooltips[m.id] = m.text
    return tooltips
