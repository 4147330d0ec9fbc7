"""A ground whose position changes every few steps: it moves there over the time between changes.

The landing makes steps of 1 ms. The inputs are set again at each of them, as an FMI master does.
"""

from collections.abc import Callable
from math import pi, sin
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.inputs.ground_way import LONGEST_INTERVAL

LEGS = (1, 2, 3, 4)
MASS, GRAVITY = 178.0 + 4 * 4.2, 9.81
WEIGHT = MASS * GRAVITY
PARKED = 8.0
Motion = Callable[[float], float]
# the number of the step before which the deck was read last, of the number of a step
Reading = Callable[[int], int]


@pytest.fixture(scope="module")
def parked():
    """Makes a landing at rest on its ground at PARKED, from a state kept by mode."""
    kept = {}

    def make(mode: str) -> Landing:
        values = {"vehicle.transverse_load_at": "footpad"}
        landing = Landing(load_preset("yue2022-figures", mode).with_values(values), rtol=1e-7)
        if mode not in kept:
            landing.advance_to(PARKED)
            kept[mode] = landing.state()
        landing.restore(kept[mode])
        return landing

    return make


def grown(t: float) -> float:
    """From 0 to 1 within 2 s, without a jump of the acceleration."""
    s = min(max(t / 2.0, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def heave(t: float) -> float:
    """A sinusoid [m] of 100 mm and 4 s that grows within 2 s."""
    return grown(t) * 0.1 * sin(0.5 * pi * t)


def tilt(t: float) -> float:
    """A sinusoid [rad] of 0.01 rad and 4 s that grows within 2 s."""
    return 0.1 * heave(t)


def rate(x: Motion, t: float) -> float:
    return (x(t + 1e-6) - x(t - 1e-6)) / 2e-6


def acceleration(x: Motion, t: float) -> float:
    return (x(t + 1e-4) - 2.0 * x(t) + x(t - 1e-4)) / 1e-8


def every(steps: int) -> Reading:
    return lambda k: k // steps * steps


def uneven(least: int, most: int) -> Reading:
    """Readings `least` to `most` steps apart, at random."""
    random, at = Random(1), [0]
    while at[-1] < 10_000:
        at.append(at[-1] + random.randint(least, most))
    last = np.searchsorted(at, range(10_000), side="right") - 1
    return lambda k: at[last[k]]


def driven(landing: Landing, motions: dict[str, tuple[Motion, Reading]], steps: int = 5000):
    """Sets the inputs `motions` before each of the `steps`; gives the outputs after each."""
    rows = []
    for k in range(steps):
        landing.set_inputs({name: x(1e-3 * read(k)) for name, (x, read) in motions.items()})
        landing.advance_to(PARKED + (k + 1) * 1e-3)
        rows.append(landing.outputs())
    return rows


def total(rows, axis: str) -> np.ndarray:
    return np.array([sum(row[f"leg[{leg}].contact.force_{axis}"] for leg in LEGS) for row in rows])


def expected_weight(x: Motion, late: float, steps: int = 5000) -> np.ndarray:
    """Mass times gravity and acceleration after each step [N], `late` [s] behind `x`."""
    return np.array(
        [MASS * (GRAVITY + acceleration(x, (k + 1) * 1e-3 - late)) for k in range(steps)]
    )


@pytest.mark.parametrize(
    ("interval", "with_rate", "tolerance"),
    [
        (1, False, 0.003),
        (2, False, 0.01),
        (5, False, 0.01),
        (10, False, 0.02),
        (20, False, 0.03),
        (50, False, 0.12),
        (10, True, 0.02),
        (20, True, 0.03),
    ],
)
def test_forces_on_heaving_ground_do_not_depend_on_the_interval_of_its_positions(
    parked, mode, interval, with_rate, tolerance
):
    """The ground is one interval late; with rates the rates are held, half an interval late.

    A kink of the motion is a jump of its rate by the acceleration times the interval.
    """
    landing, late = parked(mode), interval * 1e-3 * (0.5 if with_rate else 1.0)
    before = landing.outputs()
    motions = {"ground.heave": (heave, every(interval))}
    if with_rate:
        motions["ground.heave_rate"] = (lambda t: rate(heave, t), every(interval))
    rows = driven(landing, motions)
    ratios = total(rows, "y") / expected_weight(heave, late)
    assert np.abs(ratios - 1.0).max() < tolerance
    now = landing.outputs()
    changes = {name: now[name] - before[name] for name in now}
    rise, speed = heave(5.0 - late), rate(heave, 5.0 - late)
    assert changes["energy.work_ground"] - changes["energy.dissipated"] == approx(
        MASS * (GRAVITY * rise + 0.5 * speed**2), abs=1.0
    )
    assert changes["energy.dissipated"] < 0.65
    assert abs(changes["energy.balance"]) < 1e-3


@pytest.mark.parametrize("interval", [1, 4, 10, 20])
def test_a_parked_vehicle_turns_with_ground_whose_tilt_comes_at_intervals(parked, mode, interval):
    landing = parked(mode)
    first = landing.outputs()
    rows = driven(landing, {"ground.tilt": (tilt, every(interval))})
    late = interval * 1e-3
    pitch = np.array([row["body.pitch"] - first["body.pitch"] for row in rows])
    assert np.abs(pitch - [tilt((k + 1) * 1e-3 - late) for k in range(5000)]).max() < 6e-4
    assert np.abs(total(rows, "y") / WEIGHT - 1.0).max() < 0.03
    assert rows[-1]["energy.dissipated"] - first["energy.dissipated"] < 0.2


@pytest.mark.parametrize("with_force", [False, True])
def test_heave_and_tilt_may_have_different_intervals(parked, mode, with_force):
    """Each ends its way in its own time; other inputs in between do not change the ways."""
    landing = parked(mode)
    motions = {"ground.heave": (heave, every(10)), "ground.tilt": (tilt, every(4))}
    if with_force:
        motions["external.moment"] = (lambda t: 5.0 * sin(7.0 * t), every(3))
    rows = driven(landing, motions)
    assert np.abs(total(rows, "y") / expected_weight(heave, 10e-3) - 1.0).max() < 0.03


@pytest.mark.parametrize(
    ("reading", "tolerance"), [(uneven(8, 12), 0.03), (uneven(9, 10), 0.03), (uneven(6, 12), 0.03)]
)
def test_positions_at_uneven_times_do_not_stop_the_ground(parked, mode, reading, tolerance):
    """The longest interval counts, so the ground is at most as late as that and the present one."""
    rows = driven(parked(mode), {"ground.heave": (heave, reading)})
    ratios = total(rows, "y") / expected_weight(heave, 11e-3)
    assert np.abs(ratios - 1.0).max() < tolerance


def place(landing: Landing) -> tuple[float, float]:
    """Heave [m] and tilt [rad] of the ground at the landing's time."""
    acting = landing.inputs()
    return acting["ground.heave"], acting["ground.tilt"]


def flying(time: float = 0.5, velocity: float = -6.0) -> Landing:
    """A landing in free flight until the `time` [s], with the `velocity` [m/s] at its end."""
    values = {"drop.contact_time": time, "drop.vertical_velocity": velocity, "drop.pitch_rate": 0.0}
    return Landing(load_preset("yue2022-figures").with_values(values))


def high() -> Landing:
    """A landing in free flight for three seconds."""
    return flying(3.0, -31.0)


@settings(max_examples=20, deadline=None)
@given(
    interval=st.integers(1, 40),
    steps=st.lists(st.floats(1e-3, 1e-2), min_size=3, max_size=8),
    again=st.booleans(),
)
def test_the_ground_is_linear_between_positions_one_interval_late(interval, steps, again):
    """Whether they are set once or at each step; after the last one it stands."""
    landing, places = flying(), [0.0, *np.cumsum(steps)]
    for k in range(interval * (len(places) + 1)):
        if again or k % interval == 0:
            landing.set_inputs({"ground.heave": places[min(k // interval, len(steps))]})
        landing.advance_to((k + 1) * 1e-3)
        due = np.interp(k + 1 - interval, np.arange(len(places)) * interval, places)
        assert place(landing)[0] == approx(due, abs=1e-14)


def test_a_step_longer_than_the_interval_ends_at_the_position():
    landing = flying()
    for k, dt in enumerate((2e-3, 2e-3, 2e-3, 5e-3, 5e-3)):
        landing.set_inputs({"ground.heave": 1e-3 * k})
        landing.step(dt)
        assert place(landing)[0] == approx(1e-3 * k, abs=1e-15)


@pytest.mark.parametrize("known", [False, True])
@pytest.mark.parametrize("stand", [0.3, 2.0 * LONGEST_INTERVAL])
def test_the_first_position_after_a_standstill_is_reached_over_the_time_of_that(known, stand):
    """At most over LONGEST_INTERVAL. The next one comes soon, and is reached as soon."""
    landing, here = high(), 0.0
    if known:
        for k in range(1, 4):
            landing.step(10e-3)
            landing.set_inputs({"ground.heave": 1e-3 * k})
        here = 3e-3
        landing.step(10e-3)
    landing.step(stand - 10e-3 if known else stand)
    assert place(landing)[0] == here
    interval = min(stand, LONGEST_INTERVAL)
    landing.set_inputs({"ground.heave": 0.02})
    landing.step(10e-3)
    there = here + 10e-3 / interval * (0.02 - here)
    assert place(landing)[0] == approx(there, abs=1e-14)
    landing.set_inputs({"ground.heave": 0.021})
    landing.step(5e-3)
    assert place(landing)[0] == approx(0.5 * (there + 0.021), abs=1e-14)
    landing.step(5e-3)
    assert place(landing)[0] == approx(0.021, abs=1e-14)


@pytest.mark.parametrize(("interval", "most"), [(200, 2.4), (50, 1.45)])
@pytest.mark.parametrize("first", [0.0, 1e-9])
def test_a_deck_whose_positions_come_seldom_makes_no_force_peaks(parked, interval, most, first):
    """A host of 200 Hz gives positions at 1 Hz or 4 Hz, after `first` at two steps in a row."""
    landing, forces = parked("2-2"), []
    for k in range(2):
        landing.set_inputs({"ground.heave": first * (k + 1)})
        landing.advance_to(PARKED + (k + 1) * 5e-3)
    for k in range(2, 1000):
        landing.set_inputs({"ground.heave": heave(5e-3 * (k // interval) * interval)})
        landing.advance_to(PARKED + (k + 1) * 5e-3)
        forces.append(total([landing.outputs()], "y")[0])
    assert max(forces) < most * WEIGHT


def test_a_shorter_interval_of_another_source_counts_at_once():
    landing = flying()
    for k in range(1, 4):
        landing.step(20e-3)
        landing.set_inputs({"ground.heave": 1e-3 * k})
    for k in range(4, 8):
        landing.step(1e-3)
        landing.set_inputs({"ground.heave": 1e-3 * k})
    landing.step(1e-3)
    assert place(landing)[0] == approx(7e-3, abs=1e-15)


def test_a_position_set_again_with_its_rate_is_no_new_position():
    """Without a rate, or with a rate of 0, it is the place of the ground."""
    landing = flying()
    for k in range(40):
        landing.set_inputs({"ground.heave": 0.01, "ground.heave_rate": 0.3})
        landing.advance_to((k + 1) * 1e-3)
    assert place(landing)[0] == approx(0.01 + 0.3 * 0.04, abs=1e-15)
    landing.set_inputs({"ground.heave": 0.01}, {"ground.heave": 0.3})
    landing.advance_to(0.05)
    assert place(landing)[0] == approx(0.01 + 0.3 * 0.05, abs=1e-15)
    landing.set_inputs({"ground.heave": 0.01, "ground.heave_rate": 0.0})
    landing.advance_to(0.2)
    assert place(landing)[0] == 0.01


def on_the_way(landing: Landing, start: float) -> None:
    """Sets heave every 10 ms and tilt every 4 ms, and stops at 13 ms.

    The ways end at 20 ms and 16 ms.
    """
    for k in range(13):
        if k % 10 == 0:
            landing.set_inputs({"ground.heave": 1e-4 * (k + 1), "ground.heave_rate": 0.01})
        if k % 4 == 0:
            landing.set_inputs({"ground.tilt": 1e-5 * (k + 1)})
        landing.advance_to(start + (k + 1) * 1e-3)


@settings(max_examples=12, deadline=None)
@given(cuts=st.lists(st.floats(1e-5, 6e-3), min_size=1, max_size=40), landed=st.booleans())
def test_a_motion_over_an_interval_does_not_depend_on_the_steps(cuts, landed):
    start = 0.16 if landed else 0.05
    straight, cut = Landing(), Landing()
    for landing in (straight, cut):
        landing.advance_to(start)
        on_the_way(landing, start)
        landing.set_inputs({"external.force_x": 20.0})
    for dt in cuts:
        cut.step(dt)
    end = max(cut.time, start + 0.1)
    for landing in (straight, cut):
        landing.advance_to(end)
    assert cut.values() == approx(straight.values(), rel=1e-9, abs=1e-9)
    assert place(cut) == approx(place(straight), abs=1e-15)


@pytest.mark.parametrize("steps", [0, 2, 3, 4, 6, 7, 8])
def test_a_state_during_a_motion_of_the_ground_continues_with_the_same_digits(parked, mode, steps):
    """Before and after each way's end, at it, and with the next positions."""
    landing, other = parked(mode), Landing(parked(mode).parameters, rtol=1e-7)
    on_the_way(landing, PARKED)
    for _ in range(steps):
        landing.step(1e-3)
    other.restore(landing.state())
    assert other.state() == landing.state()
    for k in range(25):
        for copy in (landing, other):
            copy.set_inputs({"ground.heave": 1e-3 + 1e-4 * (k // 5), "ground.tilt": 2e-4})
            copy.step(1e-3)
        assert other.values() == landing.values()
    assert other.state() == landing.state()


def test_run_ends_motions_of_the_ground_where_steps_do(parked, mode):
    by_run, by_steps = parked(mode), parked(mode)
    for landing in (by_run, by_steps):
        on_the_way(landing, PARKED)
    start = by_run.time
    history = by_run.run(start + 0.3, 1.5e-3)
    rows = [by_steps.values()]
    for k in range(1, len(history)):
        by_steps.advance_to(start + k * 1.5e-3)
        rows.append(by_steps.values())
    assert np.array_equal(history.data, np.array(rows))
    assert by_run.state() == by_steps.state()


def test_a_refused_input_changes_no_motion_of_the_ground():
    landing = flying()
    landing.step(10e-3)
    landing.set_inputs({"ground.heave": 0.01})
    landing.step(3e-3)
    before = landing.state()
    with pytest.raises(LandingError, match=r"ground\.tilt = 7 rad is outside"):
        landing.set_inputs({"ground.heave": 0.05, "ground.tilt": 7.0})
    assert landing.state() == before
