"""The number of scalars that miss their bounds, counted softly, so that it has slopes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...validation.paper import LEVELS

# a scalar's error [fraction of its scale] that counts as a misfit of one: below it, scalars are as
# good as reached
TOLERANCE = 0.045
BOUNDS = tuple(level / 100.0 for level in LEVELS)
# the cost of missing each bound; that of the widest is the largest, because there a feature of the
# curve is missed and not a digit
WORTH = (1.0, 2.0, 4.0)
# the cost of a condition's misfit of one, far above that of a scalar
CONDITION_PRICE = 30.0
# the departure from a condition below which its weight grows no further
NEAR_CONDITION = 0.05
# the part of Cauchy's loss that draws scalars far from every bound
FAR_PULL = 0.05
# the softness at which points are judged: almost the hard count
JUDGED = 0.005


@dataclass(frozen=True)
class SoftCount:
    """Counts the missed bounds in the misfits of an objective.

    Attributes:
        scalars: The number of scalars, whose misfits come first.
        conditions: The number of conditions, whose misfits come last.
        factors: The factors of the scalars' misfits and of their misses' cost; empty: all 1.
    """

    scalars: int
    conditions: int
    factors: tuple[float, ...] = ()

    def missed(self, misfits: NDArray[np.float64], softness: float = JUDGED) -> float:
        """The cost of the scalars that miss 5, 10 and 20 %, plus the conditions' penalty.

        A scalar of error e counts 1/(1 + exp((p - e)/(softness p))) at the bound p, times the
        bound's WORTH and the scalar's factor. A small part of Cauchy's loss draws far ones nearer.
        [derived]

        Args:
            misfits: The misfits, as `Objective.misfits`.
            softness: The width of a bound as a part of it.
        """
        factors, scalars, conditions = self.parts(misfits)
        missed = np.array(WORTH) @ _soft_misses(np.abs(scalars) * TOLERANCE, softness)
        counted = (factors * missed).sum()
        far = FAR_PULL * (factors * np.log1p(scalars**2)).sum()
        return float(counted + far + CONDITION_PRICE * conditions.sum())

    def weights(self, misfits: NDArray[np.float64], softness: float) -> NDArray[np.float64]:
        """The weights w with which sum(w misfit^2)/2 has the slope of `missed`.

        They are d missed/d|misfit| over |misfit|; 0 for curves, which are not counted. [derived]

        Args:
            misfits: The misfits, as `Objective.misfits`.
            softness: The width of a bound as a part of it.
        """
        factors, scalars, conditions = self.parts(misfits)
        sizes = np.maximum(np.abs(scalars), 1e-3)
        misses = _soft_misses(sizes * TOLERANCE, softness)
        worth = np.array(WORTH) / np.array(BOUNDS)
        slopes = worth @ (misses * (1.0 - misses)) * (TOLERANCE / softness)
        departed = conditions > 0.0
        priced = CONDITION_PRICE / np.maximum(conditions, NEAR_CONDITION)
        weights = np.zeros(len(misfits))
        # the misfit is the factor times the error's, and so is its cost
        pull = 2.0 * FAR_PULL / (1.0 + sizes**2)
        weights[: self.scalars] = (slopes / sizes + pull) / factors
        weights[len(misfits) - self.conditions :] = np.where(departed, priced, 0.0)
        return weights

    def parts(
        self, misfits: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """The scalars' factors, their misfits without these, and the conditions' misfits."""
        factors = np.array(self.factors) if self.factors else np.ones(self.scalars)
        scalars = misfits[: self.scalars] / factors
        return factors, scalars, misfits[len(misfits) - self.conditions :]


def _soft_misses(errors: NDArray[np.float64], softness: float) -> NDArray[np.float64]:
    """The soft misses of each bound (rows) by errors (columns, fractions)."""
    bounds = np.array(BOUNDS)[:, None]
    beyond = np.clip((bounds - errors) / (softness * bounds), -500.0, 500.0)
    found: NDArray[np.float64] = 1.0 / (1.0 + np.exp(beyond))
    return found
