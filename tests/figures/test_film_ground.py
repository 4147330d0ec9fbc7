"""The ground of films: slope, height field and moved deck lie where the model has them."""

from __future__ import annotations

import numpy as np
import pytest
from five_legs import DECK, five_legs
from scipy.spatial.transform import Rotation

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.figures.ground.shape import STILL, GroundShape, deck_of, decks_of
from rlv_landing.figures.moving_figure import MovingFigure
from rlv_landing.figures.wireframe import contact_forces, wireframe
from rlv_landing.parameters import terrain_of

PART = ((-2.0, 2.5), (-1.5, 1.0))
X, Z = np.linspace(-4.0, 4.0, 9), np.linspace(-3.0, 3.0, 7)
HEIGHTS = 0.05 * np.sin(1.3 * X) * np.cos(0.9 * Z[:, None])


def test_a_moved_plane_is_turned_and_shifted_as_the_inputs_say() -> None:
    parameters = five_legs().with_values({"ground.terrain": ""})
    deck = STILL._replace(surge=0.3, heave=-0.2, sway=0.1, yaw=0.4, roll=0.2, tilt=-0.3)
    shape = GroundShape(parameters, *PART)
    # the matrices of the turns one after the other, and the slope's line of steepest descent
    turn = Rotation.from_euler("yxz", [deck.yaw, deck.roll, -deck.tilt])
    g = parameters.ground
    down = np.array([np.cos(g.slope_direction), -np.tan(g.slope), np.sin(g.slope_direction)])
    normal = turn.apply(np.cross(np.array([-down[2], 0.0, down[0]]), down))
    for points in (shape.grid(deck), shape.area(deck), shape.cut(deck)):
        away = (points - (deck.surge, deck.heave, deck.sway)) @ normal
        assert np.nanmax(np.abs(away)) < 1e-12
    area = shape.area()
    assert np.allclose(
        [area.min(axis=0)[[0, 2]], area.max(axis=0)[[0, 2]]], np.transpose(PART), atol=0.01
    )


def test_a_height_field_has_the_heights_of_its_nodes() -> None:
    terrain = terrain_of(X, Z, HEIGHTS)
    parameters = five_legs().with_values({"ground.terrain": terrain, "ground.slope": 0.0})
    grid = GroundShape(parameters, (-9.0, 9.0), (-9.0, 9.0)).grid()
    assert np.allclose(np.nanmin(grid, axis=0)[[0, 2]], (-4.0, -3.0))
    assert np.allclose(np.nanmax(grid, axis=0)[[0, 2]], (4.0, 3.0))
    met = 0
    for j, z in enumerate(Z):
        for i, x in enumerate(X):
            here = np.hypot(grid[:, 0] - x, grid[:, 2] - z) < 1e-9
            assert np.allclose(grid[here, 1], HEIGHTS[j, i])
            met += here.any()
    assert met == X.size * Z.size


@pytest.mark.parametrize("moved", [{}, DECK], ids=["still", "deck"])
def test_feet_that_are_drawn_stand_on_the_ground_that_is_drawn(moved: dict[str, float]) -> None:
    plane = {"vehicle.body_points": "", "leg[2].ground.step": 0.0, "ground.terrain": ""}
    parameters = five_legs().with_values(plane)
    history = Landing(parameters, inputs=moved).run(0.5, 5e-2)
    rows = np.arange(len(history))
    lines, forces = wireframe(history, parameters, rows), contact_forces(history, parameters, rows)
    shape, loaded = GroundShape(parameters, *PART), 0
    for i, deck in enumerate(decks_of(history, rows)):
        corners = shape.area(deck)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        away = (lines["feet"][i, :, 0] - corners[0]) @ normal / np.linalg.norm(normal)
        pressed = np.linalg.norm(forces[i], axis=-1) > 0.0
        loaded += pressed.sum()
        # as deep as a contact's stiffness makes it
        assert np.all(np.abs(away[pressed]) < 5e-3)
    assert loaded > 10


def test_a_deck_on_its_way_is_where_the_landing_says() -> None:
    landing = Landing(five_legs())
    landing.advance_to(0.1)
    landing.set_inputs({"ground.heave": 0.1, "ground.surge_rate": 0.5})
    landing.advance_to(0.15)
    deck = deck_of(landing.ground_places())
    # the way to a new position takes as long as the time before it
    assert deck.heave == pytest.approx(0.05)
    assert deck.surge == pytest.approx(0.025)


def test_legs_with_struts_of_their_own_are_drawn_with_them() -> None:
    parameters = five_legs().with_values({"leg[3].main_strut.length": 1.41})
    history = Landing(parameters).run(0.3, 0.05)
    feet = wireframe(history, parameters, np.arange(len(history)))["feet"][:, :, 0]
    for leg in range(1, 6):
        model = np.stack([history[f"leg[{leg}].footpad.{axis}"] for axis in "xyz"], axis=-1)
        assert np.abs(feet[:, leg - 1] - model).max() < 1e-13


def _ends(parameters: Parameters, moved: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """The first and the last frame's ground and force lines."""
    history = Landing(parameters, inputs=moved).run(0.3, 0.05)
    film = MovingFigure(history, parameters, np.array([0, 6]), "", "3d")
    found = []
    for i in (0, 1):
        film.show(i)
        found.append(
            np.concatenate([np.ravel(line.get_data_3d()) for line in film._vehicle.lines[-2:]])
        )
    return found[0], found[1]


def test_the_deck_and_the_forces_of_a_film_move() -> None:
    symmetric = load_preset("yue2022-figures").for_mode("2-2")
    for parameters, moved in ((five_legs(), DECK), (symmetric, {"ground.heave_rate": 0.2})):
        first, last = _ends(parameters, moved)
        assert np.nanmax(np.abs(last - first)) > 0.05
