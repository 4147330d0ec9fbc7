"""The landing against MuJoCo, a multibody engine with its own coordinates and integrators.

Both sides have the same masses, geometry and linear struts (`linear_struts` says how linear ours
are). First the multibody dynamics alone: a violent flight without ground, and landings on our
frictionless ground law. Then landings on MuJoCo's own contact. That is a soft constraint, which
reacts to the footpad's acceleration too. So ours is set near rigid and well damped, and only
quantities that hardly depend on the law of a hard contact are compared.
"""

from typing import Any

import numpy as np
import pytest
from mujoco_vehicle import land, linear_struts

from rlv_landing import Landing, Parameters, load_preset

BODY = ("x", "y", "pitch", "vx", "vy", "pitch_rate")
COLUMNS = {
    "stroke": "main_strut.stroke",
    "main_force": "main_strut.force",
    "aux_force": "auxiliary_strut.force",
}
# 50 MN/m on 4.2 kg, critically damped: 0.3 ms, which is also MuJoCo's time constant below; sticking
# within 0.02 mm
HARD = {
    "ground.exponent": 1.0, "ground.stiffness": 5e7,
    "ground.damping": 29000.0, "ground.damping_depth": 1e-5,
    "ground.stribeck_gain": 0.0, "ground.stick_displacement": 2e-5, "ground.stick_damping": 500.0,
}  # fmt: skip
MUJOCO_HARD = (3e-4, 1.0)
# the tolerances below were derived for these values, so no preset may change them
FIXED = {
    "vehicle.transverse_load_at": "footpad", "vehicle.inertia": 197.0,
    "auxiliary_strut.stiffness": 3e5, "auxiliary_strut.damping": 7000.0,
    "drop.contact_time": 0.09, "drop.tilt": -0.133, "drop.pitch_rate": 0.18,
    "drop.horizontal_velocity": 0.354, "drop.vertical_velocity": -1.4,
}  # fmt: skip


def vehicle(mode: str, values: dict[str, Any]) -> Parameters:
    return linear_struts(load_preset("yue2022-figures", mode).for_mode(mode)).with_values(
        {**FIXED, **values}
    )


def ours(
    parameters: Parameters,
    until: float,
    load: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> tuple[list[float], dict[str, Any]]:
    """Body state at time 0, and the landing under the names of `mujoco_vehicle.land`."""
    landing = Landing(parameters, rtol=1e-8)
    start = [landing.get(f"body.{name}") for name in BODY]
    landing.set_inputs(dict(zip(("external.force_x", "external.force_y", "external.moment"), load)))
    history = landing.run(until, 1e-4)
    out: dict[str, Any] = {name: history[f"body.{name}"][::10] for name in ("x", "y", "pitch")}
    for name, column in COLUMNS.items():
        out[name] = np.array([history[f"leg[{leg}].{column}"][::10] for leg in (1, 2, 3, 4)])
    active = np.array([history[f"leg[{leg}].contact.active"] for leg in (1, 2, 3, 4)])
    out["first_touch"] = np.where(active.any(axis=1), history.time[active.argmax(axis=1)], np.inf)
    return start, out


def worst(a: dict[str, Any], b: dict[str, Any], name: str) -> float:
    return float(np.abs(a[name] - b[name]).max())


def assert_same_pose(a: dict[str, Any], b: dict[str, Any], tolerance: float) -> None:
    for name in ("x", "y", "pitch"):
        assert worst(a, b, name) < tolerance, name
    assert np.abs(b["z"]).max() < 1e-9


def test_a_turning_flight_under_loads_with_swinging_legs_is_that_of_mujoco(mode: str) -> None:
    """At 6 rad/s Coriolis and centripetal terms move the footpads.

    The struts are stretched by 5 to 7 mm and hardly damped. In tension our strut has its stop's 1
    kN/m beside 230 kN/m, 4e-3: 3e-5 m of 7 mm, 3 N of 1.7 kN, and as little of the body.
    """
    values = {
        "drop.pitch_rate": 6.0,
        "drop.tilt": 0.0,
        "drop.contact_time": 0.3,
        "drop.vertical_velocity": -12.0,
    }
    parameters = vehicle(mode, {**values, "auxiliary_strut.damping": 500.0})
    start, mine = ours(parameters, 0.28, (400.0, 200.0, 200.0))
    theirs = land(parameters, start, 0.28, 5e-5, None, (400.0, 200.0, 200.0))
    assert np.abs(mine["stroke"]).max() > 4e-3
    assert_same_pose(mine, theirs, 3e-5)
    assert worst(mine, theirs, "stroke") < 5e-3 * np.abs(mine["stroke"]).max()
    assert worst(mine, theirs, "main_force") < 3e-3 * np.abs(mine["main_force"]).max()
    assert worst(mine, theirs, "aux_force") < 3e-3 * np.abs(mine["aux_force"]).max()


def test_a_landing_on_the_same_ground_law_is_that_of_mujoco(mode: str) -> None:
    """A slope, loads, no friction.

    Our liquid stiffens by 6e-4 at the peak, and our damper lags by 2e-5 s at the blow of a contact.
    """
    ground = {
        "ground.friction": 0.0, "ground.stick_damping": 0.0, "ground.exponent": 1.0,
        "ground.stiffness": 5e6, "ground.damping": 2000.0,
        "ground.damping_depth": 1e-4, "ground.slope": 0.05, "drop.contact_time": 0.0,
    }  # fmt: skip
    parameters = vehicle(mode, ground)
    start, mine = ours(parameters, 0.3, (400.0, 200.0, 100.0))
    theirs = land(parameters, start, 0.3, 5e-5, None, (400.0, 200.0, 100.0))
    peak = np.abs(mine["main_force"]).max(axis=1)
    assert peak.min() > 3000.0
    assert_same_pose(mine, theirs, 5e-5)
    assert worst(mine, theirs, "stroke") < 1e-3 * mine["stroke"].max()
    assert np.abs(theirs["main_force"]).max(axis=1) == pytest.approx(peak, rel=1e-3)
    assert theirs["first_touch"] == pytest.approx(mine["first_touch"], abs=2e-4)


def test_a_frictionless_landing_on_mujocos_own_contact_is_ours(mode: str) -> None:
    """Under 6 kN our ground is compressed by 0.1 mm, MuJoCo's by less.

    The strokes differ by that much, the body by half of it.
    """
    parameters = vehicle(mode, {**HARD, "ground.friction": 0.0, "ground.stick_damping": 0.0})
    start, mine = ours(parameters, 0.4)
    theirs = land(parameters, start, 0.4, 5e-5, MUJOCO_HARD)
    assert_same_pose(mine, theirs, 5e-5)
    assert worst(mine, theirs, "stroke") < 1e-4
    assert np.abs(theirs["main_force"]).max(axis=1) == pytest.approx(
        np.abs(mine["main_force"]).max(axis=1), rel=0.02
    )
    assert theirs["first_touch"] == pytest.approx(mine["first_touch"], abs=3e-4)


def test_contact_intervals_and_peaks_with_friction_are_near_those_on_mujocos_own_contact(
    mode: str,
) -> None:
    """Coulomb friction 0.3, regularised by a displacement here, by a soft constraint there.

    Footpads that hop, stick and slip magnify the difference. Ours alone moves by 1.5 mm (2-2 at 0.4
    s) when the stick displacement goes from 20 to 2 micrometres, MuJoCo's by 0.5 mm with its time
    constant. They differ by 3.6 mm of 0.39 m, so contacts differ by a few milliseconds of 115 to
    186 ms. The largest strokes and forces hardly depend on it. The auxiliary struts' do: their
    impact at contact depends on the law.
    """
    parameters = vehicle(mode, {**HARD, "ground.friction": 0.3})
    start, mine = ours(parameters, 0.4)
    theirs = land(parameters, start, 0.4, 5e-5, MUJOCO_HARD)
    assert_same_pose(mine, theirs, 5e-3)
    assert theirs["first_touch"] == pytest.approx(mine["first_touch"], abs=5e-3)
    assert theirs["stroke"].max(axis=1) == pytest.approx(mine["stroke"].max(axis=1), rel=0.01)
    assert np.abs(theirs["main_force"]).max(axis=1) == pytest.approx(
        np.abs(mine["main_force"]).max(axis=1), rel=0.05
    )
