"""The benchmarks' landing in C computes what the core computes.

Otherwise its time would say nothing about the core.
"""

import sys
from pathlib import Path

import pytest

from rlv_landing import Landing, load_preset
from rlv_landing.assembly import new_solver
from rlv_landing.quantities import INPUT_NAMES, interface_of

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
from bench_space import SPACE
from c_landing import CLanding, core_solver, disagreement
from cvode_in_c import ADAMS, BDF, CvodeInC
from problem import TIMES, Problem

# a load and a deck, all of them changing
INPUTS = {
    "external.force_x": 300.0,
    "external.force_y": -200.0,
    "external.moment": 40.0,
    "ground.heave_rate": 0.05,
    "ground.tilt_rate": 0.02,
}
RATES = {"external.force_y": 500.0, "ground.heave_rate": -0.3, "ground.tilt_rate": 0.1}


@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_the_landing_in_c_takes_the_cores_steps_to_the_same_states(mode, rtol):
    parameters = load_preset("yue2022-figures", mode)
    assert disagreement(new_solver(parameters, rtol), CLanding(parameters, rtol), 0.5) < 1e-9


def test_the_landing_in_c_has_the_cores_inputs_slope_and_stops(mode):
    """Covers the transverse load at the footpads, a slope and both end stops."""
    values = {
        "vehicle.transverse_load_at": "footpad",
        "ground.slope": 0.03,
        "drop.vertical_velocity": -4.0,
        "main_strut.stroke_max": 0.03,
    }
    parameters = load_preset("yue2022-figures", mode).with_values(values)
    solver = new_solver(parameters, 1e-4)
    for i, name in enumerate(INPUT_NAMES):
        solver.u[i], solver.u_rate[i] = INPUTS.get(name, 0.0), RATES.get(name, 0.0)
    solver.restart(0.0)
    solver.rhs_calls = 1.0  # the C landing starts with the inputs, so it has no restart
    assert disagreement(solver, CLanding(parameters, 1e-4, inputs=INPUTS, rates=RATES), 0.3) < 1e-9
    watched = Landing(parameters, mode, 1e-4)
    watched.set_inputs(INPUTS, RATES)
    stroke = watched.run(0.3)["leg[1].main_strut.stroke"]
    assert stroke.min() < 0.0
    assert stroke.max() > 0.03


@pytest.mark.parametrize("joint", ["footpad", "joint"])
def test_the_landing_in_space_in_c_takes_the_cores_steps_to_the_same_states(joint):
    """With all inputs: loads, and a deck that moves and turns in all directions."""
    legs = {"vehicle.legs": 5.0, "vehicle.inertia_roll": 120.0, "vehicle.inertia_yaw": 60.0}
    tensor = {"vehicle.inertia_xy": 3.0, "vehicle.inertia_yz": -4.0, "vehicle.cg_offset_x": 0.03}
    parameters = load_preset("yue2022-figures").with_values(
        {**SPACE, **legs, **tensor, "vehicle.transverse_load_at": joint}
    )
    names = interface_of("space").input_names
    inputs = {name: 0.03 for name in names if name.endswith("_rate")}
    inputs |= {"external.force_z": 200.0, "external.moment_x": 30.0, "external.moment_y": -20.0}
    rates = {"external.force_x": 300.0, "ground.sway_rate": 0.1, "ground.yaw_rate": -0.2}
    solver = core_solver(parameters, 1e-5)
    for i, name in enumerate(names):
        solver.u[i], solver.u_rate[i] = inputs.get(name, 0.0), rates.get(name, 0.0)
    solver.restart(0.0)
    solver.rhs_calls = 1.0
    assert disagreement(solver, CLanding(parameters, 1e-5, inputs=inputs, rates=rates), 0.4) < 1e-9


def test_a_landing_in_c_of_another_vehicle_is_told_from_the_cores(mode):
    parameters = load_preset("yue2022-figures", mode)
    heavier = parameters.with_values({"vehicle.inertia": 250.0})
    assert disagreement(new_solver(parameters, 1e-5), CLanding(heavier, 1e-5), 0.2) > 1e-3


@pytest.mark.parametrize("method", [ADAMS, BDF])
def test_cvode_lands_as_the_core_does(mode, method):
    """CVODE, which shares no code with the core, finds the same peaks and strokes."""
    problem = Problem(mode)
    found = problem.error(CvodeInC(problem, 3e-9, method, 2e-3, 500_000).states(TIMES))
    assert found.peaks < 1e-4
    assert found.stroke < 1e-6
