"""Height fields: planes, bumps and edges against closed forms; what is no field is refused."""

from __future__ import annotations

from math import cos, exp, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError
from rlv_landing.assembly.surroundings import height_field
from rlv_landing.core.ground.terrain import terrain_place
from rlv_landing.core.records import TerrainPlace, Vector
from rlv_landing.errors import IntegrationError
from rlv_landing.parameters import Parameters, terrain_from_table, terrain_of
from rlv_landing.presets import parse_toml, to_toml

NODES = np.linspace(-4.0, 4.0, 33)


def field(height: Any, nodes: Any = NODES) -> dict[str, Any]:
    """A field of the function `height` of x and z [m]."""
    rows = [[height(x, z) for x in nodes] for z in nodes]
    return {"ground.terrain": terrain_of(list(nodes), list(nodes), rows)}


def at(parameters: Parameters, x: float, z: float) -> TerrainPlace:
    """The field at a place on the ground's plane."""
    grid, heights = height_field(parameters)
    return terrain_place(grid, heights, int(grid.columns) + 2, Vector(x, 0.0, z))


@settings(max_examples=40, deadline=None)
@given(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_a_plane_is_met_exactly_to_the_field_s_edge(x: float, z: float, a: float, b: float) -> None:
    found = at(vehicle(SPACE | field(lambda u, v: 0.3 + a * u + b * v)), x, z)
    assert found.depth == pytest.approx(0.3 + a * x + b * z, abs=1e-12)
    assert (found.slope_1, found.slope_2) == pytest.approx((a, b), abs=1e-12)
    assert found.outside == 0.0


def test_heights_and_slopes_go_on_over_the_nodes() -> None:
    generator = np.random.default_rng(5)
    rough = generator.normal(0.0, 0.1, (33, 33))
    lookup = {(x, z): rough[j, i] for i, x in enumerate(NODES) for j, z in enumerate(NODES)}
    parameters = vehicle(SPACE | field(lambda x, z: lookup[x, z]))
    for i, j in generator.integers(2, 30, (40, 2)):
        x, z = NODES[i], NODES[j]
        assert at(parameters, x, z).depth == pytest.approx(rough[j, i], abs=1e-12)
        before, after = at(parameters, x - 1e-9, z), at(parameters, x + 1e-9, z)
        assert after[:3] == pytest.approx(before[:3], abs=1e-6)
        step = 1e-6
        numeric = at(parameters, x + 0.1 + step, z).depth - at(parameters, x + 0.1 - step, z).depth
        assert at(parameters, x + 0.1, z).slope_1 == pytest.approx(numeric / (2 * step), abs=1e-7)


def test_a_sloping_field_is_a_slope() -> None:
    """The depth is measured along other normals, so the ground's stiffness differs by 0.4 %."""
    slope = 0.05
    tilted = vehicle(SPACE | field(lambda x, _: -np.tan(slope) * x) | TURNING)
    plane = tilted.with_values({"ground.terrain": "", "ground.slope": slope})
    landings = Landing(tilted, rtol=1e-8), Landing(plane, rtol=1e-8)
    for landing in landings:
        landing.advance_to(0.4)
    one, two = (landing.outputs() for landing in landings)
    for name in ("body.x", "body.y", "body.z", "body.pitch", "body.roll", "body.heading"):
        assert one[name] == pytest.approx(two[name], abs=2e-5)


def test_the_field_turns_with_the_slope_s_direction() -> None:
    values = {"ground.slope": 0.1, "ground.slope_direction": 0.9}
    parameters = vehicle(SPACE | values | field(lambda x, z: 0.02 * x - 0.01 * z))
    # along the ground's axis 1, which points to the slope's direction
    found = at(parameters, 1.5, 0.0)
    assert found.depth == pytest.approx(1.5 * (0.02 * cos(0.9) - 0.01 * sin(0.9)), abs=1e-12)


ROUGH = field(
    lambda x, z: 0.05 * sin(2.1 * x + 0.4) * cos(1.7 * z) + 0.15 * exp(-4.0 * (x - 1.0) ** 2)
)


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
@pytest.mark.parametrize("law", ["passive", "paper"])
def test_the_energy_balance_holds_over_bumps_and_edges(method: str, law: str) -> None:
    rolling = TURNING | ROUGH | {"drop.horizontal_velocity": 1.2, "ground.friction_law": law}
    moving = {"ground.heave_rate": 0.05, "ground.roll_rate": 0.02, "ground.yaw_rate": 0.05}
    if law == "paper":
        # which may supply energy, and does not miss it on a plane
        rolling |= {"ground.friction": 0.0}
    landing = Landing(vehicle(rolling), method=method, rtol=1e-6, inputs=moving)
    landing.advance_to(0.8)
    assert landing.get("energy.dissipated") > 100.0
    assert abs(landing.get("energy.balance")) < 2e-5 * landing.get("energy.dissipated")


def test_the_vehicle_comes_to_rest_on_rough_ground() -> None:
    landing = Landing(vehicle(TURNING | ROUGH))
    landing.advance_to(8.0)
    before = landing.outputs()
    assert before["status.phase"] == 2.0
    landing.advance_to(108.0)
    way = max(abs(landing.get(f"body.{axis}") - before[f"body.{axis}"]) for axis in "xyz")
    assert way / 100.0 < 1e-9


def test_the_first_contact_is_with_the_field_that_lies_below() -> None:
    fast = {"drop.contact_time": 0.1, "drop.vertical_velocity": -4.0}
    landing = Landing(vehicle(TURNING | ROUGH | fast | {"ground.slope": 0.08}))
    landing.advance_to(0.1)
    depths = [landing.get(f"leg[{leg}].contact.penetration") for leg in (1, 2, 3, 4)]
    assert max(depths) == pytest.approx(0.0, abs=2e-5)
    assert sum(depth > -1e-3 for depth in depths) == 1


def test_a_flight_through_a_hill_is_refused() -> None:
    hill = field(lambda x, _: 3.0 * exp(-8.0 * (x + 2.0) ** 2), np.linspace(-8.0, 8.0, 65))
    flat = {"drop.horizontal_velocity": 8.0, "drop.contact_time": 0.3, "drop.tilt": 0.0}
    with pytest.raises(LandingError, match=r"would pass .* m below the ground"):
        Landing(vehicle(TURNING | hill | flat))


def test_a_start_beyond_the_field_is_refused() -> None:
    small = field(lambda *_: 0.0, np.linspace(-1.0, 1.0, 5))
    with pytest.raises(LandingError, match=r"beyond ground.terrain, x from -1 to 1 m"):
        Landing(vehicle(TURNING | small))


def test_a_landing_that_leaves_the_field_ends_there() -> None:
    narrow = field(lambda *_: 0.0, np.linspace(-1.7, 1.7, 5))
    fast = {"drop.horizontal_velocity": 3.0, "drop.contact_time": 0.0, "ground.friction": 0.0}
    landing = Landing(vehicle(TURNING | narrow | fast))
    with pytest.raises(IntegrationError, match=r"beyond the height field ground.terrain at t ="):
        landing.advance_to(1.0)
    assert 0.01 < landing.time < 0.3
    landing.reset()
    landing.advance_to(0.01)


def test_friction_on_a_field_is_that_of_the_force_along_its_normal() -> None:
    """Sliding down a field of 20 deg: g (sin - mu cos), as on a plane."""
    slope, mu = 0.349, 0.15
    wide = np.linspace(-12.0, 12.0, 49)
    values = {
        "ground.friction": mu,
        "ground.stribeck_gain": 0.0,
        "drop.contact_time": 0.0,
        "drop.tilt": slope,
        "drop.pitch_rate": 0.0,
        "drop.horizontal_velocity": 0.0,
        "drop.vertical_velocity": -0.01,
    }
    values |= field(lambda x, _: -np.tan(slope) * x, wide)
    landing = Landing(vehicle(SPACE | values), rtol=1e-7)
    landing.advance_to(0.8)
    start = landing.get("body.vx"), landing.get("body.vy")
    landing.advance_to(1.4)
    gained = [landing.get(f"body.v{axis}") - v for axis, v in zip("xy", start)]
    along = (gained[0] ** 2 + gained[1] ** 2) ** 0.5 / 0.6
    assert along == pytest.approx(9.81 * (sin(slope) - mu * cos(slope)), rel=1e-2)


def test_a_file_names_a_table_beside_it(tmp_path: Path) -> None:
    (tmp_path / "rocks.csv").write_text("z\\x, -3, 0, 3\n-3, 0, 0.1, 0\n3, 0, 0, 0.2\n")
    text = '[drop]\nmode = "space"\n[ground]\nterrain = "rocks.csv"\n'
    found = parse_toml(text, "mine.toml", tmp_path)
    assert found.ground.terrain == "x -3.0 3.0 3 z -3.0 6.0 2 h 0.0 0.1 0.0 0.0 0.0 0.2"
    assert parse_toml(to_toml(found), "again").ground == found.ground
    with pytest.raises(LandingError, match=r"there is no height field .*none.csv"):
        parse_toml(text.replace("rocks", "none"), "mine.toml", tmp_path)


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ("z\\x,0,1\n0,0,\n1,0,0\n", "line 2, has a hole"),
        ("z\\x,0,1\n0,0,nan\n1,0,0\n", "the height at x = 1 m, z = 0 m is nan m"),
        ("z\\x,0,1\n0,0,rock\n1,0,0\n", "'rock', which is no number"),
        ("z\\x,0,1\n0,0\n1,0,0\n", "a row has 1 heights for 2 coordinates"),
        ("z\\x,0,1,3\n0,0,0,0\n1,0,0,0\n", "off the even spacing of 1.5 m"),
        ("z\\x,1,0\n0,0,0\n1,0,0\n", "are no field; give at least 2, growing"),
        ("z\\x,0,1\n0,0,0\n", "is no height field: write z"),
        ("z\\x,0,1\n0,0,0\n1,0,1e5\n", "outside [-1000, 1000] m; a field has no holes"),
    ],
)
def test_a_table_that_is_no_field_is_refused(table: str, told: str) -> None:
    with pytest.raises(LandingError) as e:
        terrain_from_table(table, "rocks.csv")
    assert told in str(e.value)
    assert str(e.value).startswith("rocks.csv")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("rocks.csv", "is no height field; name its file in a parameter file"),
        ("x 0 1 2 z 0 1 2 h 0 0 0", "has 3 heights for 2 x 2 nodes"),
        ("x 0 1 2 z 0 1 2 h 0 0 0 rock", "has what is no number"),
        ("x 0 1 300 z 0 1 300 h 0", "has 90000 heights, the limit is 40000"),
    ],
)
def test_a_text_that_is_no_field_is_refused(text: str, told: str) -> None:
    with pytest.raises(LandingError) as e:
        vehicle(SPACE | {"ground.terrain": text})
    assert told in str(e.value)


def test_the_scene_turned_with_its_field_gives_the_turned_landing() -> None:
    """A quarter turn about the vertical, which maps the grid to itself."""
    one = vehicle(TURNING | ROUGH)

    def turned(x: float, z: float) -> float:
        # the place that the turn brings here: x = z', z = -x'
        return 0.05 * sin(-2.1 * z + 0.4) * cos(1.7 * x) + 0.15 * exp(-4.0 * (z + 1.0) ** 2)

    d = one.drop
    v = {
        "drop.horizontal_velocity": d.lateral_velocity,
        "drop.lateral_velocity": -d.horizontal_velocity,
    }
    level = {"drop.tilt": 0.0, "drop.roll": 0.0, "drop.pitch_rate": 0.0, "drop.roll_rate": 0.0}
    first = one.with_values(level)
    second = first.with_values(v | field(turned) | {"drop.heading": d.heading + 0.5 * pi})
    landings = Landing(first, rtol=1e-8), Landing(second, rtol=1e-8)
    for landing in landings:
        landing.advance_to(0.35)
    a, b = (landing.outputs() for landing in landings)
    assert (b["body.x"], b["body.z"]) == pytest.approx((a["body.z"], -a["body.x"]), abs=1e-6)
    assert b["leg[1].main_strut.stroke"] == pytest.approx(a["leg[1].main_strut.stroke"], abs=1e-6)
