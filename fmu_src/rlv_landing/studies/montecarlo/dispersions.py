"""The dispersed values of a Monte Carlo: run k of a seed depends on the two alone.

No run needs those before it. Every number is made element by element: it does not depend on which
runs are drawn together.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..sweep.design import Design
from ..sweep.factors import Array, Factor, column
from .covariance import Correlated

# random words beside those of the factors: the row of a table
TABLE_WORDS = 1


@dataclass(frozen=True)
class Table:
    """Samples in a table; `at_random` draws a row for each run, with replacement."""

    design: Design
    at_random: bool


@dataclass(frozen=True)
class Dispersions:
    """Everything that varies from run to run.

    Attributes:
        seed: The seed.
        factors: Quantities that vary by themselves.
        correlated: Those that are normal together.
        table: Samples.
    """

    seed: int
    factors: tuple[Factor, ...]
    correlated: Correlated | None = None
    table: Table | None = field(default=None)

    @property
    def names(self) -> list[str]:
        """The quantities, in the order of the columns."""
        correlated = self.correlated.names if self.correlated is not None else ()
        table = self.table.design.columns if self.table is not None else ()
        return [*table, *correlated, *(f.name for f in self.factors)]

    def columns(self, first: int, last: int) -> dict[str, NDArray[Any]]:
        """The values of the runs from `first` up to, not including, `last`, by name [SI]."""
        known = self.correlated.names if self.correlated is not None else ()
        words = TABLE_WORDS + len(known) + len(self.factors)
        u = unit_numbers(self.seed, first, last, words)
        found: dict[str, NDArray[Any]] = {}
        if self.table is not None:
            count = len(self.table.design)
            which = np.arange(first, last)
            if self.table.at_random:
                which = np.minimum((u[:, 0] * count).astype(int), count - 1)
            found.update({n: values[which] for n, values in self.table.design.columns.items()})
        if self.correlated is not None:
            normal = [_normal(u[:, TABLE_WORDS + i]) for i in range(len(known))]
            found.update(zip(known, self.correlated.values(normal)))
        for i, factor in enumerate(self.factors, TABLE_WORDS + len(known)):
            found[factor.name] = _quantiles(factor, np.ascontiguousarray(u[:, i]))
        return found

    def record(self) -> dict[str, Any]:
        """Everything that decides the values, for the fingerprint."""
        c, t = self.correlated, self.table
        return {
            "seed": self.seed,
            "factors": [f.record() for f in self.factors],
            "covariance": None
            if c is None
            else {"names": c.names, "mean": c.mean, "matrix": c.matrix},
            "table": None if t is None else {"rows": t.design.digest(), "at_random": t.at_random},
        }


class Runs(Design):
    """The runs of dispersions as the points of a study, as many as `count`, which may grow."""

    def __init__(self, dispersions: Dispersions, count: int) -> None:
        self.dispersions = dispersions
        # of a column its possible values, where they are few
        of_choice = {f.name: column(f.values) for f in dispersions.factors if f.values}
        table = dispersions.table.design.columns if dispersions.table is not None else {}
        super().__init__(
            {n: of_choice.get(n, table.get(n, np.empty(0))) for n in dispersions.names}, count
        )

    def rows(self, first: int, last: int) -> list[dict[str, Any]]:
        """Values by name of the runs from `first` up to, not including, `last`."""
        found = self.dispersions.columns(first, last)
        if not found:
            return [{} for _ in range(first, last)]
        lists = [values.tolist() for values in found.values()]
        return [dict(zip(found, values)) for values in zip(*lists)]

    def digest(self) -> str:
        """The SHA-256 of everything that decides the points, their number apart."""
        return hashlib.sha256(repr(self.dispersions.record()).encode()).hexdigest()


def unit_numbers(seed: int, first: int, last: int, count: int) -> Array:
    """Random numbers above 0 and below 1, so many for each run: (last - first, count).

    numpy's SeedSequence of the seed and the run's number, whose words numpy keeps the same. The
    first numbers of a run are the same for any `count`.
    """
    words = np.empty((last - first, count), dtype=np.uint64)
    for k in range(first, last):
        sequence = np.random.SeedSequence(seed, spawn_key=(k,))
        words[k - first] = sequence.generate_state(count, np.uint64)
    numbers: Array = ((words >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53
    return numbers


def _normal(u: Array) -> Array:
    from scipy.special import ndtri

    found: Array = ndtri(np.ascontiguousarray(u))
    return found


def _quantiles(factor: Factor, u: Array) -> NDArray[Any]:
    """The quantiles of a factor at `u`, each by itself."""
    if factor.distribution != "normal":
        return factor.quantiles(u)
    from scipy.special import ndtr, ndtri

    low = (factor.low - factor.mean) / factor.deviation
    high = (factor.high - factor.mean) / factor.deviation
    # above the mean the upper tail has the digits
    turned = low > 0.0
    a, b = (-high, -low) if turned else (low, high)
    below, above = ndtr(a), ndtr(b)
    z = ndtri(below + (1.0 - u if turned else u) * (above - below))
    drawn = factor.mean + factor.deviation * (-z if turned else z)
    return np.clip(drawn, factor.low, factor.high)
