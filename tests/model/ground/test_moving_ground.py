"""A ground whose position is set at each step: it moves there over the next step.

Positions at longer intervals are in `test_ground_intervals.py`.
"""

from collections.abc import Callable
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.assembly import new_solver
from rlv_landing.inputs.driven import DrivenInputs
from rlv_landing.interruptible import advance
from rlv_landing.quantities import INPUT_NAMES, interface_of

FIGURES = "yue2022-figures"
LEGS = (1, 2, 3, 4)
MASS, GRAVITY = 178.0 + 4 * 4.2, 9.81
HEAVE, TILT = INPUT_NAMES.index("ground.heave"), INPUT_NAMES.index("ground.tilt")
# the transverse load where it does no work
CONSISTENT = {"vehicle.transverse_load_at": "footpad"}
# half a second in free flight
FLYING = {"drop.contact_time": 0.5, "drop.vertical_velocity": -6.0, "drop.pitch_rate": 0.0}
Motion = Callable[[float], float]


@pytest.fixture(scope="module")
def parked():
    """Makes a landing at rest on its ground, from a state kept by mode and slope."""
    kept = {}

    def make(mode: str, slope: float = 0.0) -> Landing:
        values = {**CONSISTENT, "ground.slope": slope}
        landing = Landing(load_preset(FIGURES, mode).with_values(values), rtol=1e-7)
        if (mode, slope) not in kept:
            landing.advance_to(8.0)
            kept[mode, slope] = landing.state()
        landing.restore(kept[mode, slope])
        return landing

    return make


def smooth(t: float, rise: float, duration: float) -> float:
    """From 0 to `rise` within `duration` [s], without a jump of the acceleration."""
    s = min(max(t / duration, 0.0), 1.0)
    return rise * s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def swell(t: float) -> float:
    """A heave [m] that grows within 2 s to a sinusoid of 100 mm and 4 s."""
    return smooth(t, 1.0, 2.0) * 0.1 * sin(0.5 * pi * t)


def second_derivative(x: Motion, t: float, h: float = 1e-4) -> float:
    return (x(t + h) - 2.0 * x(t) + x(t - h)) / h**2


def drive(landing: Landing, motions: dict[str, Motion], duration: float, dt: float = 1e-3):
    """Set the ground inputs `motions` at the start of each step of `dt` [s].

    Gives the time [s] since the call and the outputs, at the end of each step.
    """
    start, rows = landing.time, []
    for k in range(round(duration / dt)):
        landing.set_inputs({name: motion(k * dt) for name, motion in motions.items()})
        landing.advance_to(start + (k + 1) * dt)
        rows.append(((k + 1) * dt, landing.outputs()))
    return rows


def forces(rows, axis: str) -> np.ndarray:
    return np.array(
        [sum(out[f"leg[{leg}].contact.force_{axis}"] for leg in LEGS) for _, out in rows]
    )


@pytest.mark.parametrize("with_rate", [False, True])
@pytest.mark.parametrize("dt", [1e-3, 4e-3])
def test_forces_on_heaving_ground_are_mass_times_gravity_and_acceleration(
    parked, mode, dt, with_rate
):
    """With positions alone the ground is one step late, and otherwise the same as with rates."""
    landing, late = parked(mode), 0.0 if with_rate else dt
    before = landing.outputs()
    motions: dict[str, Motion] = {"ground.heave": swell}
    if with_rate:
        motions["ground.heave_rate"] = lambda t: (swell(t + 1e-6) - swell(t - 1e-6)) / 2e-6
    rows = drive(landing, motions, 5.0, dt)
    weight = [MASS * (GRAVITY + second_derivative(swell, t - late)) for t, _ in rows]
    assert np.abs(forces(rows, "y") / weight - 1.0).max() < 0.01
    now = landing.outputs()
    changes = {name: now[name] - before[name] for name in now}
    rise, speed = swell(5.0 - late), (swell(5.0) - swell(5.0 - 2.0 * dt)) / (2.0 * dt)
    assert changes["energy.work_ground"] - changes["energy.dissipated"] == approx(
        MASS * (GRAVITY * rise + 0.5 * speed**2), abs=0.1
    )
    assert abs(changes["energy.balance"]) < 1e-3


def test_positions_alone_lift_a_parked_vehicle_by_the_work_of_its_weight(parked, mode):
    landing = parked(mode)
    before = landing.outputs()
    drive(landing, {"ground.heave": lambda t: smooth(t, 0.3, 2.0)}, 4.0)
    now = landing.outputs()
    assert now["energy.work_ground"] - before["energy.work_ground"] == approx(
        MASS * GRAVITY * 0.3, rel=1e-3
    )
    assert now["body.y"] - before["body.y"] == approx(0.3, abs=1e-5)
    assert now["status.phase"] == 2.0


@pytest.mark.parametrize("slope", [0.0, 0.03])
@pytest.mark.parametrize("heaving", [False, True])
def test_a_parked_vehicle_turns_with_tilting_ground(parked, mode, slope, heaving):
    """Forces are its mass times the acceleration of its CG, as for a rigid vehicle.

    The shifted weight deflects the struts by a twentieth of the tilt.
    """
    landing = parked(mode, slope)
    first = landing.outputs()
    legs = [first[f"leg[{leg}].footpad.{axis}"] for axis in "xy" for leg in LEGS]
    x0 = (178.0 * first["body.x"] + 4.2 * sum(legs[:4])) / MASS
    y0 = (178.0 * first["body.y"] + 4.2 * sum(legs[4:])) / MASS

    def tilt(t: float) -> float:
        return smooth(t, 1.0, 2.0) * 0.01 * sin(0.5 * pi * t)

    def heave(t: float) -> float:
        return 0.4 * swell(t) if heaving else 0.0

    motions = {"ground.tilt": tilt, **({"ground.heave": heave} if heaving else {})}
    rows = drive(landing, motions, 5.0)
    x = lambda t: x0 * cos(tilt(t)) + y0 * sin(tilt(t))  # noqa: E731
    y = lambda t: heave(t) + y0 * cos(tilt(t)) - x0 * sin(tilt(t))  # noqa: E731
    late = [t - 1e-3 for t, _ in rows]
    weight = MASS * GRAVITY
    up = np.array([weight + MASS * second_derivative(y, t) for t in late])
    along = np.array([MASS * second_derivative(x, t) for t in late])
    assert np.abs(forces(rows, "y") - up).max() < 0.01 * weight
    assert np.abs(forces(rows, "x") - along).max() < 0.02 * weight
    pitch = np.array([out["body.pitch"] - first["body.pitch"] for _, out in rows])
    assert np.abs(pitch - [tilt(t) for t in late]).max() < 6e-4
    assert abs(rows[-1][1]["energy.balance"] - first["energy.balance"]) < 1e-3


def ground_at(landing: Landing) -> tuple[float, float]:
    """Heave [m] and tilt [rad] of the ground at the landing's time."""
    acting = landing.inputs()
    return acting["ground.heave"], acting["ground.tilt"]


def new_positions(most: float) -> st.SearchStrategy[float]:
    """Positions up to `most` that are not 0, where the ground is at the start."""
    return st.floats(-most, most).filter(lambda position: position != 0.0)


@settings(max_examples=30, deadline=None)
@given(
    positions=st.lists(
        st.tuples(new_positions(0.05), new_positions(0.02)),
        min_size=1,
        max_size=6,
        unique_by=(lambda position: position[0], lambda position: position[1]),
    ),
    rates=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.1, 0.1)),
    dt=st.sampled_from((1e-3, 3.7e-3)),
)
def test_the_ground_reaches_a_position_that_was_set_one_step_later(positions, rates, dt):
    """Its position is on top of the motion by its rates, and it continues at these.

    Each position differs from the one before, else the interval of positions is longer than a step.
    """
    landing = Landing(load_preset(FIGURES).with_values(FLYING))
    landing.set_inputs(dict(zip(("ground.heave_rate", "ground.tilt_rate"), rates)))
    landing.step(dt)
    here = ground_at(landing)
    for position in positions:
        landing.set_inputs(dict(zip(("ground.heave", "ground.tilt"), position)))
        assert ground_at(landing) == approx(here, abs=1e-15)
        landing.step(dt)
        now = ground_at(landing)
        for i in range(2):
            assert now[i] == approx(position[i] + rates[i] * dt, abs=1e-15)
        here = now
    landing.step(dt)
    assert ground_at(landing) == approx([h + r * dt for h, r in zip(here, rates)], abs=1e-15)


@settings(max_examples=30, deadline=None)
@given(
    position=st.tuples(new_positions(0.05), new_positions(0.02)),
    rates=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.1, 0.1)),
    part=st.floats(0.0, 1.0),
)
def test_the_ground_moves_to_a_position_linearly_on_top_of_its_rates(position, rates, part):
    solver = new_solver(load_preset(FIGURES).with_values(FLYING), 1e-5)
    inputs = DrivenInputs(solver, interface_of("2-2"))
    start = dt = 4e-3
    advance(solver, start)
    goals = dict(zip(("ground.heave", "ground.tilt"), position))
    inputs.set(start, {**goals, **dict(zip(("ground.heave_rate", "ground.tilt_rate"), rates))}, {})
    inputs.begin_step(start, start + dt)
    advance(solver, start + dt)
    solver.inputs_at(start + part * dt)
    for i, goal, rate in zip((HEAVE, TILT), position, rates):
        assert solver.u_now[i] == approx(part * (goal + rate * dt), abs=1e-15)


def test_positions_of_a_ramp_set_at_each_step_are_the_ramp_one_step_late(mode):
    """The integrator restarts at each step, which costs some accuracy."""
    parameters = load_preset(FIGURES, mode).with_values(
        {**CONSISTENT, "drop.contact_time": 0.05, "drop.vertical_velocity": -1.2}
    )
    stairs, ramp = (Landing(parameters, rtol=1e-9) for _ in range(2))
    for landing in (stairs, ramp):
        landing.advance_to(0.01)
    ramp.advance_to(0.011)
    ramp.set_inputs({"ground.heave_rate": 0.2})
    for k in range(300):
        stairs.set_inputs({"ground.heave": 0.2 * k * 1e-3})
        stairs.advance_to(0.01 + (k + 1) * 1e-3)
        ramp.advance_to(max(ramp.time, stairs.time))
        for name in ("body.y", "leg[1].main_strut.stroke"):
            assert stairs.get(name) == approx(ramp.get(name), abs=1e-7)
        assert stairs.get("leg[1].contact.force_y") == approx(
            ramp.get("leg[1].contact.force_y"), abs=2.0
        )
    assert stairs.get("energy.work_ground") == approx(ramp.get("energy.work_ground"), rel=1e-4)


def test_a_new_ground_position_changes_no_output_at_once(parked, mode):
    landing = parked(mode)
    for k in range(5):
        before = landing.values()
        landing.set_inputs({"ground.heave": 1e-4 * (k + 1) ** 2, "ground.tilt": 1e-5 * k})
        assert landing.values() == approx(before, rel=1e-12, abs=1e-12)
        landing.step(1e-3)
    before = landing.get("body.ax")
    landing.set_inputs({"external.force_x": 10.0})
    assert landing.get("body.ax") > before + 0.01


def test_a_ground_position_that_is_set_and_set_back_before_a_step_has_no_effect(parked, mode):
    changed, plain = parked(mode), parked(mode)
    changed.set_inputs({"ground.heave": 0.1, "ground.tilt": 0.3})
    changed.set_inputs({"ground.heave": 0.0, "ground.tilt": 0.0})
    for landing in (changed, plain):
        landing.advance_to(8.2)
    assert changed.get("body.y") == approx(plain.get("body.y"), abs=1e-9)
    assert changed.get("energy.work_ground") == plain.get("energy.work_ground")


def test_run_moves_the_ground_to_its_new_position_by_its_second_sample(parked, mode):
    by_run, by_steps = parked(mode), parked(mode)
    for landing in (by_run, by_steps):
        landing.set_inputs({"ground.heave": 2e-4, "external.force_x": 30.0})
    history = by_run.run(8.3, 2e-3)
    rows = [by_steps.values()]
    for k in range(1, len(history)):
        by_steps.advance_to(8.0 + k * 2e-3)
        rows.append(by_steps.values())
    assert np.array_equal(history.data, np.array(rows))
    assert by_run.state() == by_steps.state()


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_a_state_during_the_motion_to_a_new_position_goes_on_with_the_same_digits(
    parked, mode, steps
):
    landing, other = parked(mode), Landing(parked(mode).parameters, rtol=1e-7)
    for k in range(4):
        landing.set_inputs({"ground.heave": 1e-4 * k * k, "ground.tilt_rate": 0.01})
        landing.step(1e-3)
    landing.set_inputs({"ground.heave": 2e-3, "ground.tilt": 1e-4})
    for _ in range(steps):
        landing.step(1e-3)
    other.restore(landing.state())
    assert other.values() == landing.values()
    for copy in (landing, other):
        copy.advance_to(8.1)
    assert other.values() == landing.values()
    assert other.state() == landing.state()


@settings(max_examples=8, deadline=None)
@given(cuts=st.lists(st.floats(1e-5, 0.03), min_size=1, max_size=30))
def test_a_motion_at_rates_does_not_depend_on_the_steps(cuts):
    """The ground has reached its new position at the end of the first step."""
    straight, cut = Landing(), Landing()
    for landing in (straight, cut):
        landing.advance_to(0.05)
        landing.set_inputs({"ground.heave": 0.01, "ground.heave_rate": 0.2}, {"ground.tilt": 0.03})
        landing.step(1e-3)
    for dt in cuts:
        cut.advance_to(min(cut.time + dt, 0.4))
    for landing in (straight, cut):
        landing.advance_to(0.4)
    assert cut.values() == approx(straight.values(), rel=1e-9, abs=1e-9)


def test_the_motion_to_a_new_position_enters_the_balance_as_its_work():
    landing = Landing(load_preset(FIGURES), rtol=1e-8)
    landing.advance_to(0.3)
    landing.set_inputs({"ground.heave": 5e-4})
    assert landing.get("energy.work_ground") == 0.0
    landing.step(1e-3)
    assert landing.get("energy.work_ground") > 0.0
    landing.advance_to(0.6)
    assert abs(landing.get("energy.balance")) < 1e-3
