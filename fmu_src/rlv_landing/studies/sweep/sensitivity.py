"""Sobol indices of a study's responses: each factor's part of their variance.

First-order indices count a factor alone, total indices with all others. The points are Saltelli's:
two independent samples A and B of all factors, and for each factor a copy of A with B's column of
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import LandingError, unknown
from .design import Design, check_points, unit_points
from .factors import Array
from .parts import opened
from .responses import known_responses
from .study import Study

LEVEL = 0.95
RESAMPLES = 999
LEAST_WHOLE = 0.9
# an index lies between 0 and 1: an interval wider than half of that decides nothing
WIDEST = 0.5
# samples that are drawn at once for the bootstrap; their number changes no result
BATCH = 1_000_000
# a response that varies by less than this part of its largest value varies by round-off
ROUND_OFF = 1e-12


@dataclass(frozen=True)
class Indices:
    """Sobol indices of one response over the landings of one mode.

    All indices are NaN where more than a tenth of the samples lack the response, or it does not
    vary.

    Attributes:
        response: The response's name.
        mode: The landing mode, or `all`.
        factors: The factors' names.
        first: First-order indices with their intervals, (factors, 3): index, low, high.
        total: Total indices with their intervals, (factors, 3).
        used: Samples that have the response in all their landings; one of these, drawn at random,
            replaces each other sample.
        samples: All samples.
    """

    response: str
    mode: str
    factors: tuple[str, ...]
    first: Array
    total: Array
    used: int
    samples: int

    @property
    def reason(self) -> str:
        """Reason why there are no indices; empty where there are."""
        if not np.isnan(self.total).any():
            return ""
        if self.used < LEAST_WHOLE * self.samples:
            return f"{self.used} of {self.samples} samples have it"
        return "it does not vary"

    def enough(self, factor: int) -> bool:
        """Whether the samples suffice for the indices of the factor at this place.

        They do not where an interval is wider than 0.5 or lies outside 0 to 1.
        """
        return all(
            high - low <= WIDEST and low <= 1.0 and high >= 0.0
            for _, low, high in (self.first[factor], self.total[factor])
        )

    def record(self) -> dict[str, Any]:
        """The same for JSON; null for NaN."""

        def plain(index: Array) -> dict[str, float | None]:
            return {
                key: None if np.isnan(v) else float(v)
                for key, v in zip(("index", "low", "high"), index)
            }

        indices = [
            {"factor": f, "first": plain(a), "total": plain(b), "enough_samples": self.enough(k)}
            for k, (f, a, b) in enumerate(zip(self.factors, self.first, self.total))
        ]
        return {
            "response": self.response,
            "mode": self.mode,
            "used": self.used,
            "samples": self.samples,
            "reason": self.reason,
            "indices": indices,
        }


def sobol_design(study: Study) -> Design:
    """The points of `study.samples` (a power of 2) samples, as blocks of rows.

    The blocks are A, then B, then for each factor A with B's column of it.

    Raises:
        LandingError: The study is a table, has fewer than two factors, its samples are no power of
            2, or there are too many points.
    """
    if study.method == "table":
        raise LandingError(
            "the columns of a table are not independent of each other, which Sobol indices need; "
            "give factors with ranges"
        )
    if len(study.factors) < 2:
        raise LandingError(
            "Sobol indices divide variance between factors; the study needs two [[factor]] or more"
        )
    n = study.samples
    if n < 2 or n & (n - 1):
        found = f"this {study.method} has samples = {n}" if n else f"a {study.method} has none"
        raise LandingError(
            "Sobol indices need samples = a power of 2, for example 256 or 1024, "
            f'with method = "sobol" or "lhs"; {found}'
        )
    blocks = len(study.factors) + 2
    check_points(n * blocks, len(study.factors), "this study")
    points = unit_points("sobol", n, 2 * len(study.factors), study.seed)
    a, b = (
        [f.quantiles(half[:, i]) for i, f in enumerate(study.factors)]
        for half in np.hsplit(points, 2)
    )
    columns = {}
    for i, f in enumerate(study.factors):
        parts = [a[i]] * blocks
        parts[1] = parts[2 + i] = b[i]
        columns[f.name] = np.concatenate(parts)
    return Design(columns, n * blocks)


def sobol_indices(
    pages: Array, seed: int, level: float = LEVEL, resamples: int = RESAMPLES
) -> tuple[Array, Array]:
    """First-order and total indices with their bootstrap intervals.

    By `scipy.stats`: Saltelli's estimators (2010), percentile intervals.

    Args:
        pages: Responses in the order of `sobol_design`, (factors + 2, responses, samples).
        seed: Seed of the bootstrap.
        level: Confidence of the intervals.
        resamples: Bootstrap resamples.

    Returns:
        Both as (responses, factors, 3): index, low, high; NaN for a response that does not vary.
    """
    from scipy.stats import bootstrap
    from scipy.stats import sobol_indices as estimate

    factors, responses, n = pages.shape[0] - 2, pages.shape[1], pages.shape[2]

    def both(which: NDArray[np.intp]) -> Array:
        values: Any = {
            "f_A": pages[0][:, which],
            "f_B": pages[1][:, which],
            "f_AB": pages[2:][:, :, which],
        }
        found = estimate(func=values, n=n)
        return np.array(
            [
                np.reshape(order, (responses, factors))
                for order in (found.first_order, found.total_order)
            ]
        )

    resampled: Any = bootstrap(
        (np.arange(n),),
        both,
        vectorized=False,
        method="percentile",
        confidence_level=level,
        n_resamples=resamples,
        batch=max(1, BATCH // n),
        random_state=np.random.default_rng(seed),
    )
    interval = resampled.confidence_interval
    indices = np.stack([both(np.arange(n)), interval.low, interval.high], axis=-1)
    spread, largest = np.ptp(pages, axis=(0, 2)), np.abs(pages).max(axis=(0, 2))
    indices[:, spread <= ROUND_OFF * largest] = np.nan
    return indices[0], indices[1]


def indices_of(
    path: Path,
    study: Study,
    responses: Sequence[str],
    level: float = LEVEL,
    resamples: int = RESAMPLES,
) -> list[Indices]:
    """Indices of responses, mode by mode, from a results file made of `sobol_design`.

    Args:
        path: The results file.
        study: The study that it was made of.
        responses: Names of responses that are numbers.
        level: Confidence of the intervals.
        resamples: Bootstrap resamples.

    Raises:
        LandingError: The file is damaged.
    """
    modes = study.modes or ("all",)
    names = tuple(f.name for f in study.factors)
    with opened(path) as file:
        table = file.read(columns=list(responses))
    found: list[Indices] = []
    for i, mode in enumerate(modes):
        filled = [
            _filled(
                table[r].to_numpy()[i :: len(modes)].astype(float).reshape(len(names) + 2, -1),
                study.seed,
            )
            for r in responses
        ]
        first, total = sobol_indices(
            np.stack([pages for pages, _ in filled], axis=1), study.seed, level, resamples
        )
        for k, (response, (pages, used)) in enumerate(zip(responses, filled)):
            found.append(Indices(response, mode, names, first[k], total[k], used, pages.shape[1]))
    return found


def _filled(pages: Array, seed: int) -> tuple[Array, int]:
    """The responses (factors + 2, samples) without gaps, and the number of complete samples.

    Incomplete samples are replaced by complete ones. All values are 0 where too few are complete.
    """
    whole = np.flatnonzero(np.isfinite(pages).all(axis=0))
    n = pages.shape[1]
    if len(whole) < LEAST_WHOLE * n:
        return np.zeros_like(pages), len(whole)
    which = np.arange(n)
    missing = np.setdiff1d(which, whole)
    which[missing] = np.random.default_rng(seed).choice(whole, len(missing))
    return pages[:, which], len(whole)


def numeric_responses(study: Study, wanted: Sequence[str]) -> tuple[str, ...]:
    """The responses whose variance is divided: those of `wanted`, if any.

    Else they are the study's responses of the whole vehicle, or, where there are none, all that are
    numbers.

    Raises:
        LandingError: A response is not the study's (the message names the nearest) or is a text, or
            there is no response that is a number.
    """
    known = known_responses(study.interface)
    for name in wanted:
        if name not in study.responses:
            raise unknown("response of this study", name, study.responses)
        if known[name].kind == "string":
            raise LandingError(
                f"{name} is a text; Sobol indices are of numbers: take one of its margins"
            )
    numbers = _numbers(study)
    whole = [
        name for name in numbers if not name.startswith(("leg[", "outcome.", "energy.balance"))
    ]
    if not numbers:
        raise LandingError("this study takes no response that is a number; add one to responses")
    return tuple(wanted or whole or numbers)


def left_out(study: Study, wanted: Sequence[str]) -> list[str]:
    """The study's responses that are numbers and not `wanted`."""
    return [name for name in _numbers(study) if name not in wanted]


def _numbers(study: Study) -> list[str]:
    known = known_responses(study.interface)
    return [name for name in study.responses if known[name].kind == "real"]
