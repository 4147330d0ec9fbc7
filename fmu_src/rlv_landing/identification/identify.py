"""Identification: a global search (CMA-ES), then least squares, on all cores; seeded, resumable,
and never losing its best.
"""

from __future__ import annotations

import json
import pickle
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..durable import write_durably
from ..errors import LandingError
from ..workers import default_workers
from .objective import Objective

STEP = 1e-3
_OBJECTIVE: Objective | None = None


def _adopt(objective: Objective) -> None:
    """In a worker: Ctrl-C is the parent's to answer."""
    global _OBJECTIVE
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _OBJECTIVE = objective


def _misfits(z: Sequence[float]) -> NDArray[np.float64]:
    assert _OBJECTIVE is not None
    return _OBJECTIVE.misfits(z)


@dataclass
class Best:
    """The best point so far: `z` on the unit cube, its loss, and how it came about."""

    z: list[float]
    loss: float
    evaluations: int
    stage: str
    seed: int


class Search:
    """One identification. `folder` keeps its best and its state, from which `resume` goes on.

    Raises LandingError: the folder holds a search already and `resume` is not asked for, or one of
        other free numbers or targets.
    """

    def __init__(
        self,
        objective: Objective,
        folder: Path,
        seed: int = 1,
        workers: int | None = None,
        resume: bool = False,
    ) -> None:
        self.objective = objective
        self.folder = folder
        self.seed = seed
        self.workers = workers or default_workers()
        self.labels = objective.free.labels
        start = objective.free.start()
        self.best = Best(start, float("inf"), 0, "start", seed)
        self.start_loss = float("nan")
        self._strategy: Any = None
        self._pool: ProcessPoolExecutor | None = None
        best, state = folder / "best.json", folder / "search.pickle"
        if best.exists() and not resume:
            raise LandingError(
                f"{folder} holds an identification; --resume goes on with it, --work names another folder"
            )
        if resume:
            self._take_up(best, state)
        folder.mkdir(parents=True, exist_ok=True)

    def _take_up(self, best: Path, state: Path) -> None:
        try:
            kept = json.loads(best.read_text(encoding="utf-8"))
        except (OSError, ValueError) as e:
            raise LandingError(f"{best} cannot be read ({e}); there is nothing to resume") from None
        if kept.pop("labels") != self.labels or kept.pop("targets") != self.objective.labels:
            raise LandingError(
                f"{best} is of other free numbers or targets; resume with the same, or name another folder by --work"
            )
        self.start_loss = kept.pop("start_loss")
        self.best = Best(**kept)
        if state.exists():
            self._strategy = pickle.loads(state.read_bytes())

    def __enter__(self) -> Search:
        self._pool = ProcessPoolExecutor(
            self.workers, initializer=_adopt, initargs=(self.objective,)
        )
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

    def evaluate(self, points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
        """Misfits at several points, side by side; they count as tried."""
        found = self.look(points)
        self.best.evaluations += len(points)
        return found

    def look(self, points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
        """Misfits at several points, side by side."""
        assert self._pool is not None
        return list(self._pool.map(_misfits, [list(map(float, p)) for p in points]))

    def consider(self, z: Sequence[float], misfits: NDArray[np.float64], stage: str) -> float:
        """The loss of a point; it is kept, on disk too, where it is the best so far."""
        loss = float(np.log1p(misfits**2).sum())
        if loss < self.best.loss:
            self.best = Best([float(x) for x in z], loss, self.best.evaluations, stage, self.seed)
            self.save()
        return loss

    def save(self) -> None:
        """Write best point and search state, each to a temporary name first."""
        told = {
            **asdict(self.best),
            "labels": self.labels,
            "targets": self.objective.labels,
            "start_loss": self.start_loss,
        }
        write_durably(self.folder / "best.json", json.dumps(told, indent=1).encode())
        if self._strategy is not None:
            write_durably(self.folder / "search.pickle", pickle.dumps(self._strategy))

    def explore(
        self,
        evaluations: int,
        progress: Callable[[int, float], object],
        sigma: float = 0.1,
        population: int = 32,
    ) -> None:
        """Global search by CMA-ES until `evaluations` landings of both modes have been tried in
        all, or it has converged.

        `progress` is told the evaluations so far and the best loss.
        """
        import cma

        if self._strategy is None:
            (first,) = self.evaluate([self.best.z])
            self.start_loss = self.consider(self.best.z, first, "start")
            options = {"seed": self.seed, "popsize": population, "verbose": -9}
            self._strategy = cma.CMAEvolutionStrategy(self.best.z, sigma, options)
        while self.best.evaluations < evaluations and not self._strategy.stop():
            points = self._strategy.ask()
            losses = [
                self.consider(z, m, "global search") for z, m in zip(points, self.evaluate(points))
            ]
            self._strategy.tell(points, losses)
            self.save()
            progress(self.best.evaluations, self.best.loss)

    def polish(self, evaluations: int, progress: Callable[[int, float], object]) -> None:
        """Least squares (scipy, trust region, Cauchy's loss, bounds) from the best point; the
        Jacobian's columns side by side.
        """
        from scipy.optimize import least_squares

        def residuals(z: NDArray[np.float64]) -> NDArray[np.float64]:
            (found,) = self.evaluate([z.tolist()])
            self.consider(z.tolist(), found, "least squares")
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

    def jacobian(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of the misfit by `z` (targets, numbers) by central differences, one-sided at the cube's faces."""
        higher: list[NDArray[np.float64]] = []
        lower: list[NDArray[np.float64]] = []
        for i in range(len(z)):
            for points, sign in ((higher, 1.0), (lower, -1.0)):
                moved = np.array(z, dtype=float)
                moved[i] = np.clip(moved[i] + sign * STEP, 0.0, 1.0)
                points.append(moved)
        found = self.look([p.tolist() for p in (*higher, *lower)])
        n = len(z)
        columns = [(found[i] - found[n + i]) / (higher[i][i] - lower[i][i]) for i in range(n)]
        return np.array(columns).T


def folded(z: Sequence[float]) -> NDArray[np.float64]:
    """`z` inside the unit cube: what lies beyond a face is mirrored at it."""
    turned = np.abs(np.asarray(z, dtype=float)) % 2.0
    inside: NDArray[np.float64] = np.where(turned > 1.0, 2.0 - turned, turned)
    return inside
