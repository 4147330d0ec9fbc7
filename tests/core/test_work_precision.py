"""The benchmarks' cost at equal error, read off their runs as docs/performance.md says."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
from peers import OURS
from problem import Error
from work_precision import Run, cost


def runs(*peaks: float) -> list[Run]:
    """At tolerances 1e-2, 1e-3, ...: each ten times as slow as the one before."""
    return [
        Run(OURS[0], 10.0 ** -(k + 2), Error(p, p * 1e-3), "", 10.0**k, 0.0, 100 * 10**k)
        for k, p in enumerate(peaks)
    ]


def test_cost_is_interpolated_in_logarithms():
    found = cost(runs(1e-1, 1e-2, 1e-4), 1e-3)
    assert found.seconds == pytest.approx(10.0**1.5)
    assert found.calls == pytest.approx(100 * 10.0**1.5)
    assert found.stroke == pytest.approx(1e-6)
    assert found.bound == ""


def test_a_loose_run_that_is_good_by_chance_does_not_count():
    assert cost(runs(1e-4, 1e-2, 1e-4), 1e-3).seconds == pytest.approx(10.0**1.5)


def test_an_error_out_of_reach_is_a_bound_from_the_tightest_run():
    found = cost(runs(1e-1, 1e-2), 1e-3)
    assert (found.bound, found.seconds, found.calls) == (">", 10.0, 1000)


def test_an_error_that_every_run_keeps_is_a_bound_from_the_loosest_run():
    found = cost(runs(1e-4, 1e-5), 1e-3)
    assert (found.bound, found.seconds) == ("≤", 1.0)


def test_a_run_that_came_to_no_end_is_left_out():
    own = runs(1e-1, 1e-2, 1e-4, 1e-5)
    own[3].failure = "no end"
    assert cost(own, 1e-3).seconds == pytest.approx(10.0**1.5)
