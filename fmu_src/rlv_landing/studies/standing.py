"""Whether a vehicle stands: what it still moves by can neither tip it over nor load it further.

Most of a landing's time passes until the last millimetres per second have died away. By then its
peaks, its margins and its outcome have long been decided.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..history import History
from ..landing import Landing

Array = NDArray[np.float64]
# the part of the energy that tips a vehicle over, which one that stands has at most
ENERGY_PART = 1e-3


def may_stand(landing: Landing) -> bool:
    """Whether nothing but the ground at rest acts on the landing from now on."""
    if landing.parameters.sea.wave_height > 0.0:
        return False
    positions = {landing.interface.input_names[i] for i in landing.interface.positions}
    return not any(v for name, v in landing.inputs().items() if name not in positions)


def stands(part: History) -> bool:
    """Whether the vehicle stood during the whole of a `part` of its landing, a quarter second.

    At every sample all footpads touch, the CG is above their polygon, and the kinetic energy is a
    thousandth of the energy that lifts the CG over the polygon's nearest edge, at most. It does not
    grow: a vehicle that slides faster and faster does not stand. [closure]
    """
    assert part.parameters is not None
    p, legs = part.parameters, part.legs
    if not all((part[f"leg[{leg}].contact.active"] > 0.0).all() for leg in legs):
        return False
    feet = np.array([part[f"leg[{leg}].footpad.y"] for leg in legs])
    pads = np.array([p.of_leg(leg).vehicle.footpad_mass for leg in legs])
    mass = p.vehicle.mass + float(pads.sum())
    height = (p.vehicle.mass * part["body.y"] + pads @ feet) / mass
    height = height - feet.min(axis=0)
    margin, kinetic = part["status.stability_margin"], part["energy.kinetic"]
    # how far the CG rises on its way over the edge
    lift: Array = np.hypot(height, margin) - height
    tipping = mass * p.ground.gravity * lift
    if not ((margin > 0.0) & (kinetic < ENERGY_PART * tipping)).all():
        return False
    half = len(part) // 2
    return bool(kinetic[half:].max() <= kinetic[:half].max())
