"""Vehicles of other sizes: the prototype scaled after Froude, so that its measures are known."""

from __future__ import annotations

import re

import pint

from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters

# powers of the length's factor; gravity stays
POWERS = {"[mass]": 3.0, "[length]": 1.0, "[time]": 0.5}
UNITS = pint.UnitRegistry()


def power(unit: str) -> float:
    """The power of the length's factor by which a quantity of this SI unit grows."""
    spelled = re.sub(r"(?<=[a-z])(\d)", r"**\1", unit.replace(".", "*"))
    dimensions = UNITS.Unit(spelled or "dimensionless").dimensionality
    return sum(float(exponent) * POWERS[name] for name, exponent in dimensions.items())


def scaled(parameters: Parameters, mass: float) -> Parameters:
    """The same vehicle with the mass `mass` [kg], all lengths in proportion, gravity the same.

    Its landing is the prototype's in every dimensionless number. Laws with exponents are written
    for 1 m: their stiffness keeps the force at a scaled deflection.
    """
    factor = (mass / parameters.vehicle.mass) ** (1.0 / 3.0)
    # the ship is no part of a landing without waves
    scene = "sea." if parameters.sea.wave_height == 0.0 else ()
    values = {
        name: value * factor ** power(PARAMETER_QUANTITIES[name].unit)
        for name, value in parameters.items()
        if not isinstance(value, str) and not name.startswith(scene)
    }
    for group in ("auxiliary_strut", "ground"):
        exponent = getattr(parameters, group).exponent
        values[f"{group}.stiffness"] *= factor ** (1.0 - exponent)
    return parameters.with_values(values)
