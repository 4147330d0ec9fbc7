"""Whether a vehicle stands: what it still moves by can neither tip it over nor load it further.

Most of a landing's time passes until the last millimetres per second have died away. By then its
peaks, its margins and its outcome have long been decided.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..landing import Landing
from ..outputs import layout_of

Array = NDArray[np.float64]
# the part of the energy that tips a vehicle over, which one that stands has at most
ENERGY_PART = 1e-3


def may_stand(landing: Landing) -> bool:
    """Whether nothing but the ground at rest acts on the landing from now on."""
    if landing.parameters.sea.wave_height > 0.0:
        return False
    positions = {landing.interface.input_names[i] for i in landing.interface.positions}
    return not any(v for name, v in landing.inputs().items() if name not in positions)


class Standing:
    """Whether the vehicle of a landing stands, by rows of its samples.

    Args:
        landing: The landing.
    """

    def __init__(self, landing: Landing) -> None:
        p, legs = landing.parameters, landing.interface.legs
        place = layout_of(p.drop.mode, landing.interface.output_names).places
        pads = np.array([p.of_leg(leg).vehicle.footpad_mass for leg in legs])
        mass = p.vehicle.mass + float(pads.sum())
        self._weight = mass * p.ground.gravity
        self._parts = np.array([p.vehicle.mass, *pads]) / mass
        self._touching = [place[f"leg[{leg}].contact.active"][0] for leg in legs]
        self._heights = [place["body.y"][0], *(place[f"leg[{leg}].footpad.y"][0] for leg in legs)]
        self._margin = place["status.stability_margin"][0]
        self._kinetic = place["energy.kinetic"][0]

    def at_all(self, rows: Array) -> bool:
        """Whether it stood at all samples `rows` of a quarter second, (n, row).

        At every sample all footpads touch, the CG is above their polygon, and the kinetic energy is
        a thousandth of the energy that lifts the CG over the polygon's nearest edge, at most. It
        does not grow: a vehicle that slides faster and faster does not stand. [closure]
        """
        if not all(rows[-1, i] > 0.0 for i in self._touching):
            return False
        margin, kinetic = rows[:, self._margin], rows[:, self._kinetic]
        if not ((margin > 0.0).all() and (rows[:, self._touching] > 0.0).all()):
            return False
        heights = rows[:, self._heights]
        height = heights @ self._parts - heights[:, 1:].min(axis=1)
        # how far the CG rises on its way over the edge
        lift: Array = np.hypot(height, margin) - height
        if not (kinetic < ENERGY_PART * self._weight * lift).all():
            return False
        half = len(rows) // 2
        return bool(kinetic[half:].max() <= kinetic[:half].max())
