"""The points of a study: one row of values a sample, by grid, Latin hypercube or Sobol sequence.

The same seed gives the same points.
"""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Mapping, Sequence
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...effort import check_memory, duration_text
from ...errors import LandingError
from .factors import LARGEST, Array, Factor

# a value of a point: itself, its place in the unit cube, and what both are made of
BYTES_PER_VALUE = 24.0
# a short landing with its responses; 100,000 of 1 s took 8.2 ms each
LEAST_SECONDS = 1e-3


class Design:
    """Columns of values by quantity name, SI, one row a sample.

    A column is an array of floats, or of objects where it has texts.
    """

    def __init__(self, columns: Mapping[str, NDArray[Any]], count: int) -> None:
        self.columns = dict(columns)
        self.count = count

    def __len__(self) -> int:
        return self.count

    def rows(self, first: int, last: int) -> list[dict[str, Any]]:
        """Values by name of the samples from `first` up to, not including, `last`."""
        names = list(self.columns)
        parts = [self.columns[name][first:last].tolist() for name in names]
        return (
            [dict(zip(names, values)) for values in zip(*parts)]
            if names
            else [{} for _ in range(first, last)]
        )

    def digest(self) -> str:
        """The SHA-256 of every value."""
        fingerprint = hashlib.sha256(str(self.count).encode())
        for name, values in self.columns.items():
            fingerprint.update(name.encode())
            fingerprint.update(
                repr(values.tolist()).encode()
                if values.dtype == object
                else np.ascontiguousarray(values).tobytes()
            )
        return fingerprint.hexdigest()


def grid(factors: Sequence[Factor]) -> Design:
    """All combinations of the factors' levels; the last factor varies fastest.

    Raises:
        LandingError: A factor has no levels, or there are too many points.
    """
    count = prod(f.level_count() for f in factors)
    check_points(
        count, len(factors), "this grid", 'take fewer levels, or method = "sobol" or "lhs"'
    )
    levels = [f.levels() for f in factors]
    indices = (
        np.unravel_index(np.arange(count), [len(values) for values in levels]) if levels else ()
    )
    return Design({f.name: values[i] for f, values, i in zip(factors, levels, indices)}, count)


def check_points(
    count: int, columns: int, what: str, remedy: str = "take fewer samples or levels"
) -> None:
    """Refuse more points than a study may have, or than fit into memory.

    Args:
        count: The number of points.
        columns: The values of each.
        what: What has them, for the error.
        remedy: What to do.

    Raises:
        LandingError: They are too many.
    """
    if count > LARGEST:
        raise LandingError(
            f"{what} has {count:.12g} points, more than {LARGEST}, which would take "
            f"{duration_text(count * LEAST_SECONDS)} on one core at least; {remedy}"
        )
    check_memory(
        f"a study of {count} points in {columns} columns", BYTES_PER_VALUE * count * columns, remedy
    )


def drawn(factors: Sequence[Factor], method: str, count: int, seed: int) -> Design:
    """`count` samples of the factors by `lhs` or `sobol` (scrambled), by `scipy.stats.qmc`.

    Raises:
        LandingError: They need more memory than is free.
    """
    check_points(count, len(factors), "this study")
    points = unit_points(method, count, len(factors), seed)
    return Design({f.name: f.quantiles(points[:, i]) for i, f in enumerate(factors)}, count)


def unit_points(method: str, count: int, dimensions: int, seed: int) -> Array:
    """Points of the unit cube, (`count`, `dimensions`), by `lhs` or `sobol`."""
    from scipy.stats import qmc

    if not dimensions:
        return np.empty((count, 0))
    engine = (
        qmc.LatinHypercube(dimensions, seed=seed)
        if method == "lhs"
        else qmc.Sobol(dimensions, seed=seed)
    )
    with warnings.catch_warnings():
        # scipy warns where the count is no power of 2; `Study.notes` has the note for the user
        warnings.simplefilter("ignore", UserWarning)
        points: Array = engine.random(count)
    return points
