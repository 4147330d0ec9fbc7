"""The global search: CMA-ES on the unit cube, with a state that is plain numbers.

The state is what the search began with and the losses that it was given, generation by generation.
CMA-ES is a function of these, so that a search is restored by giving it the same losses again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

# the largest distance, on the unit cube, between the mean of a search and that of its repetition
SAME_MEAN = 1e-9
# bounds of what a search begins with
SIGMAS = (1e-4, 1.0)
POPULATIONS = (4, 100_000)
SEEDS = (1, 2**31 - 1)


class GlobalSearch:
    """CMA-ES (Hansen's package `cma`).

    Args:
        start: The first mean, on the unit cube.
        sigma: The first standard deviation, on the unit cube.
        population: The number of points in a generation.
        seed: The seed.
    """

    def __init__(self, start: Sequence[float], sigma: float, population: int, seed: int) -> None:
        import cma

        self._began = {
            "start": [float(x) for x in start],
            "sigma": sigma,
            "population": population,
            "seed": seed,
        }
        self._losses: list[list[float]] = []
        # a generator of its own: cma's default is numpy's global one, which others may use
        deviates = np.random.RandomState(seed).randn
        options = {"randn": deviates, "seed": float("nan"), "popsize": population, "verbose": -9}
        self._strategy = cma.CMAEvolutionStrategy(self._began["start"], sigma, options)

    @property
    def converged(self) -> bool:
        """Whether another generation is not worth while."""
        return bool(self._strategy.stop())

    def ask(self) -> list[list[float]]:
        """The points of the next generation; they may lie outside the unit cube."""
        self._points = self._strategy.ask()
        return [[float(x) for x in point] for point in self._points]

    def tell(self, losses: Sequence[float]) -> None:
        """Give the losses of the points that `ask` returned, in their order."""
        self._strategy.tell(self._points, list(losses))
        self._losses.append([float(loss) for loss in losses])

    def state(self) -> dict[str, Any]:
        """The state, for JSON."""
        mean = [float(x) for x in self._strategy.mean]
        return {**self._began, "losses": self._losses, "mean": mean}

    @classmethod
    def restored(cls, state: Mapping[str, Any]) -> GlobalSearch:
        """The search with this state.

        Raises:
            ValueError: The state is incomplete or contradicts itself, or another version of the
                package or another processor does not repeat the search.
        """
        try:
            start, losses, mean = state["start"], state["losses"], state["mean"]
            _check_beginning(start, state["sigma"], state["population"], state["seed"])
            search = cls(start, state["sigma"], state["population"], state["seed"])
            told = np.array(losses, dtype=float).reshape(len(losses), state["population"])
            reached = np.array(mean, dtype=float).reshape(len(start))
        except (KeyError, TypeError) as e:
            raise ValueError(f"it is incomplete: {e!r}") from None
        if not np.isfinite(told).all():
            raise ValueError("a loss is not finite")
        for generation in told.tolist():
            if search.converged:
                raise ValueError("the search converges before its losses end")
            search.ask()
            search.tell(generation)
        if not np.abs(search._strategy.mean - reached).max() <= SAME_MEAN:
            raise ValueError("its losses do not lead to its mean")
        return search


def _check_beginning(start: Any, sigma: Any, population: Any, seed: Any) -> None:
    """Check what a search began with, before anything is made of it.

    Raises:
        ValueError: It is out of the bounds that the options have.
    """
    if not isinstance(start, list) or not all(type(x) in (int, float) for x in start):
        raise ValueError("its start is no point")
    for name, value, kinds, low, high in (
        ("sigma", sigma, (int, float), *SIGMAS),
        ("population", population, (int,), *POPULATIONS),
        ("seed", seed, (int,), *SEEDS),
    ):
        if type(value) not in kinds or not low <= value <= high:
            raise ValueError(f"its {name} = {value!r} is not from {low:g} to {high:g}")
