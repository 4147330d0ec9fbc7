"""A landing that ends where the vehicle stands tells what one to its rest tells, and sooner."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from rlv_landing import Landing, LandingError, Parameters, land_many
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import whole_landing

SPACE = (
    Parameters()
    .for_mode("space")
    .with_values(
        {
            "drop.contact_time": 0.0,
            "drop.pitch_rate": 0.0,
            "vehicle.leg_azimuth": radians(45.0),
            "ground.friction": 0.9,
            "ground.slope": radians(3.0),
        }
    )
)


def states(count: int) -> dict[str, np.ndarray]:
    """From soft landings to those that topple."""
    rng = np.random.default_rng(4)
    return {
        "drop.heading": rng.uniform(-3.0, 3.0, count),
        "drop.direction": rng.uniform(0.0, 6.0, count),
        "drop.speed": np.linspace(0.0, 4.0, count),
        "drop.roll": rng.normal(0.0, 0.04, count),
        "drop.tilt": rng.normal(0.0, 0.04, count),
    }


def test_outcomes_peaks_and_margins_are_those_of_rest():
    given = states(16)
    stands, rests = (land_many(SPACE, given, end=end) for end in ("stands", "rests"))
    same = {("standing", "settled")}
    pairs = list(zip(stands["outcome"], rests["outcome"]))
    assert all(a == b or (a, b) in same for a, b in pairs)
    assert {"standing", "toppled", "slid"} <= {a for a, _ in pairs}
    for name in stands:
        if not name.startswith(("outcome", "rhs", "margin.stability_end")):
            size = np.abs(rests[name]).max()
            np.testing.assert_allclose(stands[name], rests[name], rtol=0.0, atol=1e-3 * size)
    soft = np.array([pair in same for pair in pairs])
    assert stands["rhs_calls"][soft].sum() < 0.7 * rests["rhs_calls"][soft].sum()


@pytest.mark.parametrize(
    "inputs", [{"external.force_x": 1.0}, {"ground.heave_rate": 0.01}, {"external.moment_y": 1.0}]
)
def test_what_acts_from_outside_may_still_move_it(inputs):
    landing = Landing(SPACE, inputs=inputs)
    assert outcome(whole_landing(landing, 3.0, 1e-2, standing=True)).name != "standing"


def test_a_vehicle_that_slides_faster_and_faster_does_not_stand():
    ice = SPACE.with_values({"ground.friction": 0.05, "drop.vertical_velocity": -0.05})
    start = {"drop.horizontal_velocity": 0.0, "drop.tilt": radians(3.0)}
    found = outcome(whole_landing(Landing(ice.with_values(start)), 1.5, 1e-2, standing=True))
    assert found.name in ("slid", "moving")


def test_an_end_that_is_none_is_refused():
    with pytest.raises(LandingError, match="unknown end 'stand'; did you mean stands"):
        land_many(SPACE, states(1), end="stand")
