"""The outcome in space: margins above a ground that moves, and the edge of a vehicle that topples.

A symmetric landing is a special case, and turning or moving the whole scene changes nothing.
"""

from __future__ import annotations

from math import cos, pi, radians, sin

import pytest

from rlv_landing import Landing, Parameters
from rlv_landing.studies.outcome import Outcome, outcome
from rlv_landing.studies.whole_landing import whole_landing

SPACE = {"drop.mode": "space", "drop.contact_time": 0.0}
# of the default azimuth, 2-2 stands at 45 deg
SQUARE = SPACE | {"vehicle.leg_azimuth": radians(135.0)}


def landed(
    values: dict[str, float | str], inputs: dict[str, float] | None = None, until: float = 0.4
) -> Outcome:
    landing = Landing(Parameters().with_values(values), inputs=inputs)
    return outcome(whole_landing(landing, until, decided=False))


def margins(found: Outcome) -> dict[str, float]:
    """Those that do not depend on how the stability margin is defined."""
    return {name: v for name, v in found.margins.items() if not name.startswith("stability")}


@pytest.mark.parametrize(
    "inputs",
    [{}, {"ground.heave_rate": 0.1, "ground.tilt_rate": 0.05}, {"ground.tilt": 0.02}],
)
def test_the_margins_of_a_symmetric_landing_are_those_in_space(inputs):
    given = {"drop.contact_time": 0.0, "ground.slope": 0.03}
    planar, spatial = landed(given, inputs), landed(SQUARE | given, inputs)
    assert margins(spatial) == pytest.approx(margins(planar), abs=1e-6)
    assert margins(planar)["slid"] > 1e-3


def test_a_deck_that_moves_with_the_vehicle_changes_no_margin():
    still = landed(SQUARE | {"drop.roll": 0.02})
    moved = {"drop.horizontal_velocity": 0.3492 + 0.5, "drop.lateral_velocity": -0.3}
    along = {"ground.surge_rate": 0.5, "ground.sway_rate": -0.3, "ground.surge": 2.0}
    assert margins(landed(SQUARE | {"drop.roll": 0.02} | moved, along)) == pytest.approx(
        margins(still), abs=1e-5
    )


@pytest.mark.parametrize(
    ("direction", "deck"),
    [(0.0, {"ground.tilt": 0.05}), (0.5 * pi, {"ground.roll": 0.05})],
)
def test_a_deck_that_is_turned_is_a_slope(direction, deck):
    slope = {"ground.slope": 0.05, "ground.slope_direction": direction}
    assert margins(landed(SQUARE, deck)) == pytest.approx(margins(landed(SQUARE | slope)), abs=1e-6)


@pytest.mark.parametrize("turn", [0.0, 70.0, 200.0])
def test_a_vehicle_topples_over_the_same_legs_however_the_scene_is_turned(turn):
    at = radians(10.0 + turn)
    found = landed(
        SPACE
        | {
            "vehicle.leg_azimuth": radians(45.0),
            # the heading turns from x away from z
            "drop.heading": radians(-turn if turn < 180.0 else 360.0 - turn),
            "drop.horizontal_velocity": 6.0 * cos(at),
            "drop.lateral_velocity": 6.0 * sin(at),
            "drop.tilt": 0.0,
            "drop.pitch_rate": 0.0,
            "ground.friction": 1.0,
        },
        until=1.0,
    )
    assert (found.name, found.edge) == ("toppled", "legs 1, 4")
    assert found.direction is not None
    off = (found.direction - radians(turn) + pi) % (2.0 * pi) - pi
    assert abs(off) < radians(20.0)


def test_a_vehicle_that_stands_has_no_edge_and_no_direction():
    found = landed(SQUARE)
    assert (found.edge, found.direction) == (None, None)
