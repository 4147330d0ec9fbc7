"""Dampers at random within their bounds: pressures stay above 0, liquid and energy are kept."""

from __future__ import annotations

import os
import random

import pytest
from random_vehicles import any_damper, some_vehicle, watch

from rlv_landing import Landing, LandingError, Parameters
from rlv_landing.assembly import touchdown_energy
from rlv_landing.landing import METHODS

# seeds in the suite; in `make torture` so many times as many as RLV_TORTURE says, at most 2,000
IN_SUITE, AT_MOST = 60, 2000
SEEDS = range(min(IN_SUITE * int(os.environ.get("RLV_TORTURE", "1")), AT_MOST))
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6)
# seeds of landings in which it fell, and for how many steps or looks they are looked at closely
FELL, AS_LONG = (12, 36, 49, 694), 700
# what a landing may lose, in parts of a damper's liquid and of the energy that was turned over
MOST_MASS, MOST_ENERGY = 1e-6, 1e-4


def assert_kept(landing: Landing, **how: float) -> None:
    """Land, and find what is conserved."""
    kept = watch(landing, **how)
    assert kept.pressure > 0.0
    assert kept.mass <= MOST_MASS
    assert kept.energy <= MOST_ENERGY


@pytest.mark.torture
def test_any_damper_keeps_its_liquid_and_the_energy():
    """One landing in a hundred at most may end as an error of the integrator instead."""
    ended = 0
    for seed in SEEDS:
        rng = random.Random(seed)
        parameters = some_vehicle(rng)
        rtol = rng.choice(TOLERANCES)
        for method in METHODS:
            try:
                assert_kept(Landing(parameters, rtol=rtol, method=method), most_steps=2000)
            except LandingError:
                ended += 1
            except AssertionError as error:
                raise AssertionError(f"seed {seed}, {method}, rtol {rtol:g}: {error}") from None
    assert ended <= 0.01 * len(SEEDS) * len(METHODS)


def largest_fall(landing: Landing, rng: random.Random) -> float:
    """The largest fall of what is dissipated, in any way or in all, between two looks [J].

    They come at random, many of them inside one step.
    """
    names = [name for name in landing.outputs() if name.startswith("energy.dissipated")]
    before, fall = [landing.get(name) for name in names], 0.0
    for _ in range(AS_LONG):
        if landing.statistics["steps"] > AS_LONG:
            break
        landing.advance_to(landing.time + 10.0 ** rng.uniform(-6.0, -3.0))
        now = [landing.get(name) for name in names]
        fall = max(fall, *(a - b for a, b in zip(before, now)))
        before = now
    return fall


def assert_dissipated_never_falls(seed: int, method: str, rtol: float) -> None:
    landing = Landing(some_vehicle(random.Random(seed)), rtol=rtol, method=method)
    fall = largest_fall(landing, random.Random(seed))
    most = 1e-14 * landing.get("energy.dissipated")
    assert fall <= most, f"seed {seed}, {method}, rtol {rtol:g}: {fall:.1e} J"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", TOLERANCES)
def test_what_is_dissipated_never_falls_between_any_two_times(rtol, method):
    for seed in FELL:
        assert_dissipated_never_falls(seed, method, rtol)


@pytest.mark.torture
def test_what_is_dissipated_never_falls_whatever_the_vehicle():
    for seed in SEEDS:
        try:
            for method in METHODS:
                rtol = random.Random(seed).choice(TOLERANCES)
                assert_dissipated_never_falls(seed, method, rtol)
        except LandingError:
            continue


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-8])
@pytest.mark.parametrize(
    "values",
    [
        {"main_strut.volume_upper": 1e-7},
        {"main_strut.bulk_modulus": 1e7},
        {"main_strut.bulk_modulus": 1e7, "main_strut.volume_upper": 1e-7},
        {"main_strut.stop_stiffness": 1e3},
        {"main_strut.stop_stiffness": 1e3, "main_strut.volume_lower": 8e-5},
        {"main_strut.air_fraction": 1e-7, "main_strut.orifice_area_rebound": 1e-9},
    ],
    ids=lambda values: " ".join(f"{n.split('.')[1]}={v:g}" for n, v in values.items()),
)
def test_a_cavity_and_a_chamber_that_is_emptied_keep_them(values, rtol, method):
    parameters = Parameters().with_values(values)
    assert_kept(Landing(parameters, rtol=rtol, method=method), until=0.4)


def test_a_landing_with_a_cavity_has_one():
    """So that what the others claim of cavities is claimed of some."""
    kept = watch(Landing(Parameters().with_values({"main_strut.volume_upper": 1e-7})), until=0.4)
    assert 0.0 < kept.pressure < 100.0


def test_no_pressure_rises_unseen_inside_a_step():
    """A stiff pair of pressures becomes equal there, and the interpolant may overshoot."""
    landing, most = Landing(some_vehicle(random.Random(1012)), rtol=1e-4), 0.0
    for k in range(200):
        landing.advance_to(0.279 + 1e-5 * k)
        most = max(most, abs(landing.get("energy.balance")))
    assert most <= MOST_ENERGY * landing.get("energy.dissipated")


@pytest.mark.parametrize("seed", [84, 420, 694, 1234])
def test_what_a_loose_tolerance_hides_is_judged(seed):
    """Growth of the balance that rounding hides in a step, and liquid that is taken off."""
    parameters = some_vehicle(random.Random(seed))
    method = "dormand-prince" if seed == 694 else "exponential"
    assert_kept(Landing(parameters, rtol=1e-3, method=method), until=0.3, most_steps=2500)


@pytest.mark.parametrize(("seed", "until"), [(334, 0.23), (1065, 0.2)])
def test_what_dissipation_that_is_kept_from_falling_costs_is_judged(seed, until):
    """Its interpolant without the fourth-order part is off inside the step, not at its ends."""
    landing = Landing(some_vehicle(random.Random(seed)), rtol=1e-4, method="dormand-prince")
    assert_kept(landing, until=until, most_steps=2500)


@pytest.mark.parametrize("seed", [10, 144])
def test_a_landing_of_many_seconds_keeps_the_energy_asleep_and_awake(seed):
    # the first falls asleep far from its rest, the second loses a little in each second
    landing = Landing(any_damper(random.Random(seed)), rtol=1e-4)
    landing.advance_to(20.0)
    kept = landing.extremes()["energy.balance"]
    turned = max(landing.get("energy.dissipated"), 0.1 * touchdown_energy(landing.parameters))
    assert max(-kept.minimum, kept.maximum) <= MOST_ENERGY * turned
