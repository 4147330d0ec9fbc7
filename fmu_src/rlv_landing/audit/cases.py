"""The cases that an audit lands a vehicle in: as it is, on a slope, under a steady side load."""

from __future__ import annotations

from math import radians, tan
from typing import NamedTuple

from ..landing import Landing
from ..parameters import Parameters
from ..touchdown import each_leg


class Case(NamedTuple):
    """A vehicle to be landed: its parameters, and a steady side load in parts of its weight."""

    name: str
    parameters: Parameters
    side_load: float = 0.0

    def landing(self, rtol: float) -> Landing:
        """A landing of this case at time 0, with its load on."""
        landing = Landing(self.parameters, rtol=rtol)
        landing.set_inputs({"external.force_x": self.side_load * weight(self.parameters)})
        return landing

    def without_sea(self) -> Case:
        """This case on a deck that no sea moves."""
        if self.parameters.sea.wave_height == 0.0:
            return self
        return self._replace(parameters=self.parameters.with_values({"sea.wave_height": 0.0}))

    @property
    def holds(self) -> bool:
        """Whether friction can hold the vehicle.

        It can if the ground's slope and the side load together are within the friction angle of the
        footpad that has least.
        """
        p = self.parameters
        friction = min(leg.ground.friction for leg in each_leg(p))
        return abs(tan(p.ground.slope)) + abs(self.side_load) < friction


SLOPE, SIDE_LOAD = radians(5.0), 0.1


def cases(parameters: Parameters) -> tuple[Case, ...]:
    """The cases of an audit.

    The vehicle as the parameters say, on a slope of 5 deg, and under a steady side load of a tenth
    of the weight.
    """
    return (
        Case("as it is", parameters),
        Case("slope of 5 deg", parameters.with_values({"ground.slope": SLOPE})),
        Case("side load of a tenth of the weight", parameters, SIDE_LOAD),
    )


def mass(parameters: Parameters) -> float:
    """Mass [kg] of body and footpads."""
    return parameters.whole_mass


def weight(parameters: Parameters) -> float:
    """Weight [N] of body and footpads."""
    return mass(parameters) * parameters.ground.gravity
