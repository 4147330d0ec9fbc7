"""A search for the fewest missed bounds: Gauss-Newton steps on the softly counted misses, round by round from the best point, kicked about.

The count of scalars within 5, 10 and 20 % has steps, not slopes. Counted softly (`Objective.missed`) it has both; as the softness falls
from round about the bounds' own size to a small part of it, the soft count turns into the hard one, and scalars that nothing can mend
are left alone. Iteratively reweighted least squares (Levenberg-Marquardt's damping, bounds by an active set) make it small: a step
costs one landing for each free number and a few for the dampings, tried side by side.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from .objective import Objective

Vector = NDArray[np.float64]

SOFTNESSES = (0.6, 0.4, 0.25, 0.15, 0.1, 0.05)
# the softness at which points are judged
JUDGED = SOFTNESSES[-1]
# standard deviations on the unit cube, round by round
KICKS = (0.0, 0.02, 0.04, 0.02, 0.08)
DAMPINGS = tuple(10.0 ** (0.5 * k) for k in range(-3, 8))
# difference for the Jacobian, and largest step, on the unit cube
DIFFERENCE, LARGEST_STEP = 4e-3, 0.2
# slopes of more misfit than this across the cube are those of an event that comes or goes
STEEPEST = 300.0
GAIN, LARGE_GAIN = 0.02, 0.1
# a start inside the cube's faces, so that both directions are open
MARGIN = 2e-3

Evaluate = Callable[[Sequence[Sequence[float]]], list[Vector]]


def count_round(objective: Objective, evaluate: Evaluate, start: Sequence[float], seed: Sequence[int], kick: float) -> None:
    """One round from `start` [free numbers, on the unit cube], kicked by a normal deviate of `kick` (seeded): falling softness, and at
    each as many steps as help. `evaluate` is handed all points that are tried, side by side, and keeps the best."""
    z = np.asarray(start, dtype=float)
    if kick > 0.0:
        z = np.clip(z + np.random.default_rng(seed).normal(0.0, kick, len(z)), MARGIN, 1.0 - MARGIN)
    (misfits,) = evaluate([z.tolist()])
    for softness in SOFTNESSES:
        stalled = 0
        while stalled < 2:
            before = objective.missed(misfits, softness)
            z, misfits = descend(objective, evaluate, z, misfits, softness, DIFFERENCE / (1.0 + stalled))
            stalled = 0 if objective.missed(misfits, softness) < before - LARGE_GAIN else stalled + 1


def descend(
    objective: Objective, evaluate: Evaluate, z: Vector, misfits: Vector, softness: float, difference: float
) -> tuple[Vector, Vector]:
    """Where damped steps by one Jacobian lead from `z`, and the misfits there; `z` itself if none helps.

    The Jacobian is taken by differences, whose points are tried as steps too, and goes on by Broyden's rank-one update while steps help.
    """
    moves = np.where(z > 0.5, -difference, difference)
    aside = [z + move * unit for move, unit in zip(moves, np.eye(len(z)))]
    found = evaluate([p.tolist() for p in aside])
    jacobian = np.clip([(m - misfits) / move for m, move in zip(found, moves)], -STEEPEST, STEEPEST).T
    others = list(zip(aside, found))
    while True:
        steps = damped_points(z, misfits, jacobian, objective.pulls(misfits, softness))
        tried = [*others, *zip(steps, evaluate([p.tolist() for p in steps]))]
        z_best, misfits_best = min(tried, key=lambda point: objective.missed(point[1], softness))
        if objective.missed(misfits_best, softness) >= objective.missed(misfits, softness) - GAIN:
            return z, misfits
        step = z_best - z
        jacobian = jacobian + np.outer(misfits_best - misfits - jacobian @ step, step) / (step @ step)
        z, misfits, others = z_best, misfits_best, []


def damped_points(z: Vector, misfits: Vector, jacobian: Vector, weights: Vector) -> list[Vector]:
    """Where the weighted Gauss-Newton step leads from `z`, for each of DAMPINGS; numbers that would leave the cube stop at its face."""
    curvature = (jacobian.T * weights) @ jacobian
    slope = (jacobian.T * weights) @ misfits
    return [np.clip(z + _step(z, curvature + damping * np.eye(len(z)), slope), 0.0, 1.0) for damping in DAMPINGS]


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
