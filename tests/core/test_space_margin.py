"""The stability margin in space is the distance to the nearest edge of the footpads' hull."""

from array import array

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from rlv_landing import load_preset
from rlv_landing.assembly.spatial_flight import attitude
from rlv_landing.assembly.start import landing_system, start_state
from rlv_landing.core import Exponential
from rlv_landing.core.access import SPATIAL_STATE
from rlv_landing.quantities import interface_of

PRESET = load_preset("yue2022-figures")


def inside(hull: ConvexHull, point: np.ndarray) -> float:
    """Distance of a point from the hull's nearest edge, negative outside."""
    return float(-(hull.equations[:, :2] @ point + hull.equations[:, 2]).max())


@pytest.mark.parametrize("legs", [3, 4, 5, 8])
@pytest.mark.parametrize("roll", [0.0, 0.4, 1.3, 3.0])
def test_the_margin_is_that_of_the_hull_in_whatever_order_the_footpads_stand(legs, roll):
    """Upside down the legs run the other way round; a leg drawn in is a corner no more."""
    values = {"drop.mode": "space", "vehicle.legs": legs}
    parameters = PRESET.with_values(values)
    solver = Exponential(landing_system(parameters), 1e-5)
    still = [0.0] * len(interface_of("space", legs).inputs)
    names = interface_of("space", legs).output_names
    out = array("d", bytes(8 * len(names)))
    for drawn in (1.0, 0.05):
        y = start_state(parameters, still, still)
        y[3:7] = array("d", attitude(0.2, roll, 0.3))
        y[SPATIAL_STATE] *= drawn
        solver.outputs_at(0.0, y, out)
        read = dict(zip(names, out))
        masses = [parameters.vehicle.footpad_mass] * legs
        feet = np.array(
            [[read[f"leg[{i + 1}].footpad.{axis}"] for axis in "xz"] for i in range(legs)]
        )
        body = parameters.vehicle.mass
        cg = (body * np.array([read["body.x"], read["body.z"]]) + masses @ feet) / (
            body + sum(masses)
        )
        assert read["status.stability_margin"] == pytest.approx(
            inside(ConvexHull(feet), cg), abs=1e-9
        )
