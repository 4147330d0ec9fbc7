"""The integrator's work, which `Landing.statistics` gives, and what does it."""

from __future__ import annotations

from .quantity import Quantity

STATISTIC_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "", "steps of the integrator since the start", 0.0, name="solver.steps", kind="integer"
    ),
    Quantity(
        "",
        "steps that the integrator has rejected and tried again shorter",
        0.0,
        name="solver.rejected",
        kind="integer",
    ),
    Quantity(
        "",
        "calls of the right-hand side since the start",
        0.0,
        name="solver.rhs_calls",
        kind="integer",
    ),
    Quantity(
        "",
        "whether the landing sleeps: at rest under inputs that do not change, time passes "
        "without steps",
        0.0,
        1.0,
        name="solver.asleep",
        kind="integer",
    ),
    Quantity(
        "",
        "whether the core is compiled; uncompiled, it gives the same digits slowly",
        0.0,
        name="solver.compiled",
        kind="boolean",
    ),
)
