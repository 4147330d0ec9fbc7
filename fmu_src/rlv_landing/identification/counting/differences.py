"""Derivatives of the misfits by differences, whose points count as tries too."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
# the misfits at points of the unit cube, tried side by side
Evaluate = Callable[[Sequence[Sequence[float]]], list[Vector]]


def differences(
    evaluate: Evaluate, z: Vector, misfits: Vector, difference: float
) -> tuple[list[tuple[Vector, Vector]], Vector]:
    """One-sided differences towards the cube's middle.

    Args:
        evaluate: Gives the misfits at points.
        z: The point, shape (n,), on the unit cube.
        misfits: The misfits there, shape (m,).
        difference: The size of the moves.

    Returns:
        Each point aside with its misfits, and the derivatives, shape (m, n).
    """
    moves = np.where(z > 0.5, -difference, difference)
    aside = [z + move * unit for move, unit in zip(moves, np.eye(len(z)))]
    found = evaluate([p.tolist() for p in aside])
    slopes = np.array([(m - misfits) / move for m, move in zip(found, moves)]).T
    return list(zip(aside, found)), slopes
