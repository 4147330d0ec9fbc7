"""Quantities that are normal together: their covariance, read and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

from ...errors import LandingError
from ...parameters import check_value
from ...text.values import to_si
from .. import toml_keys
from ..sweep.factors import Array
from ..variables import variable

# an eigenvalue of correlations that is above this below 0 is one of round-off
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Correlated:
    """Quantities that are normal together; all numbers in SI.

    Attributes:
        names: The quantities.
        mean: Their means.
        matrix: Their covariance, by rows.

    Raises:
        LandingError: The matrix is not symmetric, or not positive semi-definite.
    """

    names: tuple[str, ...]
    mean: tuple[float, ...]
    matrix: tuple[tuple[float, ...], ...]

    def __post_init__(self) -> None:
        _check_covariance(self.names, np.array(self.matrix))

    @property
    def root(self) -> list[list[float]]:
        """The lower triangular L with L L' the covariance, by Cholesky; rows of 0 where it is 0."""
        a, n = self.matrix, len(self.names)
        low = [[0.0] * n for _ in range(n)]
        for i in range(n):
            for j in range(i + 1):
                rest = a[i][j] - sum(low[i][k] * low[j][k] for k in range(j))
                if i == j:
                    low[i][i] = sqrt(rest) if rest > ROUND_OFF * a[i][i] else 0.0
                elif low[j][j] > 0.0:
                    low[i][j] = rest / low[j][j]
        return low

    def values(self, normal: Sequence[Array]) -> list[Array]:
        """The values, from independent standard normal ones of each quantity."""
        found = []
        for mean, row in zip(self.mean, self.root):
            value = np.full_like(normal[0], mean)
            for part, z in zip(row, normal):
                value = value + part * z
            found.append(value)
        return found


def _check_covariance(names: Sequence[str], a: Array) -> None:
    size = np.sqrt(np.abs(np.diag(a)))
    for i, name in enumerate(names):
        if not a[i, i] >= 0.0:
            raise LandingError(f"covariance: the variance of {name} is {a[i, i]:g}, below 0")
        for j, other in enumerate(names[:i]):
            if abs(a[i, j] - a[j, i]) > ROUND_OFF * (abs(a[i, j]) + abs(a[j, i])):
                raise LandingError(
                    f"covariance of {name} and {other} is {a[i, j]:g} in one place and {a[j, i]:g} "
                    "in the other; it must be symmetric"
                )
    scale = np.where(size > 0.0, size, 1.0)
    correlation = a / np.outer(scale, scale)
    least = float(np.linalg.eigvalsh(correlation).min()) if len(names) else 0.0
    if least < -ROUND_OFF * len(names):
        i, j = divmod(int(np.argmax(np.abs(np.tril(correlation, -1)))), len(names))
        raise LandingError(
            "the covariance is not positive semi-definite: its correlations have an eigenvalue of "
            f"{least:.3g}, which must be 0 or more; the strongest is {correlation[i, j]:.3g}, of "
            f"{names[i]} and {names[j]}: it must be from -1 to 1, and fit the others"
        )


def read_correlated(keys: Mapping[str, Any]) -> Correlated | None:
    """The quantities of [covariance], numbers in SI.

    Raises:
        LandingError: Unknown keys or names, lists of the wrong length, means out of bounds, or a
            covariance that is none.
    """
    if not keys:
        return None
    known = ("names", "units", "mean", "matrix", "deviation", "correlation")
    toml_keys.refuse_unknown(keys, known, "key of [covariance]")
    names = toml_keys.texts(keys, "names")
    if names is None:
        raise LandingError('[covariance] has no names; write names = ["drop.tilt", "drop.roll"]')
    quantities = [variable(name, "quantity in [covariance]") for name in names]
    for q in quantities:
        if q.choices:
            raise LandingError(f"{q.name} is one of {', '.join(q.choices)}; make it a [[factor]]")
    units = keys.get("units", [""] * len(names))
    if not isinstance(units, list) or not all(isinstance(u, str) for u in units):
        raise LandingError(f"[covariance] units = {units!r} must be a list of texts")
    _check_length("units", units, names)
    mean = _vector(keys, "mean", names)
    sizes = [to_si(q, 1.0, u) - to_si(q, 0.0, u) for q, u in zip(quantities, units)]
    values = tuple(
        float(check_value(q, to_si(q, v, u))) for q, v, u in zip(quantities, mean, units)
    )
    given = tuple(key in keys for key in ("matrix", "deviation", "correlation"))
    if given not in ((True, False, False), (False, True, True)):
        raise LandingError("[covariance] needs matrix, or deviation and correlation; give one")
    if "matrix" in keys:
        matrix = _square(keys, "matrix", names)
    else:
        deviation, matrix = _vector(keys, "deviation", names), _square(keys, "correlation", names)
        _check_deviation(names, deviation, matrix)
        matrix = [[a * x * y for y, a in zip(deviation, row)] for x, row in zip(deviation, matrix)]
    rows = tuple(tuple(a * x * y for y, a in zip(sizes, row)) for x, row in zip(sizes, matrix))
    return Correlated(tuple(names), values, rows)


def _check_deviation(
    names: Sequence[str], deviation: Sequence[float], correlation: Sequence[Sequence[float]]
) -> None:
    for i, (name, value) in enumerate(zip(names, deviation)):
        if value < 0.0:
            raise LandingError(f"[covariance] deviation of {name} = {value:g} is below 0")
        if correlation[i][i] != 1.0:
            raise LandingError(
                f"[covariance] correlation of {name} with itself = {correlation[i][i]:g} must be 1"
            )


def _vector(keys: Mapping[str, Any], key: str, names: Sequence[str]) -> list[float]:
    values = keys.get(key)
    if not isinstance(values, list) or not all(_is_finite(v) for v in values):
        raise LandingError(f"[covariance] {key} = {values!r} must be a list of numbers")
    _check_length(key, values, names)
    return [float(v) for v in values]


def _square(keys: Mapping[str, Any], key: str, names: Sequence[str]) -> list[list[float]]:
    rows = keys.get(key)
    if not isinstance(rows, list):
        raise LandingError(f"[covariance] {key} = {rows!r} must be a list of rows")
    _check_length(f"rows of {key}", rows, names)
    return [_vector({f"row {i + 1} of {key}": row}, f"row {i + 1} of {key}", names)
            for i, row in enumerate(rows)]  # fmt: skip


def _check_length(key: str, values: Sequence[Any], names: Sequence[str]) -> None:
    if len(values) != len(names):
        raise LandingError(
            f"[covariance] {key}: {len(values)} for {len(names)} names; give one for each"
        )


def _is_finite(value: Any) -> bool:
    return (
        isinstance(value, (int, float)) and not isinstance(value, bool) and bool(np.isfinite(value))
    )
