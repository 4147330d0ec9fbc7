"""A search for the fewest missed bounds: Gauss-Newton steps on the softly counted misses.

The count of scalars within 5, 10 and 20 % has steps, not slopes. Counted softly (`SoftCount`) it
has both. The softness falls from about the bounds' own size to a small part of it; so the soft
count becomes the hard one, and scalars that no step improves are left alone. Iteratively reweighted
least squares make it small, with Levenberg-Marquardt's damping and the cube's faces by an active
set. A step costs one landing for each free number and a few for the dampings, tried side by side.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .differences import Evaluate, Vector, differences
from .soft_count import SoftCount

SOFTNESSES = (0.6, 0.4, 0.25, 0.15, 0.1, 0.05)
# standard deviations of the rounds' random first steps, on the unit cube
SPREADS = (0.0, 0.02, 0.04, 0.02, 0.08)
DAMPINGS = tuple(10.0 ** (0.5 * k) for k in range(-3, 8))
# difference for the Jacobian, and largest step, on the unit cube
DIFFERENCE, LARGEST_STEP = 4e-3, 0.2
# slopes of more misfit than this across the cube are those of an event that comes or goes
STEEPEST = 300.0
# falls of the misses that make another step, and a further series of steps, worth while
GAIN, LARGE_GAIN = 0.02, 0.1
# a start inside the cube's faces, so that both directions are open
MARGIN = 2e-3


def count_round(
    soft_count: SoftCount,
    evaluate: Evaluate,
    start: Sequence[float],
    seed: Sequence[int],
    spread: float,
) -> None:
    """One round of the search: falling softness, and at each as many steps as help.

    Args:
        soft_count: What is made small.
        evaluate: Gets all points that are tried, and keeps the best.
        start: The point at which the round begins, on the unit cube.
        seed: Seed of the random first step.
        spread: Its standard deviation along each number, on the cube; 0 for no such step.
    """
    z = np.asarray(start, dtype=float)
    if spread > 0.0:
        moved = z + np.random.default_rng(seed).normal(0.0, spread, len(z))
        z = np.clip(moved, MARGIN, 1.0 - MARGIN)
    (misfits,) = evaluate([z.tolist()])
    for softness in SOFTNESSES:
        stalled = 0
        while stalled < 2:
            before = soft_count.missed(misfits, softness)
            difference = DIFFERENCE / (1.0 + stalled)
            z, misfits = _descend(soft_count, evaluate, (z, misfits), softness, difference)
            gained = before - soft_count.missed(misfits, softness)
            stalled = 0 if gained > LARGE_GAIN else stalled + 1


def _descend(
    soft_count: SoftCount,
    evaluate: Evaluate,
    start: tuple[Vector, Vector],
    softness: float,
    difference: float,
) -> tuple[Vector, Vector]:
    """The point to which damped steps by one Jacobian lead from `start`, and the misfits there.

    It is `start` itself if no step helps. The Jacobian is taken by differences, whose points are
    tried as steps too. While steps help, Broyden's rank-one update changes it.
    """
    z, misfits = start
    others, slopes = differences(evaluate, z, misfits, difference)
    jacobian = np.clip(slopes, -STEEPEST, STEEPEST)
    while True:
        steps = damped_points(z, misfits, jacobian, soft_count.weights(misfits, softness))
        tried = [*others, *zip(steps, evaluate([p.tolist() for p in steps]))]
        z_best, best = min(tried, key=lambda point: soft_count.missed(point[1], softness))
        if soft_count.missed(best, softness) >= soft_count.missed(misfits, softness) - GAIN:
            return z, misfits
        step = z_best - z
        jacobian = jacobian + np.outer(best - misfits - jacobian @ step, step) / (step @ step)
        z, misfits, others = z_best, best, []


def damped_points(z: Vector, misfits: Vector, jacobian: Vector, weights: Vector) -> list[Vector]:
    """The points to which the weighted Gauss-Newton step leads, one for each of DAMPINGS.

    Numbers that would leave the unit cube stop at its face.

    Args:
        z: The point, shape (n,), on the unit cube.
        misfits: The misfits there, shape (m,).
        jacobian: Their derivatives by `z`, shape (m, n).
        weights: Their weights, shape (m,).
    """
    curvature = (jacobian.T * weights) @ jacobian
    slope = (jacobian.T * weights) @ misfits
    return [
        np.clip(z + _step(z, curvature + damping * np.eye(len(z)), slope), 0.0, 1.0)
        for damping in DAMPINGS
    ]


def _step(z: Vector, curvature: Vector, slope: Vector) -> Vector:
    step: Vector = np.asarray(-np.linalg.solve(curvature, slope), dtype=np.float64)
    at_face = (z + step < 0.0) | (z + step > 1.0)
    free = ~at_face
    if at_face.any() and free.any():
        step[at_face] = np.clip(z + step, 0.0, 1.0)[at_face] - z[at_face]
        known = curvature[np.ix_(free, at_face)] @ step[at_face]
        step[free] = -np.linalg.solve(curvature[np.ix_(free, free)], slope[free] + known)
    longest = float(np.abs(step).max())
    return step * min(1.0, LARGEST_STEP / longest) if longest > 0.0 else step
