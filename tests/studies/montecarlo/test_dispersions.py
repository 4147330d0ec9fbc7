"""Dispersed values: run k of a seed by itself, and the distributions that were asked for."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from montecarlo_studies import write
from scipy.stats import binom, kstest, truncnorm

from rlv_landing.errors import LandingError
from rlv_landing.studies.montecarlo.covariance import Correlated, read_correlated
from rlv_landing.studies.montecarlo.dispersions import Dispersions, Runs, unit_numbers
from rlv_landing.studies.montecarlo.intervals import order_statistics, wilson
from rlv_landing.studies.montecarlo.study import read_montecarlo
from rlv_landing.studies.sweep.factors import read_factor

ROOT = Path(__file__).resolve().parents[3]
COVARIANCE = ((4.0, 1.0, 0.0), (1.0, 1.0, 0.3), (0.0, 0.3, 9.0))
NAMES = ("drop.tilt", "drop.roll", "drop.lateral_velocity")


def dispersions(seed: int = 1) -> Dispersions:
    factors = (
        read_factor({"name": "drop.heading", "unit": "deg", "low": -90.0, "high": 90.0}),
        read_factor(
            {
                "name": "drop.vertical_velocity",
                "distribution": "normal",
                "mean": -1.4,
                "deviation": 0.5,
                "high": -1.0,
            }
        ),
        read_factor({"name": "ground.friction", "values": [0.2, 0.4, 0.6]}),
    )
    return Dispersions(seed, factors, Correlated(NAMES, (0.1, 0.0, -1.0), COVARIANCE))


@settings(max_examples=30)
@given(st.integers(0, 2**31 - 1), st.integers(0, 10**9), st.integers(1, 9), st.integers(1, 9))
def test_a_run_is_the_same_whatever_is_drawn_with_it(seed, run, before, after):
    runs = Runs(dispersions(seed), 1)
    first = max(0, run - before)
    together = runs.rows(first, run + after)
    assert together[run - first] == runs.rows(run, run + 1)[0]


def test_the_numbers_of_a_run_are_frozen():
    """Those of numpy 2.4: other ones would make every study another."""
    found = unit_numbers(20, 3, 5, 2)
    expected = [
        [0.29694488425154303, 0.08334964333283751],
        [0.47978403806280806, 0.331154019995138],
    ]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=0.0)
    assert (unit_numbers(20, 3, 5, 7)[:, :2] == found).all()


def test_the_distributions_are_those_asked_for():
    columns = dispersions().columns(0, 20_000)
    correlated = np.array([columns[name] for name in NAMES])
    np.testing.assert_allclose(correlated.mean(axis=1), (0.1, 0.0, -1.0), atol=0.06)
    np.testing.assert_allclose(np.cov(correlated), COVARIANCE, atol=0.15)
    cut = truncnorm(-np.inf, 0.8, -1.4, 0.5)
    assert kstest(columns["drop.vertical_velocity"], cut.cdf).pvalue > 1e-3
    heading = columns["drop.heading"] / np.pi
    assert kstest(heading, "uniform", (-0.5, 1.0)).pvalue > 1e-3
    counts = [int((columns["ground.friction"] == v).sum()) for v in (0.2, 0.4, 0.6)]
    assert sum(counts) == 20_000
    assert min(counts) > 6400


@pytest.mark.parametrize("deviation", [(1.0, 1.0), (2.0, 0.0)])
def test_a_covariance_may_be_singular(deviation):
    a, b = deviation
    c = Correlated(NAMES[:2], (0.0, 0.0), ((a * a, a * b), (a * b, b * b)))
    x, y = Dispersions(1, (), c).columns(0, 50).values()
    np.testing.assert_allclose(a * y, b * x, atol=1e-9)
    assert np.ptp(x) > 0.0


@pytest.mark.parametrize(
    ("matrix", "message"),
    [
        (((1.0, 2.0), (2.0, 1.0)), "not positive semi-definite: its correlations have an"),
        (((1.0, 0.2), (0.3, 1.0)), "it must be symmetric"),
        (((-1.0, 0.0), (0.0, 1.0)), "the variance of drop.tilt is -1, below 0"),
        (((0.0, 0.5), (0.5, 1.0)), "not positive semi-definite"),
    ],
)
def test_a_covariance_that_is_none_is_refused(matrix, message):
    with pytest.raises(LandingError, match=message):
        Correlated(NAMES[:2], (0.0, 0.0), matrix)


@pytest.mark.parametrize("keys", [(), ("deviation",), ("correlation",), ("matrix", "deviation")])
def test_a_covariance_is_given_by_a_matrix_or_by_deviation_and_correlation(keys):
    known = {"matrix": [[1.0]], "deviation": [1.0], "correlation": [[1.0]]}
    read = {"names": [NAMES[0]], "mean": [0.0], **{key: known[key] for key in keys}}
    with pytest.raises(LandingError, match="needs matrix, or deviation and correlation; give one"):
        read_correlated(read)


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [(0, 10, 0.0, 0.277533), (10, 10, 0.722467, 1.0), (81, 263, 0.2553, 0.3662)],
)
def test_wilson_s_interval_is_that_of_the_literature(successes, runs, low, high):
    """The last is Newcombe's (1998), Table I: 81 of 263, 0.2553 to 0.3662."""
    assert wilson(successes, runs, 0.95) == pytest.approx((low, high), abs=5e-5)
    assert wilson(0, 0, 0.95) == (0.0, 1.0)


@pytest.mark.parametrize("part", [0.05, 0.5, 0.95])
@pytest.mark.parametrize("runs", [10, 59, 400])
def test_an_interval_of_order_statistics_covers_its_quantile(runs, part):
    at, low, high = order_statistics(runs, part, 0.95)
    # the values below the quantile are binomial, whatever the distribution
    above = 0.0 if low is None else binom.cdf(low, runs, part)
    below = 0.0 if high is None else binom.sf(high, runs, part)
    assert max(above, below) <= 0.025
    assert 0 <= at < runs
    assert low is None or low <= at
    assert high is None or high >= at
    # the next narrower interval does not
    assert low is None or binom.cdf(low + 1, runs, part) > 0.025
    assert high is None or binom.sf(high - 1, runs, part) > 0.025


FACTOR = '[[factor]]\nname = "drop.roll_rate"\nlow = -0.1\nhigh = 0.1\n'


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            (
                "[[1.0, 0.0, 0.3], [0.0, 1.0, 0.0], [0.3, 0.0, 1.0]]",
                "[[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]]",
            ),
            "the strongest is 0.9, of drop.roll and drop.tilt",
        ),
        (("[0.3, 0.0, 1.0]]", "[-0.3, 0.0, 1.0]]"), "it must be symmetric"),
        (("[0.3, 0.0, 1.0]]", "[0.3, 0.0, 2.0]]"), "with itself = 2 must be 1"),
        (("[0.3, 0.0, 1.0]]", "[0.3, 0.0]]"), "2 for 3 names; give one for each"),
        (("deviation = [1.0,", "deviation = [-1.0,"), "deviation of drop.tilt = -1 is below 0"),
        (("deviation = [1.0,", 'deviation = ["a",'), "must be a list of numbers"),
        (("deviation = [1.0, 1.5, 0.2]\n", ""), "needs matrix, or deviation and correlation"),
        (("mean = [0.0,", "mean = [200.0,"), "drop.tilt = 3.49066 rad is outside"),
        (('"deg", "deg", "m/s"', '"deg", "m", "m/s"'), "wrong unit"),
        (('"drop.roll", "drop', '"drop.rol", "drop'), "did you mean drop.roll?"),
        (('"drop.roll", "drop', '"drop.mode", "drop'), "make it a [[factor]]"),
        (("[set]\n", "[set]\ndrop.roll = 0.1\n"), "drop.roll is given twice"),
        (("[set]\n", '[set]\ndrop.mode = "space"\n'), "drop.mode is given in [set]"),
        (("[set]\n", "[sets]\n"), "unknown table 'sets'"),
        (('mode = "space"', 'mode = "2-2"'), "needs drop.mode = space"),
        (("seed = 5", "seed = -5"), "seed = -5 must be a whole number"),
        (("seed = 5", "width = 2.0"), "width = 2 is outside"),
        (("seed = 5", "level = 1.0"), "level = 1 is outside"),
        (("seed = 5", 'criterion = "topple"'), "unknown criterion 'topple'"),
        (("seed = 5", 'criterion = "limit"'), "needs [limits]"),
        (("seed = 5", 'loads = ["outcome"]'), "outcome is no real number"),
        (("seed = 5", 'loads = ["margin.slip"]'), "unknown response 'margin.slip'"),
        (("seed = 5", "percentiles = [101]"), "percentiles = 101 is outside"),
        (("samples = 12", "samples = 0"), "samples = 0 must be a whole number from 1"),
        (("samples = 12", "samples = 1000000000"), "is more than is possible"),
        (("[covariance]", '[[grade]]\nname = "a"\n[covariance]'), "grade a has no bounds"),
        (
            ("[covariance]", '[[grade]]\nname = "a"\nmost = { outcome = 1 }\n[covariance]'),
            "outcome is a text",
        ),
        (("[covariance]", "[table]\n[covariance2]"), "unknown table 'covariance2'"),
        (("[covariance]", '[table]\nfile = "no.csv"\n[covariance]'), "there is no table"),
        (
            ("[covariance]", '[table]\nfile = "a.csv"\ndraw = "often"\n[covariance]'),
            "unknown draw of [table] 'often'",
        ),
    ],
)
def test_a_bad_study_is_one_clear_line(tmp_path: Path, change: tuple[str, str], message: str):
    path = write(tmp_path)
    text = path.read_text()
    assert change[0] in text
    path.write_text(text.replace(*change))
    with pytest.raises(LandingError) as caught:
        read_montecarlo(path)
    assert message in str(caught.value)
    assert len(str(caught.value)) <= 300


def test_a_table_gives_its_rows_in_order_or_at_random(tmp_path: Path):
    names = "drop.tilt,drop.pitch_rate,drop.speed,drop.direction,drop.heading,drop.roll_rate"
    (tmp_path / "a.csv").write_text(
        f"{names},drop.yaw_rate,drop.roll [deg],drop.vertical_velocity\n"
        + "".join(f"0.0{k},0,0.1,0,0,0,0,{k},-1.4\n" for k in range(4))
    )
    found: dict[str, list[Any]] = {}
    for draw in ("in order", "at random"):
        table = f'[table]\nfile = "a.csv"\ndraw = "{draw}"\n'
        (tmp_path / "s.toml").write_text(f'[montecarlo]\nmode = "space"\n{table}')
        study = read_montecarlo(tmp_path / "s.toml")
        runs = Runs(study.dispersions, 4)
        found[draw] = [row["drop.tilt"] for row in runs.rows(0, 4)]
        if draw == "at random":
            assert study.samples == 1000
            drawn = study.dispersions.columns(0, 4000)
            counts = np.bincount(np.rint(100.0 * drawn["drop.tilt"]).astype(int))
            assert counts.min() > 850
            # a row stays together
            np.testing.assert_allclose(np.degrees(drawn["drop.roll"]), 100.0 * drawn["drop.tilt"])
        else:
            assert study.samples == 4
    assert found["in order"] == [0.0, 0.01, 0.02, 0.03]


def test_the_studies_that_are_shown_can_be_read(tmp_path: Path):
    shown = (ROOT / "docs" / "montecarlo.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"```toml\n(.*?)```", shown, re.S)
    (tmp_path / "study.toml").write_text(text)
    (tmp_path / "mine.toml").write_text('[drop]\nmode = "space"\n')
    (tmp_path / "states.csv").write_text(
        "case,drop.pitch_rate,drop.horizontal_velocity,drop.lateral_velocity,drop.roll_rate,"
        "drop.yaw_rate\n1,0,0.1,0.2,0,0\n"
    )
    study = read_montecarlo(tmp_path / "study.toml")
    assert (study.samples, study.width, study.worst, len(study.grades)) == (2000, 0.02, 3, 1)
    assert len(study.dispersions.names) == 10
    assert read_montecarlo(ROOT / "examples/touchdown_study/montecarlo.toml").width == 0.04
