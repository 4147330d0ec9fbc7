"""A series of linear programmes, whose steps meet bounds that are missed by little.

Near a point the misfits are linear. A step that makes the weighted sum of the excesses over all
bounds small is a linear programme. Such sums are made small by few large excesses and many that
are zero; so a bound is met exactly, and others are not moved further inside than they need. The
weights fall with the excess (iterative reweighting), so that what is far beyond its bound is left
alone. [derived]
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .differences import Evaluate, Vector, differences
from .soft_count import BOUNDS, CONDITION_PRICE, TOLERANCE, WORTH, SoftCount

# excesses [part of the bound] at which the cost bends: first those far out count, then near ones
BENDS = (0.3, 0.1, 0.04)
# errors are taken this far inside their bounds, against what the linear misfits leave out
INSIDE = 1.5e-3
# largest steps along each number, on the unit cube, tried side by side
REGIONS = (0.1, 0.04, 0.016, 0.006)
# cost of a step by one along a number, so that numbers which improve nothing stay
STEP_PRICE = 0.02
DIFFERENCES = (4e-3, 2e-3)
# slopes of more error than this across the cube are those of an event that comes or goes
STEEPEST = 15.0
GAIN = 3e-3


def programmes(soft_count: SoftCount, evaluate: Evaluate, start: Sequence[float]) -> None:
    """Linear programmes from `start` on, for each of BENDS until none helps.

    Args:
        soft_count: What is counted.
        evaluate: Gets all points that are tried, and keeps the best.
        start: The point at which they begin, on the unit cube.
    """
    z = np.asarray(start, dtype=float)
    (misfits,) = evaluate([z.tolist()])
    for bend in BENDS:
        for difference in DIFFERENCES:
            gained = True
            while gained:
                before = _cost(soft_count, misfits, bend)
                z, misfits = _step(soft_count, evaluate, (z, misfits), bend, difference)
                gained = _cost(soft_count, misfits, bend) < before - GAIN


def _excesses(errors: Vector) -> Vector:
    """By how much each error (rows) is beyond each bound (columns), less INSIDE."""
    return np.maximum(0.0, np.abs(errors)[:, None] - (np.array(BOUNDS) - INSIDE))


def _cost(soft_count: SoftCount, misfits: Vector, bend: float) -> float:
    factors, scalars, conditions = soft_count.parts(misfits)
    beyond = _excesses(scalars * TOLERANCE) / (bend * np.array(BOUNDS))
    worth = np.outer(factors, WORTH)
    counted = (worth * np.log1p(beyond)).sum() / np.log1p(1.0 / bend)
    return float(counted + CONDITION_PRICE * conditions.sum())


def _step(
    soft_count: SoftCount,
    evaluate: Evaluate,
    start: tuple[Vector, Vector],
    bend: float,
    difference: float,
) -> tuple[Vector, Vector]:
    """The best point of one programme's steps, or of the differences; `start` if none is better."""
    z, misfits = start
    aside, slopes = differences(evaluate, z, misfits, difference)
    steps = [
        np.clip(z + _solution(soft_count, z, misfits, slopes, bend, region), 0.0, 1.0)
        for region in REGIONS
    ]
    tried = [start, *aside, *zip(steps, evaluate([p.tolist() for p in steps]))]
    return min(tried, key=lambda point: _cost(soft_count, point[1], bend))


def _solution(
    soft_count: SoftCount, z: Vector, misfits: Vector, slopes: Vector, bend: float, region: float
) -> Vector:
    """The step within `region` that costs least where the misfits are linear.

    Unknown are the step, its size along each number, and an excess for each error and bound and
    for each condition that is not met.

    Args:
        soft_count: What is counted.
        z: The point, shape (n,).
        misfits: The misfits there, shape (m,).
        slopes: Their derivatives by `z`, shape (m, n).
        bend: As in BENDS.
        region: As in REGIONS.
    """
    from scipy.optimize import linprog

    factors, scalars, conditions = soft_count.parts(misfits)
    errors, n, bounds = scalars * TOLERANCE, len(z), np.array(BOUNDS)
    unmet = np.flatnonzero(conditions > 0.0)
    count, k = len(bounds) * len(errors), len(unmet)
    worth = np.outer(factors, WORTH)
    weights = worth / (_excesses(errors) + bend * bounds) / np.log1p(1.0 / bend)
    price = [np.zeros(n), np.full(n, STEP_PRICE), weights.T.ravel(), np.full(k, CONDITION_PRICE)]
    own = slopes[: len(errors)] / factors[:, None]
    of_errors = np.clip(own * TOLERANCE, -STEEPEST, STEEPEST)
    every = np.tile(of_errors, (len(bounds), 1))
    none, size, excess = np.zeros((count, n)), np.identity(n), np.identity(count)
    matrix = np.block(
        [
            [every, none, -excess, np.zeros((count, k))],
            [-every, none, -excess, np.zeros((count, k))],
            [size, -size, np.zeros((n, count + k))],
            [-size, -size, np.zeros((n, count + k))],
            [
                slopes[len(misfits) - len(conditions) :][unmet],
                np.zeros((k, n + count)),
                -np.identity(k),
            ],
        ]
    )
    inside, far = np.repeat(bounds - INSIDE, len(errors)), np.tile(errors, len(bounds))
    limits = [inside - far, inside + far, np.zeros(2 * n), -conditions[unmet]]
    step = [(max(-region, -x), min(region, 1.0 - x)) for x in z]
    free = [(0.0, None)] * (n + count + k)
    found = linprog(
        np.concatenate(price), matrix, np.concatenate(limits), bounds=step + free, method="highs"
    )
    return np.zeros(n) if found.x is None else np.asarray(found.x[:n])
