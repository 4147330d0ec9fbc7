"""The determination of each free number by the misfits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .free_numbers import folded
from .identify import Search
from .priors import quantity

AT_BOUND = 0.01
# the standard deviation of a uniform prior on [0, 1]: a number not known better than that is not
# identified
UNINFORMED = 12.0**-0.5
WELL, POORLY = 0.05, 0.15


@dataclass(frozen=True)
class Determination:
    """The determination of one number by the misfits.

    Attributes:
        label: The number.
        value: Its value, SI.
        unit: Its unit.
        lo: Its lower bound, SI.
        hi: Its upper bound, SI.
        z: Its place between the bounds, in [0, 1].
        deviation: Its posterior standard deviation, as a part of the bounds' width.
        partner: The number that moves with it most.
        correlation: The correlation with that.
        scalar: The misfit that depends on it most.
    """

    label: str
    value: float
    unit: str
    lo: float
    hi: float
    z: float
    deviation: float
    partner: str
    correlation: float
    scalar: str

    @property
    def verdict(self) -> str:
        """The verdict in words."""
        if self.z < AT_BOUND or self.z > 1.0 - AT_BOUND:
            return "at its bound"
        if self.deviation > 0.8 * UNINFORMED:
            return "not identifiable"
        if self.deviation < WELL:
            return "well determined"
        return "determined" if self.deviation < POORLY else "poorly determined"


def determinations(search: Search) -> list[Determination]:
    """The determination of every free number, from the Jacobian at the best point.

    The covariance on the unit cube is (J'J/s2 + prior)^-1 with the weights of Cauchy's loss; s2 is
    1, or the mean weighted misfit squared where that is larger. It is a Gaussian approximation,
    valid near the point only. [derived]
    """
    z = folded(search.best.z)
    (misfits,) = search.evaluate_uncounted([z.tolist()])
    jacobian = search.jacobian(z)
    weights = 1.0 / (1.0 + misfits**2)
    spread = max(1.0, float((weights * misfits**2).sum() / weights.sum()))
    information = (jacobian.T * weights) @ jacobian / spread + np.eye(len(z)) / UNINFORMED**2
    covariance = np.linalg.inv(information)
    deviation = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(deviation, deviation)
    np.fill_diagonal(correlation, 0.0)
    free, labels = search.objective.free, search.objective.free.labels
    strongest = np.argmax(np.abs(jacobian) * np.sqrt(weights)[:, None], axis=0)
    found = []
    for i, ((prior, _), value) in enumerate(zip(free.columns, free.numbers(z.tolist()))):
        j = int(np.argmax(np.abs(correlation[i])))
        found.append(
            Determination(
                labels[i],
                value,
                quantity(prior.name).unit,
                prior.lo,
                prior.hi,
                z=float(z[i]),
                deviation=float(deviation[i]),
                partner=labels[j],
                correlation=float(correlation[i, j]),
                scalar=search.objective.labels[int(strongest[i])],
            )
        )
    return found
