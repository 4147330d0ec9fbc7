"""Identification on all cores: a global search, least squares, and a search that counts.

It is seeded and resumable, and never loses its best point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from ..workers import default_workers
from .counting.descent import SPREADS, count_round
from .counting.programme import programmes
from .free_numbers import folded
from .global_search import GlobalSearch
from .objective import Objective, cauchy_loss
from .pool import misfits_at, started_pool
from .search_folder import Best, SearchFolder

# difference for the Jacobian, on the unit cube
STEP = 1e-3
# gets the evaluations so far and the best loss (in the counting search: the fewest misses)
Progress = Callable[[int, float], object]


class Search:
    """One identification.

    Args:
        objective: What it makes small.
        folder: The folder that keeps its best point and its state.
        seed: The seed.
        workers: The number of processes; None: one for each core that this process may use.
        resume: Whether to go on from what the folder holds.

    Raises:
        LandingError: The folder holds a search and `resume` is not asked for; or it is, and the
            folder holds none, or one of other free numbers or targets.
    """

    def __init__(
        self,
        objective: Objective,
        folder: Path,
        seed: int = 1,
        workers: int | None = None,
        *,
        resume: bool = False,
    ) -> None:
        self.objective = objective
        self.seed = seed
        self.workers = workers or default_workers()
        self._folder = SearchFolder(folder, objective)
        self._global: GlobalSearch | None = None
        self._pool: ProcessPoolExecutor | None = None
        if resume:
            self.best, self._global = self._folder.load()
        else:
            self._folder.create()
            self.best = Best(objective.free.start(), float("inf"), 0, "start", seed)

    def __enter__(self) -> Search:
        self._pool = started_pool(self.objective, self.workers)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
            self._pool = None
        self._folder.release()

    def evaluate(self, points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
        """The misfits at several points, side by side; they count as evaluations."""
        found = self.evaluate_uncounted(points)
        self.best.evaluations += len(points)
        return found

    def evaluate_uncounted(self, points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
        """The misfits at several points, side by side."""
        assert self._pool is not None
        return list(self._pool.map(misfits_at, [list(map(float, p)) for p in points]))

    def update_best(self, z: Sequence[float], misfits: NDArray[np.float64], stage: str) -> float:
        """The loss of a point, which is kept, on disk too, where that is the least so far."""
        loss = cauchy_loss(misfits)
        if loss < self.best.loss:
            self._keep(z, loss, stage)
        return loss

    def _update_fewest_misses(self, z: Sequence[float], misfits: NDArray[np.float64]) -> None:
        missed = self.objective.missed(misfits)
        if self.best.missed is None or missed < self.best.missed:
            self._keep(z, cauchy_loss(misfits), "counting search", missed)

    def _keep(
        self, z: Sequence[float], loss: float, stage: str, missed: float | None = None
    ) -> None:
        point = [float(x) for x in z]
        self.best = replace(
            self.best, z=point, loss=loss, stage=stage, seed=self.seed, missed=missed
        )
        self._folder.save_best(self.best)

    def save(self) -> None:
        """Write the best point and the state of the search."""
        self._folder.save_best(self.best)
        if self._global is not None:
            self._folder.save_state(self._global)

    def global_search(
        self, evaluations: int, progress: Progress, sigma: float = 0.1, population: int = 32
    ) -> None:
        """Search by CMA-ES until it has converged, or until enough landings have been tried.

        Args:
            evaluations: The evaluations of the landings, in all, after which none begins.
            progress: Called after each generation.
            sigma: The first standard deviation, on the unit cube.
            population: The number of points in a generation.
        """
        if not self.best.evaluations:
            (first,) = self.evaluate([self.best.z])
            self.best.start_missed = self.objective.missed(first)
            self.best.start_loss = cauchy_loss(first)
            self.update_best(self.best.z, first, "start")
        if self._global is None:
            self._global = GlobalSearch(self.best.z, sigma, population, self.seed)
        while self.best.evaluations < evaluations and not self._global.converged:
            points = self._global.ask()
            found = self.evaluate(points)
            self._global.tell(
                [self.update_best(z, m, "global search") for z, m in zip(points, found)]
            )
            self.save()
            progress(self.best.evaluations, self.best.loss)

    def refine(self, evaluations: int, progress: Progress) -> None:
        """Least squares from the best point (scipy: trust region, Cauchy's loss, bounds).

        The Jacobian's columns are evaluated side by side.

        Args:
            evaluations: The evaluations of the landings at most, the Jacobian's included.
            progress: Called after each point.
        """
        from scipy.optimize import least_squares

        def residuals(z: NDArray[np.float64]) -> NDArray[np.float64]:
            (found,) = self.evaluate([z.tolist()])
            self.update_best(z.tolist(), found, "least squares")
            progress(self.best.evaluations, self.best.loss)
            return found

        start = np.clip(folded(self.best.z), 1e-6, 1.0 - 1e-6)
        tries = max(1, evaluations // (len(start) + 1))
        least_squares(
            residuals,
            start,
            jac=self.jacobian,
            bounds=(0.0, 1.0),
            loss="cauchy",
            max_nfev=tries,
            x_scale="jac",
        )

    def count(self, evaluations: int, progress: Progress) -> None:
        """Search for the fewest missed bounds, in rounds from the best point.

        They are in turn linear programmes (`programmes`) and a descent on the soft count
        (`count_round`).

        Args:
            evaluations: The evaluations of the landings by this search, in all, after which no
                round begins.
            progress: Called after each step.
        """
        if not self.best.counting:
            (first,) = self.evaluate_uncounted([folded(self.best.z).tolist()])
            self.best.missed = self.objective.missed(first)
            self._global = None

        def evaluate(points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
            found = self.evaluate(points)
            self.best.counted += len(points)
            for z, misfits in zip(points, found):
                self._update_fewest_misses(z, misfits)
            progress(self.best.evaluations, float(self.best.missed or 0.0))
            return found

        while self.best.counted < evaluations:
            start, descents = folded(self.best.z).tolist(), self.best.rounds // 2
            if self.best.rounds % 2 == 0:
                programmes(self.objective.soft_count, evaluate, start)
            else:
                spread, seed = SPREADS[descents % len(SPREADS)], (self.seed, self.best.rounds)
                count_round(self.objective.soft_count, evaluate, start, seed, spread)
            self.best.rounds += 1
            self.save()

    def jacobian(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """The derivatives of the misfits by `z`, shape (misfits, numbers).

        By central differences, one-sided at the cube's faces.
        """
        higher, lower = (np.clip(z + sign * STEP * np.eye(len(z)), 0.0, 1.0) for sign in (1, -1))
        found = self.evaluate_uncounted([*higher.tolist(), *lower.tolist()])
        n = len(z)
        columns = [(found[i] - found[n + i]) / (higher[i][i] - lower[i][i]) for i in range(n)]
        return np.array(columns).T
