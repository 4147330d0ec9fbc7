"""Rough ground from a seed: its statistics, its repetition, and what is refused."""

from __future__ import annotations

from math import exp, pi

import numpy as np
import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError
from rlv_landing.assembly.rough_ground import WAVES, waves
from rlv_landing.assembly.surroundings import height_field
from rlv_landing.core.ground.terrain import terrain_place
from rlv_landing.core.records import Vector
from rlv_landing.presets import parse_toml, to_toml

ROUGH = {"ground.roughness": 0.02, "ground.roughness_length": 0.8, "ground.terrain_seed": 7.0}


def surface(length: float, seed: int, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Heights of a roughness of 1 m, summed up wave by wave."""
    parts = [np.cos(w.x * x + w.z * z + w.phase) for w in waves(seed, length)]
    return np.sqrt(2.0 / WAVES) * np.sum(parts, axis=0)


def test_heights_are_those_of_the_waves_of_the_seed() -> None:
    parameters = vehicle(SPACE | ROUGH)
    grid, heights = height_field(parameters)
    width = int(grid.columns) + 2
    places = np.random.default_rng(1).uniform(-2.0, 2.0, (60, 2))
    found = [terrain_place(grid, heights, width, Vector(x, 0.0, z)).depth for x, z in places]
    exact = 0.02 * surface(0.8, 7, *places.T)
    # at a node exactly; the cubics between miss waves of three nodes by some per cent
    at_node = terrain_place(grid, heights, width, Vector(grid.u0 + 5 * grid.du, 0.0, grid.v0))
    node = np.array([grid.u0 + 5 * grid.du, grid.v0])
    assert at_node.depth == pytest.approx(0.02 * float(surface(0.8, 7, *node)), abs=1e-12)
    assert np.sqrt(np.mean((found - exact) ** 2)) < 0.05 * 0.02


def test_no_wave_is_shorter_than_the_length_and_heights_are_correlated_over_it() -> None:
    length = 0.5
    all_waves = [w for seed in range(200) for w in waves(seed, length)]
    numbers = np.array([np.hypot(w.x, w.z) for w in all_waves])
    assert numbers.max() <= 2.0 * pi / length * (1.0 + 1e-12)
    # the phases' mean of h(0) h(r): a cosine for each wave
    for direction in (0.0, 1.0, 2.0):
        along = np.array([w.x * np.cos(direction) + w.z * np.sin(direction) for w in all_waves])
        for distance in (0.25, 0.5, 1.0):
            expected = exp(-((distance / length) ** 2))
            assert np.cos(along * distance).mean() == pytest.approx(expected, abs=0.01)


def test_a_landing_repeats_from_its_parameters_file() -> None:
    parameters = vehicle(SPACE | TURNING | ROUGH)
    again = parse_toml(to_toml(parameters), "again.toml")
    landings = [Landing(p) for p in (parameters, again)]
    for landing in landings:
        landing.advance_to(0.3)
    assert landings[0].state() == landings[1].state()
    other = Landing(parameters.with_values({"ground.terrain_seed": 8.0}))
    other.advance_to(0.3)
    assert other.state() != landings[0].state()
    assert landings[0].extremes()["energy.balance"].maximum < 0.01


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"ground.roughness": 0.2}, "too steep to land on"),
        ({"ground.terrain_seed": 1.5}, "is not a whole number"),
        ({"ground.terrain": "x 0 1 2 z 0 1 2 h 0 0 0 0"}, "both say how high"),
        ({"ground.roughness": 1e-4, "ground.roughness_length": 0.01}, "too short for a field"),
        ({"leg[2].ground.roughness": 0.1}, r"unknown parameter 'leg\[2\].ground.roughness'"),
        ({"drop.mode": "2-2"}, "needs drop.mode = space"),
    ],
)
def test_what_makes_no_ground_is_refused(values: dict[str, float | str], message: str) -> None:
    with pytest.raises(LandingError, match=message):
        Landing(vehicle(SPACE | ROUGH).with_values(values))
