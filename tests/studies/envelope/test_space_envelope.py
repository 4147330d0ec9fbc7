"""Envelopes in space: any of its quantities is an axis, and a vehicle topples over an edge."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rlv_landing.errors import LandingError
from rlv_landing.figures.envelope.figure import save_envelope
from rlv_landing.studies.envelope.judged_landing import JudgedLanding, judged_landing
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.store import Store
from rlv_landing.studies.envelope.study import EnvelopeStudy, study_from

DIRECTION = {"name": "drop.direction", "low": "0 deg", "high": "360 deg", "tolerance": "90 deg"}
SPEED = {"name": "drop.speed", "low": 2.0, "high": 6.0, "tolerance": 0.5}
SET = {
    "vehicle.leg_azimuth": "45 deg",
    "drop.pitch_rate": 0.0,
    "drop.tilt": 0.0,
    "ground.friction": 1.0,
}


def study(x: dict[str, Any] = DIRECTION, y: dict[str, Any] = SPEED, **more: Any) -> EnvelopeStudy:
    keys = {"mode": "space", "cells": 2, "levels": 0, "until": 0.7, "every": 1e-2, "rtol": 1e-3}
    document = {"envelope": {**keys, **more.pop("keys", {})}, "set": SET, "x": x, "y": y, **more}
    return study_from(document)


def test_the_velocity_over_its_direction_is_a_polar_chart(tmp_path: Path):
    asked = study()
    assert asked.is_polar
    with_store = Store(asked, tmp_path / "landings.jsonl")
    found = envelope(asked, 2, with_store)
    with_store.close()
    (family,) = found.families
    conditions = {c.landing.condition for line in family.lines for c in line}
    assert conditions <= {f"topples over legs {a}" for a in ("1, 2", "2, 3", "3, 4", "1, 4")}
    by_direction = {round(c.x, 2): c.landing.towards for line in family.lines for c in line}
    # towards x over the legs at -45 and 45 deg, backwards over those at 135 and 225 deg
    assert by_direction[0.0] == by_direction[6.28] == "legs 1, 4"
    assert by_direction[3.14] == "legs 2, 3"
    save_envelope(found, tmp_path / "polar.svg")
    assert "legs 2, 3" in (tmp_path / "polar.svg").read_text()
    # the same again, from the file alone
    again = Store(asked, tmp_path / "landings.jsonl", resume=True)
    assert again.found == with_store.found
    again.close()


def test_the_same_velocity_by_components_is_the_same_landing():
    values = {"drop.direction": 0.5, "drop.speed": 4.0}
    by_speed = judged_landing(study(), values)
    x = {"name": "drop.horizontal_velocity", "low": -6.0, "high": 6.0}
    y = {"name": "drop.lateral_velocity", "low": -6.0, "high": 6.0}
    plain = study(x, y)
    assert not plain.is_polar
    components = {
        "drop.horizontal_velocity": 4.0 * 0.8775825618903728,
        "drop.lateral_velocity": 4.0 * 0.479425538604203,
    }
    by_components = judged_landing(plain, components)
    assert by_speed.name == by_components.name
    assert by_speed.stability_min == pytest.approx(by_components.stability_min, rel=1e-6)


@pytest.mark.parametrize("side", ["legs 1, 9", "legs 12", "+z", "x"])
def test_a_side_that_is_none_is_refused(side):
    record = {"name": "toppled", "time": 1.0, "first_limit": None, "towards": side}
    with pytest.raises(ValueError, match="is no side"):
        JudgedLanding.from_record(record, 4)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"keys": {"mode": "2-2"}}, "drop.direction needs drop.mode = space"),
        ({"y": {"name": "external.moment", "low": 0.0, "high": 1.0}}, "needs drop.mode = 2-2"),
        (
            {"y": {"name": "drop.lateral_velocity", "low": 0.0, "high": 1.0}},
            "both give the horizontal velocity",
        ),
        ({"families": {"drop.mode": ["space", "2-2"]}}, "needs drop.mode = space"),
    ],
)
def test_what_the_mode_lacks_is_refused_at_the_door(keys, message):
    with pytest.raises(LandingError) as caught:
        study(**keys)
    assert message in str(caught.value)
