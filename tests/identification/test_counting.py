"""Identification that counts: soft misses, the counting search, the tests' scalars.

The report counts by both rules and predicts the other landing mode.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.identification.conditions import CONDITIONS
from rlv_landing.identification.counting.descent import SOFTNESSES, damped_points
from rlv_landing.identification.counting.soft_count import BOUNDS, TOLERANCE, WORTH
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.objective import Objective
from rlv_landing.identification.targets import (
    Fit,
    Wanted,
    fit_of,
    landed,
    paper_targets,
    targets_of_tests,
)
from rlv_landing.presets import read_toml
from rlv_landing.validation.paper import printed_scalars
from rlv_landing.validation.reading import Reading
from rlv_landing.validation.sensors import through_sensors

FIGURES = "yue2022-figures"
TRUTH = {"main_strut.orifice_area_compression": 1.1e-5, "ground.friction": 0.25}
FREE = ",".join(TRUTH)
OBJECTIVE = Objective(FreeNumbers(load_preset(FIGURES)), paper_targets())
COUNT = OBJECTIVE.soft_count
N = len(OBJECTIVE.targets)
PLAUSIBLE = np.zeros(2 * len(CONDITIONS))
# errors that are well inside or well outside every bound, where the soft count must be the hard one
CLEAR = st.sampled_from((0.0, 0.01, 0.03, 0.07, 0.14, 0.3, 1.0))


def misses(errors: list[float] | np.ndarray, departures: np.ndarray = PLAUSIBLE) -> float:
    return OBJECTIVE.missed(np.concatenate([np.asarray(errors) / TOLERANCE, departures]))


@given(st.lists(CLEAR, min_size=N, max_size=N))
def test_soft_misses_are_the_hard_ones_where_no_error_is_near_a_bound(errors):
    """But for the small pull, which is Cauchy's loss."""
    hard = sum(worth * (e > bound) for e in errors for bound, worth in zip(BOUNDS, WORTH))
    pull = misses(errors) - sum(
        w / (1.0 + np.exp((p - e) / (0.005 * p))) for e in errors for p, w in zip(BOUNDS, WORTH)
    )
    assert pull == approx(0.05 * np.log1p((np.array(errors) / TOLERANCE) ** 2).sum(), abs=1e-9)
    assert misses(errors) - pull == approx(hard, abs=0.06 * sum(WORTH) * N)


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=N, max_size=N),
    st.sampled_from(SOFTNESSES),
    st.integers(0, N + len(PLAUSIBLE) - 1),
)
def test_weights_have_the_slope_of_the_misses(errors, softness, which):
    misfits = np.concatenate([np.array(errors) / TOLERANCE, np.full(len(PLAUSIBLE), 0.3)])
    assume(abs(misfits[which]) > 0.01)
    higher, lower = misfits.copy(), misfits.copy()
    higher[which] += 1e-5
    lower[which] -= 1e-5
    slope = (COUNT.missed(higher, softness) - COUNT.missed(lower, softness)) / 2e-5
    assert COUNT.weights(misfits, softness)[which] * misfits[which] == approx(
        slope, rel=1e-4, abs=1e-7
    )


def test_damped_steps_of_a_linear_problem_end_in_its_minimum_on_the_cube():
    """Misfits J z - b: the least damped step solves it, or ends on the face if that is nearer."""
    jacobian = np.array([[2.0, 0.3], [0.3, 1.0], [0.1, 0.2]]) * 1e3
    z, weights = np.array([0.5, 0.5]), np.array([1.0, 2.0, 0.5])
    for minimum, expected in (((0.6, 0.42), (0.6, 0.42)), ((0.55, 1.1), (None, 1.0))):
        misfits = jacobian @ (z - minimum)
        reached = damped_points(z, misfits, jacobian, weights)[0]
        for _ in range(5):  # the largest step is bounded
            reached = damped_points(reached, jacobian @ (reached - minimum), jacobian, weights)[0]
        assert all(e is None or r == approx(e, abs=1e-6) for r, e in zip(reached, expected))
        slope = (jacobian.T * weights) @ jacobian @ (reached - minimum)
        assert all(abs(s) < 1.0 or r in (0.0, 1.0) for s, r in zip(slope, reached))


@given(
    st.lists(st.floats(-2.0, 2.0), min_size=N, max_size=N),
    st.integers(0, N - 1),
    st.floats(1.01, 3.0),
)
def test_a_larger_error_never_counts_less(errors, which, factor):
    larger = list(errors)
    larger[which] *= factor
    assert misses(larger) >= misses(errors) - 1e-12


@given(st.integers(0, len(PLAUSIBLE) - 1), st.floats(0.01, 5.0))
def test_a_missed_plausibility_condition_costs_more_than_the_scalar_it_may_win(which, departure):
    departed = PLAUSIBLE.copy()
    departed[which] = departure
    assert misses(np.zeros(N), departed) - misses(np.zeros(N)) == approx(30.0 * departure)


def test_the_tests_targets_are_the_35_printed_ones_on_the_scale_they_are_judged_on():
    wanted = targets_of_tests()
    assert len(wanted) == 35
    scalars = {s.id: s for s in printed_scalars()}
    for w in wanted:
        s = scalars[w.id]
        assert (w.value - s.simulation) / w.scale == approx(-s.paper_error_test)


def test_the_tests_scalars_are_read_off_what_the_sensors_record():
    base = load_preset(FIGURES)
    history = landed(base, "1-2-1")
    wanted = [Wanted("121-a-pk2", "1-2-1", 28.34, 27.89)]
    (plain,), (sensed,) = fit_of(base, wanted), fit_of(base, wanted, sensors=True)
    assert plain.ours == Reading(history).acceleration_peak(2)
    assert sensed.ours == Reading(through_sensors(history)).acceleration_peak(2)
    assert sensed.ours < plain.ours
    objective = Objective(
        FreeNumbers(base, ["ground.friction"]), wanted, conditions=(), sensors=True
    )
    assert objective.misfits(objective.free.start()) == approx([sensed.error / TOLERANCE])


def test_the_auxiliary_struts_yield_is_its_stroke_less_the_joints_play():
    base = load_preset(FIGURES)
    measure = next(c.measure for c in CONDITIONS if c.name == "auxiliary strut's yield")
    with_play = base.with_values(
        {"auxiliary_strut.play_tension": 8e-4, "auxiliary_strut.play_compression": 3e-4}
    )
    history = Landing(with_play, "2-2").run(0.6)
    strokes = np.concatenate([history[f"leg[{leg}].auxiliary_strut.stroke"] for leg in (1, 3)])
    assert measure(history) == approx(max(strokes.max() - 3e-4, -strokes.min() - 8e-4))
    assert measure(history) < np.abs(strokes).max()


def test_errors_are_on_the_scale_or_plain():
    near_zero = Fit(Wanted("22-s1-reb", "2-2", 0.44, 20.62), 1.44)
    assert near_zero.error == approx(1.0 / 20.62)
    assert near_zero.plain_error == approx(1.0 / 0.44)


def test_the_drop_of_a_mode_that_is_not_fitted_is_not_free():
    numbers = FreeNumbers(load_preset(FIGURES), modes=["2-2"])
    assert "2-2: drop.tilt" in numbers.labels
    assert not any(label.startswith("1-2-1") for label in numbers.labels)


@pytest.fixture
def targets(tmp_path: Path) -> Path:
    """Scalars of a 2-2 landing with more friction and a wider orifice than the preset."""
    truth = load_preset(FIGURES, "2-2").with_values(TRUTH)
    ids = ("22-fm1-td", "22-fm3-td", "22-fm3-max", "22-s3-max", "22-fa1-tens")
    fits = fit_of(truth, [t for t in paper_targets() if t.id in ids])
    units = {s.id: s.unit for s in printed_scalars()}
    path = tmp_path / "targets.csv"
    path.write_text(
        "id,value,unit\n"
        + "".join(f"{f.wanted.id},{f.ours!r},{units[f.wanted.id]}\n" for f in fits)
    )
    return path


def test_counting_finds_the_numbers_repeats_itself_and_resumes_round_by_round(
    targets, tmp_path, monkeypatch, command
):
    monkeypatch.chdir(tmp_path)
    fixed = (
        "--targets",
        str(targets),
        "--free",
        FREE,
        "--mode",
        "2-2",
        "--evaluations",
        "1",
        "--polish",
        "0",
        "--no-conditions",
    )
    for work, counts in (("whole", (200,)), ("again", (200,)), ("parts", (1, 200))):
        for i, count in enumerate(counts):
            done = command(
                "identify",
                *fixed,
                "--work",
                work,
                "--count",
                str(count),
                *(["--resume"] if i else []),
            )
            assert done.code == 0, done.err
    best = [
        json.loads((tmp_path / work / "best.json").read_text())
        for work in ("whole", "again", "parts")
    ]
    assert best[0] == best[1] == best[2]
    assert best[0]["stage"] == "counting search"
    assert best[0]["missed"] < 0.01 < best[0]["start_missed"]
    found = read_toml(tmp_path / "whole" / "identified.toml")
    for name, value in TRUTH.items():
        assert found[name] == approx(value, rel=0.05)


def test_the_report_counts_by_both_rules_and_predicts_the_other_landing_mode(
    tmp_path, monkeypatch, command
):
    monkeypatch.chdir(tmp_path)
    fit = ("--scalars", "tests", "--mode", "2-2", "--free", FREE)
    search = ("--evaluations", "1", "--polish", "0", "--count", "1", "--workers", "1")
    done = command("identify", *fit, *search)
    assert done.code in (0, 1), done.err
    report = (tmp_path / "identification" / "report.md").read_text()
    of_mode = {mode: sum(t.mode == mode for t in targets_of_tests()) for mode in ("2-2", "1-2-1")}
    beside = f"2 free numbers stand beside {of_mode['2-2']} scalars"
    assert f"{beside}, read through the tests' sensor chain" in report
    assert report.count("by the plain relative error") == 2
    assert f"of {of_mode['1-2-1']}**" in report.split("Prediction of 1-2-1")[1].splitlines()[0]


def test_counting_without_scalars_is_refused(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    history = Landing(load_preset(FIGURES, "2-2")).run(0.5, 2e-3)
    rows = [f"{t!r},{v!r}" for t, v in zip(history.time.tolist(), history["body.pitch"].tolist())]
    Path("curves.csv").write_text("time,body.pitch\n" + "\n".join(rows) + "\n")
    done = command("identify", "--series", "2-2=curves.csv", "--count", "10")
    assert done.code == 2
    assert "--count 10 counts scalars, and there are none" in done.err
    assert not (tmp_path / "identification").exists()
