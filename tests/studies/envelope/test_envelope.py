"""Envelopes of real landings beside landings made again and symmetry."""

from __future__ import annotations

import re
import sys
from math import radians
from pathlib import Path

import pytest
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.studies.criteria import CRITERIA, FAILED
from rlv_landing.studies.envelope.judged_landing import JudgedLanding, judged_landing
from rlv_landing.studies.envelope.results import record, stretches, verdict
from rlv_landing.studies.envelope.search import Envelope, envelope
from rlv_landing.studies.envelope.store import Store
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy, study_from
from rlv_landing.studies.outcome import SEVERITY, outcome
from rlv_landing.studies.whole_landing import whole_landing

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[3]
V, TILT = "drop.horizontal_velocity", "drop.tilt"
GRIPPING = load_preset("yue2022-figures").with_values(
    {"ground.friction": 0.7, "drop.pitch_rate": 0.0, "drop.contact_time": 0.0}
)
LIMITS = {"main_strut.force": 9e3, "contact.force": 2e4}


def small(**changes) -> EnvelopeStudy:
    """Speeds and tilts to both sides, with few cells and short landings to save time."""
    x, y = Axis(V, -6.0, 6.0, 0.75), Axis(TILT, radians(-12), radians(12), radians(4))
    return EnvelopeStudy(
        **{
            "parameters": GRIPPING,
            "x": x,
            "y": y,
            "cells": 2,
            "levels": 0,
            "until": 2.0,
            "limits": LIMITS,
            **changes,
        }
    )


@pytest.fixture(scope="module")
def found() -> Envelope:
    return envelope(small())


def test_the_lost_side_topples_and_the_stable_one_does_not_when_landed_alone(found):
    (family,) = found.families
    for c in family.lines[0][:3]:
        for (x, y), toppled in ((c.stable, False), (c.lost, True)):
            history = Landing(GRIPPING.with_values({V: x, TILT: y})).run(2.0)
            assert (history["status.phase"][-1] == 3.0) == toppled


def test_the_two_sides_are_no_further_apart_than_the_tolerance(found):
    for line in found.families[0].lines:
        for c in line:
            apart = abs(c.stable[0] - c.lost[0]), abs(c.stable[1] - c.lost[1])
            assert min(apart) == approx(0.0, abs=1e-12)
            assert apart[0] <= 0.75 + 1e-12
            assert apart[1] <= radians(4) + 1e-12


def test_on_level_ground_a_landing_from_the_other_side_is_as_stable(found):
    """Speed and tilt turned: legs 1 and 2 are to 4 and 3 as a mirror image."""
    landings = {(round(x, 9), round(y, 9)): landing for x, y, landing in found.families[0].landings}
    for (x, y), landing in landings.items():
        other = landings.get((round(-x, 9), round(-y, 9)))
        if other is not None:
            assert (landing.name, landing.towards) == (
                other.name,
                {"+x": "-x", "-x": "+x", "": ""}[other.towards],
            )
    ours = {(round(c.x, 9), round(c.y, 9)) for line in found.families[0].lines for c in line}
    assert ours == {(-x, -y) for x, y in ours}


def test_the_critical_condition_is_that_of_the_lost_landing(found):
    c = found.families[0].lines[0][0]
    x, y = c.lost
    landing = Landing(GRIPPING.with_values({V: x, TILT: y}), rtol=found.study.rtol)
    alone = outcome(whole_landing(landing, found.study.until, found.study.every), LIMITS)
    assert (c.landing.name, c.landing.time, c.landing.first_limit) == (
        alone.name,
        approx(alone.time),
        alone.first_limit,
    )
    assert c.landing.condition.startswith(f"topples to {'+x' if x > 0.0 else '-x'}")
    if alone.first_limit is not None:
        assert (
            f"leg {alone.first_limit.leg} passes {alone.first_limit.name} first"
            in c.landing.condition
        )


def test_runs_cover_a_line_in_order(found):
    for line in found.families[0].lines:
        assert [c for stretch in stretches(line) for c in stretch.points] == list(line)
        assert all(a.condition != b.condition for a, b in zip(stretches(line), stretches(line)[1:]))


def test_the_result_does_not_depend_on_the_number_of_workers(found):
    assert record(envelope(small(), workers=4)) == record(found)


def test_an_interrupted_envelope_goes_on_where_it_was_with_the_same_result(found, tmp_path):
    path = tmp_path / "landings.jsonl"
    store = Store(small(), path)

    def interrupt(_family: int, count: int) -> None:
        if count == 10:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        envelope(small(), 2, store, interrupt)
    store.close()
    # killed while a line was being written
    with path.open("a", encoding="utf-8") as f:
        f.write('{"family": 0, "i": 3')
    again = Store(small(), path, resume=True)
    assert len(again.found) == 10
    made: list[int] = []
    assert record(envelope(small(), 2, again, lambda _, count: made.append(count))) == record(found)
    again.close()
    assert len(made) == found.landings - 10
    assert len(Store(small(), path, resume=True).found) == found.landings


def test_landings_of_another_study_are_refused(tmp_path):
    Store(small(), tmp_path / "a.jsonl").close()
    with pytest.raises(LandingError, match="holds landings of another study or version"):
        Store(small(until=3.0), tmp_path / "a.jsonl", resume=True)
    with pytest.raises(LandingError, match=r"a\.jsonl exists; --resume continues with it"):
        Store(small(), tmp_path / "a.jsonl")
    (tmp_path / "b.jsonl").write_text("not ours")
    with pytest.raises(LandingError, match="holds landings of another study or version"):
        Store(small(), tmp_path / "b.jsonl", resume=True)
    assert (tmp_path / "b.jsonl").read_text() == "not ours"


@pytest.mark.parametrize(
    ("criterion", "lost"),
    [("toppled", 1), ("body strike", 2), ("bottomed out", 3), ("slid", 4), ("limit", 1)],
)
def test_a_criterion_counts_what_is_severer_too(criterion, lost):
    assert [JudgedLanding(name, 1.0).lost(criterion) for name in SEVERITY] == [True] * lost + [
        False
    ] * (len(SEVERITY) - lost)
    assert JudgedLanding(FAILED, 1.0).lost(criterion)


def test_a_limit_passed_is_lost_by_the_criterion_limit_only():
    hard = small(criterion="limit")
    landing = judged_landing(hard, {V: 0.3, TILT: 0.0, "drop.vertical_velocity": -3.0})
    assert landing.first_limit is not None
    assert {c for c in CRITERIA if landing.lost(c)} == {"limit"}


def test_a_vehicle_that_bottoms_out_says_with_which_leg():
    landing = judged_landing(small(), {V: 0.3, TILT: -0.13, "main_strut.stroke_max": 0.015})
    assert (landing.name, landing.condition.split(",")[0]) == (
        "bottomed out",
        f"leg {landing.leg} bottoms out",
    )


def test_inputs_are_axes_too():
    """A moment strong enough topples any vehicle."""
    study = small(x=Axis("external.moment", 0.0, 4000.0, 2000.0))
    (family,) = envelope(study).families
    assert verdict(family, "toppled") == "boundary found"
    assert all(landing.towards == "+x" for x, _, landing in family.landings if x == 4000.0)


@pytest.mark.parametrize("source", ["docs/envelope.md", "examples/envelope.toml"])
def test_the_studies_that_are_shown_can_be_read(source):
    text = (ROOT / source).read_text(encoding="utf-8")
    study = study_from(
        tomllib.loads(
            re.findall(r"```toml\n(.*?)```", text, re.S)[0] if source.endswith(".md") else text
        )
    )
    assert (len(study.families), study.lattice.uniform) == (6, 193 * 97)


AXES = {
    "x": {"name": V, "low": -6, "high": 6, "tolerance": 0.5},
    "y": {"name": TILT, "low": "-12 deg", "high": "12 deg"},
}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"x": {**AXES["x"], "name": "drop.horizontal"}},
            (
                r"unknown quantity for an axis 'drop\.horizontal'; "
                r"did you mean drop\.horizontal_velocity"
            ),
        ),
        (
            {"x": {**AXES["x"], "name": "drop.mode"}},
            r"drop\.mode is one of 2-2, 1-2-1, space and cannot be an axis; make it a family",
        ),
        (
            {"x": {**AXES["x"], "low": 6}},
            r"drop\.horizontal_velocity: low = 6 must be below high = 6 m/s",
        ),
        (
            {"x": {**AXES["x"], "high": 60}},
            r"drop\.horizontal_velocity = 60 m/s is outside \[-50, 50\] m/s",
        ),
        (
            {"x": {**AXES["x"], "tolerance": 0}},
            (
                r"tolerance = 0 m/s is outside \[1\.14441e-05, 12\] m/s; "
                r"give the resolution that you need"
            ),
        ),
        ({"x": {**AXES["x"], "tolerance": 1e-9}}, r"tolerance = 1e-09 m/s is outside"),
        (
            {"x": {**AXES["x"], "tolerance": "1 kg"}},
            r"drop\.horizontal_velocity = '1 kg' has the wrong unit",
        ),
        ({"x": {"name": V, "low": 0}}, r"\[x\] has no high"),
        ({"x": {**AXES["x"], "lo": 0}}, r"unknown key of \[x\] 'lo'"),
        ({"y": {}}, r"\[y\] has no name"),
        ({"y": AXES["x"]}, r"drop\.horizontal_velocity is given twice"),
        ({"envelope": {"criterion": "tilted"}}, r"unknown criterion 'tilted'"),
        ({"envelope": {"criterion": "limit"}}, r"criterion = limit needs limits"),
        ({"envelope": {"cells": 1}}, r"cells = 1 must be a whole number from 2 to 256"),
        ({"envelope": {"until": 0}}, r"until = 0 s is outside \[0\.1, 3600\] s"),
        ({"envelope": {"colour": "red"}}, r"unknown key of \[envelope\] 'colour'"),
        (
            {"families": {"ground.friction": []}},
            r"ground\.friction = \[\] must be a list of one value or more",
        ),
        ({"families": {"ground.friction": [0.3, 0.3]}}, r"names a value twice"),
        ({"families": {"ground.friction": [4.0]}}, r"ground\.friction = 4  ?is outside \[0, 3\]"),
        ({"families": {TILT: [0.0]}}, r"drop\.tilt is given twice, as an axis or in families"),
        ({"set": {TILT: 0.1}}, r"drop\.tilt is both set and varied"),
        (
            {"limits": {"main_strut.forse": 1}},
            r"unknown limit 'main_strut\.forse'; did you mean main_strut\.force",
        ),
        ({"axes": {}}, r"unknown table 'axes'"),
    ],
)
def test_a_study_that_cannot_be_is_refused(changes, message):
    with pytest.raises(LandingError, match=message):
        study_from({**AXES, **changes})
