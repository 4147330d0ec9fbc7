"""The loads at the legs' interfaces are what accelerates the body."""

from __future__ import annotations

import numpy as np
import pytest
from five_legs import five_legs
from scipy.spatial.transform import Rotation

from rlv_landing import Landing, load_preset
from rlv_landing.audit.spatial_momentum import inertia_tensor
from rlv_landing.figures.landing_report.loads import FOOTPAD, interface_loads, peaks
from rlv_landing.quantities import azimuth, groups_of
from rlv_landing.touchdown import leg_directions


def in_body(vectors, history, leg):
    """Vectors in a leg's axes, in those of the body."""
    sine, cosine = next(
        (side * azimuth(g.azimuth)[0], azimuth(g.azimuth)[1])
        for g in groups_of(history.parameters.drop.mode)
        for number, side in g.legs
        if number == leg
    )
    return turned_to_body(vectors, sine, cosine)


def turned_to_body(vectors, sine, cosine):
    """Vectors radial, axial, tangential of a leg at an azimuth, in axes of the body."""
    radial, axial, tangential = vectors.T
    return np.stack(
        [cosine * radial - sine * tangential, axial, sine * radial + cosine * tangential], axis=-1
    )


@pytest.mark.parametrize("at", ["footpad", "joint"])
def test_forces_and_moments_at_the_joints_are_the_bodys_acceleration(mode, at):
    p = load_preset("yue2022-figures", mode).with_values({"vehicle.transverse_load_at": at})
    history = Landing(p).run(0.5, 1e-3)
    force, moment = np.zeros((2, len(history), 3))
    for found in interface_loads(history):
        if found.name == FOOTPAD:
            continue
        push, about, point = (
            in_body(v, history, found.leg) for v in (*np.split(found.load, 2, 1), found.point)
        )
        force += push
        moment += about + np.cross(point, push)
    s, c = np.sin(history["body.pitch"]), np.cos(history["body.pitch"])
    ax, ay = history["body.ax"], history["body.ay"] + p.ground.gravity
    wanted = p.vehicle.mass * np.stack([ax * c - ay * s, ax * s + ay * c, 0.0 * s], axis=-1)
    assert np.abs(force - wanted).max() < 1e-8 * np.abs(wanted).max()
    # pitch is clockwise, against the moment about z
    turning = -p.vehicle.inertia * history["body.pitch_acceleration"]
    assert np.abs(moment[:, 2] - turning).max() < 1e-7 * np.abs(turning).max()
    assert np.abs(moment[:, :2]).max() < 1e-7 * np.abs(turning).max()


def test_a_peak_comes_with_the_whole_load_at_its_time(drop_test):
    for found in interface_loads(drop_test):
        for peak in peaks(found, drop_test.time):
            row = int(np.argmin(np.abs(drop_test.time - peak.time)))
            assert peak.load == tuple(found.load[row])
            assert abs(peak.load[peak.component]) == np.abs(found.load[:, peak.component]).max()


# a leg that is longer, stands further out and has a heavier foot than the others
OWN = {
    "leg[2].main_strut.joint_radius": 0.5,
    "leg[2].auxiliary_strut.length": 1.2,
    "leg[2].vehicle.footpad_mass": 6.0,
}


@pytest.mark.parametrize("own", [{}, OWN], ids=["alike", "one leg of its own"])
@pytest.mark.parametrize(
    "values",
    [
        {"vehicle.transverse_load_at": "footpad"},
        {"vehicle.transverse_load_at": "joint"},
        # whose footpads are lower, and so are the points that strike
        {"leg.kind": "tripod", "vehicle.body_points": "0.25 -2.21 0; -0.12 -2.21 0.22"},
    ],
    ids=["footpad", "joint", "tripod"],
)
def test_in_space_they_are_the_acceleration_of_a_body_whose_cg_is_off_the_axis(values, own):
    p = five_legs().with_values({**values, **own})
    history = Landing(p).run(0.5, 1e-3)
    force, moment = np.zeros((2, len(history), 3))
    directions = leg_directions(p)
    for found in interface_loads(history):
        if found.name != FOOTPAD:
            # the ground strikes the body itself, too
            sine, cosine = directions.get(found.leg, (0.0, 1.0))
            push, about, point = (
                turned_to_body(v, sine, cosine) for v in (*np.split(found.load, 2, 1), found.point)
            )
            force += push
            moment += about + np.cross(point, push)
    assert history["body.clearance"].min() < 0.0
    turn = Rotation.from_quat(np.column_stack([history[f"body.q_{c}"] for c in "xyzw"]))
    pull = np.column_stack([history[f"body.a{c}"] for c in "xyz"])
    pull[:, 1] += p.ground.gravity
    wanted = p.vehicle.mass * turn.inv().apply(pull)
    assert np.abs(force - wanted).max() < 1e-7 * np.abs(wanted).max()
    spin, rate = (
        np.column_stack([history[f"body.spin_{kind}{c}"] for c in "xyz"])
        for kind in ("", "acceleration_")
    )
    inertia = inertia_tensor(p)
    turning = rate @ inertia + np.cross(spin, spin @ inertia)
    assert np.abs(moment - turning).max() < 1e-7 * np.abs(turning).max()
