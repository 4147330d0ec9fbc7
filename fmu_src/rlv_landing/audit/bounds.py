"""The bounds of an audit, each with its reason, and a value with its bound."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

# tolerance of the landings that are held against exact laws
TIGHT_RTOL = 1e-8


class Bound(NamedTuple):
    """A bound of a measured value.

    Attributes:
        what: The value.
        unit: The value's unit.
        limit: The limit.
        side: Whether the value must be at most or at least the limit.
        reason: The reason for the limit.
    """

    what: str
    unit: str
    limit: float
    side: Literal["at most", "at least"]
    reason: str


OF_CHANGE = "of its largest change"
BOUNDS: dict[str, Bound] = {
    "energy": Bound(
        "energy balance at rtol 1e-8, of the energy turned over",
        "",
        1e-5,
        "at most",
        "all terms follow from one state: only the integrator's error is left",
    ),
    "energy_default": Bound(
        "energy balance at the default rtol, of the energy turned over",
        "",
        1e-3,
        "at most",
        "a tenth of a per cent is below any use of the balance",
    ),
    "dissipated": Bound(
        "fall of any account of dissipated energy in 10 s, rtol 1e-8, of the energy turned over",
        "",
        1e-9,
        "at most",
        "what is lost stays lost: only the integrator's error is left; "
        "friction_law = paper supplies energy and misses it",
    ),
    "liquid_mass": Bound(
        "change of a damper's liquid mass",
        "",
        1e-6,
        "at most",
        "mass is conserved by construction: only the integrator's error is left",
    ),
    "flight_momentum": Bound(
        "linear momentum in free flight beyond the weight's, of the weight's",
        "",
        1e-9,
        "at most",
        "no other force acts: round-off",
    ),
    "flight_angular": Bound(
        "change of angular momentum about the CG in free flight",
        "",
        1e-9,
        "at most",
        "no moment acts: round-off",
    ),
    "momentum_x": Bound(
        f"horizontal momentum beyond the contact forces' impulse, {OF_CHANGE}",
        "",
        1e-4,
        "at most",
        "Simpson's rule over samples of 50 us, 1 us around contacts; a change of less than a "
        "thousandth of the vertical one's is taken for that much",
    ),
    "momentum_y": Bound(
        f"vertical momentum beyond the impulse of contact forces and weight, {OF_CHANGE}",
        "",
        1e-4,
        "at most",
        "as above",
    ),
    "angular": Bound(
        f"angular momentum about the origin beyond their moments' impulse, {OF_CHANGE}",
        "",
        1e-4,
        "at most",
        "as above, at the footpads' radius; transverse_load_at = joint drops a moment: the bound "
        "does not apply",
    ),
    "rest_weight": Bound(
        "vertical contact force at rest beyond the weight, of the weight",
        "",
        1e-4,
        "at most",
        "what stands still is carried: the rest of the motion",
    ),
    "rest_speed": Bound(
        "speed at rest of body and struts",
        "m/s",
        1e-4,
        "at most",
        "a damper that creeps by 0.1 mm/s moves 1 mm in 10 s",
    ),
    "rest_drift": Bound(
        "drift of a footpad in the 5 s after that",
        "m/s",
        1e-9,
        "at most",
        "what friction holds does not creep: 1e-6 mm/s is 0.1 mm in a day; "
        "friction_law = paper creeps on slopes",
    ),
    "rest_phase": Bound(
        "settled 10 s after first contact, 60 s where it rocks for longer, never toppled (1: yes)",
        "",
        1.0,
        "at least",
        "a landing ends standing; where a vehicle that topples ends is not in the model",
    ),
    "smooth_error": Bound(
        "strut force and stroke error on a smooth arc at the default rtol, of their largest",
        "",
        1e-4,
        "at most",
        "a hundred times the tolerance, which is for one step",
    ),
    "smooth_slope": Bound(
        "decades of that error a decade of tolerance on a smooth arc",
        "",
        0.5,
        "at least",
        "1 for an error in proportion to the tolerance; "
        "a footpad that turns from sticking to slipping on the way costs part of it",
    ),
    "contacts_error": Bound(
        "stroke error across contacts at the default rtol, of the largest stroke",
        "",
        1e-3,
        "at most",
        "a thousandth, 0.03 mm of the paper's 27 mm, is below what its tests resolve",
    ),
    "contacts_force": Bound(
        "strut force error across contacts at the default rtol, of the largest force",
        "",
        1e-2,
        "at most",
        "an instant's error of a contact's time is a force's error there",
    ),
}


@dataclass(frozen=True)
class Check:
    """One value and its bound, by the bound's `id`.

    `applies` is False where the bound is not valid for these parameters.
    """

    id: str
    value: float
    applies: bool = True

    @property
    def passed(self) -> bool:
        """Whether the value is on the right side of its bound, or the bound does not apply."""
        bound = BOUNDS[self.id]
        return not self.applies or (
            self.value <= bound.limit if bound.side == "at most" else self.value >= bound.limit
        )
