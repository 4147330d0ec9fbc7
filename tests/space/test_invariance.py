"""A landing in space does not depend on how the scene is turned or mirrored; what is conserved."""

from __future__ import annotations

from math import asin, atan2, cos, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from space_vehicles import TURNING, UNEVEN, vehicle

from rlv_landing import Landing, Parameters

Array = NDArray[np.float64]
SCENE = TURNING | {"ground.slope": 0.04, "ground.slope_direction": 0.7}


def turn(parameters: Parameters) -> Rotation:
    """The attitude at the first contact, by another library than the model's own expressions."""
    d = parameters.drop
    angles = (("z", -d.tilt), ("x", d.roll), ("y", d.heading))
    z, x, y = (Rotation.from_euler(axis, angle) for axis, angle in angles)
    return z * x * y


def turned(parameters: Parameters, angle: float) -> Parameters:
    """The whole scene turned by `angle` [rad] about the vertical."""
    about = Rotation.from_euler("y", angle)
    m = (about * turn(parameters)).as_matrix()
    d = parameters.drop
    v = about.apply([d.horizontal_velocity, d.vertical_velocity, d.lateral_velocity])
    w = about.apply([d.roll_rate, d.yaw_rate, -d.pitch_rate])
    down = about.apply(
        [cos(parameters.ground.slope_direction), 0.0, sin(parameters.ground.slope_direction)]
    )
    return parameters.with_values(
        {
            "drop.tilt": atan2(m[0, 1], m[1, 1]),
            "drop.roll": asin(m[2, 1]),
            "drop.heading": atan2(-m[2, 0], m[2, 2]),
            "drop.horizontal_velocity": v[0],
            "drop.lateral_velocity": v[2],
            "drop.roll_rate": w[0],
            "drop.yaw_rate": w[1],
            "drop.pitch_rate": -w[2],
            "ground.slope_direction": atan2(down[2], down[0]),
        }
    )


def vectors(landing: Landing, leg: int) -> dict[str, Array]:
    """Vectors of the inertial frame."""
    now = landing.outputs()
    named = {"place": "body.{}", "velocity": "body.v{}", "acceleration": "body.a{}"}
    named |= {"foot": f"leg[{leg}].footpad.{{}}", "force": f"leg[{leg}].contact.force_{{}}"}
    return {
        what: np.array([now[name.format(axis)] for axis in "xyz"]) for what, name in named.items()
    }


@settings(max_examples=6, deadline=None)
@given(angle=st.floats(-3.0, 3.0))
def test_turning_the_scene_about_the_vertical_turns_the_landing(angle: float) -> None:
    one = vehicle(SCENE)
    two = turned(one, angle)
    about = Rotation.from_euler("y", angle)
    landings = Landing(one, rtol=1e-9), Landing(two, rtol=1e-9)
    for time in (0.05, 0.12, 0.25):
        for landing in landings:
            landing.advance_to(time)
        for leg in (1, 2, 3, 4):
            first, second = (vectors(landing, leg) for landing in landings)
            for name, vector in first.items():
                assert second[name] == pytest.approx(about.apply(vector), rel=1e-5, abs=1e-5), name
        one_leg, other = (landing.get("leg[2].main_strut.force") for landing in landings)
        assert other == pytest.approx(one_leg, rel=1e-5, abs=1e-4)


def mirrored(parameters: Parameters) -> Parameters:
    """The scene mirrored at the plane z = 0; the vehicle is its own mirror image."""
    d, g = parameters.drop, parameters.ground
    return parameters.with_values(
        {
            "drop.heading": -d.heading,
            "drop.roll": -d.roll,
            "drop.roll_rate": -d.roll_rate,
            "drop.yaw_rate": -d.yaw_rate,
            "drop.lateral_velocity": -d.lateral_velocity,
            "ground.slope_direction": -g.slope_direction,
        }
    )


def test_the_mirrored_scene_gives_the_mirrored_landing() -> None:
    one = vehicle(SCENE)
    landings = Landing(one, rtol=1e-9), Landing(mirrored(one), rtol=1e-9)
    images = {1: 1, 2: 4, 3: 3, 4: 2}
    for time in (0.05, 0.12, 0.25):
        for landing in landings:
            landing.advance_to(time)
        for leg, image in images.items():
            first, second = vectors(landings[0], leg), vectors(landings[1], image)
            for name, vector in first.items():
                other = second[name] * [1.0, 1.0, -1.0]
                assert other == pytest.approx(vector, rel=1e-5, abs=1e-5), name


def momenta(landing: Landing, parameters: Parameters) -> Array:
    """Momentum and angular momentum about the inertial origin, of body and footpads.

    The footpads' velocities are differences over 1 us.
    """
    v, now = parameters.vehicle, landing.outputs()
    later = Landing.__new__(Landing)
    later.__dict__.update(landing.__class__(parameters).__dict__)
    later.restore(landing.state())
    later.advance_to(landing.time + 1e-6)
    then = later.outputs()

    def vector(outputs: dict[str, float], name: str) -> Array:
        return np.array([outputs[name.format(axis)] for axis in "xyz"])

    q = [now[f"body.q_{part}"] for part in "xyzw"]
    inertia = np.array(
        [
            [v.inertia_roll, v.inertia_xy, v.inertia_xz],
            [v.inertia_xy, v.inertia_yaw, v.inertia_yz],
            [v.inertia_xz, v.inertia_yz, v.inertia],
        ]
    )
    spin = inertia @ vector(now, "body.spin_{}")
    place, velocity = vector(now, "body.{}"), vector(now, "body.v{}")
    momentum = v.mass * velocity
    angular = Rotation.from_quat(q).apply(spin) + np.cross(place, momentum)
    for leg in landing.interface.legs:
        foot = vector(now, f"leg[{leg}].footpad.{{}}")
        moved = v.footpad_mass * (vector(then, f"leg[{leg}].footpad.{{}}") - foot) / 1e-6
        momentum = momentum + moved
        angular = angular + np.cross(foot, moved)
    return np.concatenate([momentum, angular])


def test_a_tumbling_flight_keeps_momentum_angular_momentum_and_energy() -> None:
    tumbling: dict[str, Any] = (
        TURNING
        | UNEVEN
        | {
            "ground.gravity": 0.0,
            "drop.contact_time": 3.0,
            "drop.vertical_velocity": -5.0,
            "drop.pitch_rate": 0.9,
            "drop.roll_rate": -0.6,
            "drop.yaw_rate": 0.8,
        }
    )
    parameters = vehicle(tumbling)
    landing = Landing(parameters, rtol=1e-9)
    first = momenta(landing, parameters)
    for time in (0.7, 1.5, 2.9):
        landing.advance_to(time)
        assert momenta(landing, parameters) == pytest.approx(first, rel=2e-5, abs=2e-3)
        assert abs(landing.get("energy.balance")) < 1e-6


def test_a_vehicle_turned_by_a_leg_s_spacing_is_the_same() -> None:
    three = vehicle(TURNING | {"vehicle.legs": 3.0})
    half = 2.0 * pi / 3.0
    other = three.with_values({"vehicle.leg_azimuth": three.vehicle.leg_azimuth - half})
    landings = Landing(three, rtol=1e-8), Landing(other, rtol=1e-8)
    for landing in landings:
        landing.advance_to(0.3)
    one, two = (landing.outputs() for landing in landings)
    for name in ("body.x", "body.y", "body.z", "body.pitch", "body.roll", "body.heading"):
        assert two[name] == pytest.approx(one[name], abs=1e-8)
    force = "leg[{}].main_strut.force"
    assert two[force.format(2)] == pytest.approx(one[force.format(1)], rel=1e-5)
