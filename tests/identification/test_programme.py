"""Linear programmes that mend the bounds that are missed by little."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from rlv_landing.identification.counting.programme import programmes
from rlv_landing.identification.counting.soft_count import BOUNDS, TOLERANCE, SoftCount

Vector = np.ndarray


class Linear:
    """Errors and one condition that are linear in the numbers; keeps the best that was tried."""

    def __init__(self, slopes: Vector, zero: Vector, steep: Vector, limit: float) -> None:
        self.slopes, self.zero, self.steep, self.limit = slopes, zero, steep, limit
        self.count = SoftCount(len(slopes), 1)
        self.best, self.fewest = zero, float("inf")

    def evaluate(self, points: Sequence[Sequence[float]]) -> list[Vector]:
        found = []
        for z in map(np.array, points):
            assert ((z >= 0.0) & (z <= 1.0)).all()
            departure = max(0.0, float(self.steep @ z) - self.limit)
            found.append(np.append(self.errors(z) / TOLERANCE, departure))
            if self.count.missed(found[-1]) < self.fewest:
                self.best, self.fewest = z, self.count.missed(found[-1])
        return found

    def errors(self, z: Vector) -> Vector:
        return self.slopes @ (z - self.zero)

    def departed(self) -> bool:
        """Whether the best is beyond the condition, by more than a gain too small for a step."""
        return float(self.steep @ self.best) > self.limit + 1e-3


@pytest.mark.parametrize("seed", range(30))
def test_all_bounds_are_met_where_all_can_be_and_the_condition_holds(seed):
    rng = np.random.default_rng(seed)
    zero, start = rng.uniform(0.3, 0.7, 5), rng.uniform(0.2, 0.8, 5)
    steep = rng.normal(0.0, 1.0, 5)
    problem = Linear(rng.normal(0.0, 0.4, (8, 5)), zero, steep, float(steep @ zero))
    programmes(problem.count, problem.evaluate, start.tolist())
    assert np.abs(problem.errors(problem.best)).max() <= BOUNDS[0]
    assert not problem.departed()


def test_of_two_that_contradict_each_other_one_is_met_and_the_other_left_alone():
    """The first number moves both, one by 0.9 more than the other: 5 % of both cannot be had."""
    slopes = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    problem = Linear(slopes, np.array([0.5, 0.5]), np.zeros(2), 1.0)
    apart = np.array([0.0, 0.9, 0.0])
    plain = problem.errors
    problem.errors = lambda z: plain(z) - apart
    programmes(problem.count, problem.evaluate, [0.58, 0.8])
    errors = np.abs(problem.errors(problem.best))
    assert sorted(errors[:2] <= BOUNDS[0]) == [False, True]
    assert errors[2] <= BOUNDS[0]
