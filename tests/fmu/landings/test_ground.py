"""The ground of the FMU: at the start, and with positions that are set at each step."""

from __future__ import annotations

from math import pi, sin

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from fmu_instance import DISCARD, ERROR, OK

from rlv_landing import Landing, LandingError, Parameters
from rlv_landing.quantities import OUTPUT_NAMES

GROUND = {
    "ground.heave": 0.3,
    "ground.heave_rate": 0.2,
    "ground.tilt": -0.05,
    "ground.tilt_rate": 0.03,
    "external.force_x": 100.0,
}
OUTPUTS = (
    "body.x",
    "body.y",
    "body.pitch",
    "energy.work_ground",
    "energy.balance",
    "leg[1].contact.force_y",
)
WEIGHT = (178.0 + 4 * 4.2) * 9.81


def outputs_of(instance) -> list[float]:
    return [instance.get(name) for name in OUTPUTS]


@pytest.mark.parametrize("read_between", [False, True])
@pytest.mark.parametrize("when", ["before", "after", "both"])
def test_inputs_before_the_first_step_place_the_vehicle_whenever_they_are_set(
    instance, when, read_between
):
    """As start values, after the initialisation, or first others and then these."""
    landing = Landing(inputs=GROUND)
    if when == "both":
        instance.start(**{name: -0.5 * value for name, value in GROUND.items()})
    else:
        instance.start(**(GROUND if when == "before" else {}))
    if when != "before":
        for name, value in GROUND.items():
            if read_between:
                instance.get("body.y")
            instance.set(name, value)
    assert outputs_of(instance) == [landing.get(name) for name in OUTPUTS]
    for k in range(400):
        assert instance.step(k * 1e-3, 1e-3) == OK
        landing.advance_to(k * 1e-3 + 1e-3)
    assert outputs_of(instance) == [landing.get(name) for name in OUTPUTS]
    assert max(landing.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4)) > 0.0


def test_start_values_in_fmpy_give_the_same_landing_as_landing(fmu):
    result = simulate_fmu(
        str(fmu),
        stop_time=0.5,
        step_size=1e-3,
        output_interval=1e-3,
        start_values=GROUND,
        output=list(OUTPUTS),
    )
    landing = Landing(inputs=GROUND)
    history = landing.run(0.5, 1e-3)
    for name in OUTPUTS:
        assert result[name][:501] == pytest.approx(history[name], rel=1e-9, abs=1e-9), name


def test_a_start_below_the_ground_is_refused_and_another_input_may_be_set(instance):
    slave = instance.slave
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    instance.set("ground.heave_rate", -20.0)
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert "below the ground, the limit is 1e-06 m" in instance.reason()
    with pytest.raises(FMICallException):
        instance.get("body.y")
    instance.set("ground.heave_rate", 0.0)
    slave.exitInitializationMode()
    assert instance.get("body.y") == Landing().get("body.y")


def test_a_first_step_with_a_start_below_the_ground_is_discarded(instance):
    instance.start()
    instance.set("ground.heave_rate", -20.0)
    assert instance.step(0.0, 1e-3) == DISCARD
    assert "below the ground" in instance.reason()
    instance.set("ground.heave_rate", 0.1)
    assert instance.step(0.0, 1e-3) == OK
    landing = Landing(inputs={"ground.heave_rate": 0.1})
    landing.advance_to(1e-3)
    assert outputs_of(instance) == [landing.get(name) for name in OUTPUTS]


def test_the_state_of_a_landing_that_needs_a_rising_ground_is_restored(make):
    """On ground at rest its flight would come from below."""
    values = {"drop.vertical_velocity": 2.0, "drop.contact_time": 0.1, "drop.pitch_rate": 0.0}
    with pytest.raises(LandingError):
        Landing(Parameters().with_values(values))
    one, other = make(), make()
    one.start(**values, **{"ground.heave_rate": 5.0})
    one.steps(0, 50)
    data = one.slave.serializeFMUstate(one.slave.getFMUState())
    other.start()
    other.slave.setFMUState(other.slave.deSerializeFMUstate(data))
    for instance in (one, other):
        instance.steps(50, 200)
    assert outputs_of(one) == outputs_of(other)
    assert one.get("leg[1].contact.force_y") > 0.0


def test_heave_alone_set_at_each_step_moves_a_parked_vehicle_without_force_peaks(instance):
    """Forces are within 1 % of mass times acceleration and gravity, and the work is the lift's.

    The heave is a sinusoid of 4 s and 100 mm. `Landing` gives the same with the same inputs.
    """
    landing = Landing()
    instance.start()
    assert instance.step(0.0, 6.0) == OK
    landing.advance_to(6.0)
    before, ratios = instance.get("energy.work_ground"), []

    def lift(t: float) -> float:
        grown = min(t / 2.0, 1.0)
        return grown**3 * (10.0 - 15.0 * grown + 6.0 * grown**2) * 0.1 * sin(0.5 * pi * t)

    for k in range(4000):
        t = k * 1e-3
        instance.set("ground.heave", lift(t))
        landing.set_inputs({"ground.heave": lift(t)})
        assert instance.step(6.0 + t, 1e-3) == OK
        landing.advance_to(6.0 + t + 1e-3)
        force = sum(instance.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4))
        acceleration = (lift(t + 1e-3) - 2.0 * lift(t) + lift(t - 1e-3)) / 1e-6
        ratios.append(force / (WEIGHT * (1.0 + acceleration / 9.81)))
    assert outputs_of(instance) == [landing.get(name) for name in OUTPUTS]
    assert np.abs(np.array(ratios) - 1.0).max() < 0.01
    speed = 0.5 * pi * 0.1
    kinetic = 0.5 * WEIGHT / 9.81 * speed**2
    assert instance.get("energy.work_ground") - before == pytest.approx(kinetic, abs=0.5)


@pytest.mark.parametrize("again", [False, True])
def test_heave_at_intervals_of_ten_steps_moves_a_parked_vehicle_without_force_peaks(make, again):
    """Whether it is set at each step or once. A copy continues from a state during the motion."""
    instance, copy = make(), make()
    for each in (instance, copy):
        each.start()
    assert instance.step(0.0, 6.0) == OK
    landing, ratios = Landing(), []
    landing.advance_to(6.0)
    before = instance.get("energy.work_ground")
    for k in range(2500):
        grown = min(k // 10 / 200, 1.0)
        lift = 0.3 * grown**3 * (10.0 - 15.0 * grown + 6.0 * grown**2)
        if again or k % 10 == 0:
            instance.set("ground.heave", lift)
            landing.set_inputs({"ground.heave": lift})
        now = 6.0 + k * 1e-3
        assert instance.step(now, 1e-3) == OK
        landing.advance_to(now + 1e-3)
        ratios.append(
            sum(instance.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4)) / WEIGHT
        )
        if k == 1004:
            data = instance.slave.serializeFMUstate(instance.slave.getFMUState())
            copy.slave.setFMUState(copy.slave.deSerializeFMUstate(data))
        elif 1004 < k < 1100:
            if again or k % 10 == 0:
                copy.set("ground.heave", lift)
            assert copy.step(now, 1e-3) == OK
            assert outputs_of(copy) == outputs_of(instance)
    assert outputs_of(instance) == [landing.get(name) for name in OUTPUTS]
    assert 0.93 < min(ratios) < max(ratios) < 1.07
    work = instance.get("energy.work_ground") - before
    assert work == pytest.approx(WEIGHT * 0.3, rel=1e-3)


def test_the_motion_of_the_ground_to_a_new_position_is_part_of_the_state(instance):
    instance.start()
    instance.steps(0, 300)
    instance.set("ground.heave", 1e-3)
    instance.steps(300, 301)
    instance.set("ground.heave", 3e-3)
    instance.get("body.y")
    data = instance.slave.serializeFMUstate(instance.slave.getFMUState())
    instance.steps(301, 400)
    expected = [
        instance.get(name) for name in OUTPUT_NAMES if not name.endswith(("phase", "active"))
    ]
    instance.slave.reset()
    instance.slave.setFMUState(instance.slave.deSerializeFMUstate(data))
    instance.steps(301, 400)
    assert [
        instance.get(name) for name in OUTPUT_NAMES if not name.endswith(("phase", "active"))
    ] == expected
