"""Identification on all cores: global search (CMA-ES), least squares, a search that counts; seeded, resumable, never losing its best."""

from __future__ import annotations

import json
import os
import pickle
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..durable import write_durably
from ..errors import LandingError
from .counting import KICKS, count_round
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
    """The best point so far: `z` on the unit cube, its loss, and how it came about.

    `missed`: its softly counted misses (`Objective.missed`), by which points are judged once the counting search has begun; none before.
    `counted`, `rounds`: evaluations and starts of the counting search.
    """

    z: list[float]
    loss: float
    evaluations: int
    stage: str
    seed: int
    missed: float | None = None
    counted: int = 0
    rounds: int = 0


class Search:
    """One identification. `folder` keeps its best and its state, from which `resume` goes on.

    Raises LandingError: the folder holds a search already and `resume` is not asked for, or one of other free numbers or targets.
    """

    def __init__(self, objective: Objective, folder: Path, seed: int = 1, workers: int | None = None, resume: bool = False) -> None:
        self.objective = objective
        self.folder = folder
        self.seed = seed
        self.workers = workers or os.cpu_count() or 1
        self.labels = objective.free.labels
        start = objective.free.start()
        self.best = Best(start, float("inf"), 0, "start", seed)
        self.start_loss = self.start_missed = float("nan")
        self._strategy: Any = None
        self._pool: ProcessPoolExecutor | None = None
        best, state = folder / "best.json", folder / "search.pickle"
        if best.exists() and not resume:
            raise LandingError(f"{folder} holds an identification; --resume goes on with it, --work names another folder")
        if resume:
            self._take_up(best, state)
        folder.mkdir(parents=True, exist_ok=True)

    def _take_up(self, best: Path, state: Path) -> None:
        try:
            kept = json.loads(best.read_text(encoding="utf-8"))
        except (OSError, ValueError) as e:
            raise LandingError(f"{best} cannot be read ({e}); there is nothing to resume") from None
        if kept.pop("labels") != self.labels or kept.pop("targets") != self.objective.labels:
            raise LandingError(f"{best} is of other free numbers or targets; resume with the same, or name another folder by --work")
        self.start_loss, self.start_missed = kept.pop("start_loss"), kept.pop("start_missed")
        self.best = Best(**kept)
        if state.exists():
            self._strategy = pickle.loads(state.read_bytes())

    def __enter__(self) -> Search:
        self._pool = ProcessPoolExecutor(self.workers, initializer=_adopt, initargs=(self.objective,))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
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
            self.best = replace(self.best, z=[float(x) for x in z], loss=loss, stage=stage, seed=self.seed)
            self.save()
        return loss

    @property
    def counting(self) -> bool:
        """Whether the counting search has begun."""
        return self.best.missed is not None

    @property
    def improved(self) -> bool:
        """Whether the best point is better than the start, by the count where it has begun, else by the loss."""
        return self.best.loss < self.start_loss if self.best.missed is None else self.best.missed < self.start_missed

    def save(self) -> None:
        """Write best point and search state, each to a temporary name first."""
        told = {
            **asdict(self.best), "labels": self.labels, "targets": self.objective.labels,
            "start_loss": self.start_loss, "start_missed": self.start_missed,
        }  # fmt: skip
        write_durably(self.folder / "best.json", json.dumps(told, indent=1).encode())
        if self._strategy is not None:
            write_durably(self.folder / "search.pickle", pickle.dumps(self._strategy))

    def explore(self, evaluations: int, progress: Callable[[int, float], object], sigma: float = 0.1, population: int = 32) -> None:
        """Global search by CMA-ES until `evaluations` landings of both modes have been tried in all, or it has converged.

        `progress` is told the evaluations so far and the best loss.
        """
        import cma

        if self._strategy is None:
            (first,) = self.evaluate([self.best.z])
            self.start_missed = self.objective.missed(first)
            self.start_loss = self.consider(self.best.z, first, "start")
            options = {"seed": self.seed, "popsize": population, "verbose": -9}
            self._strategy = cma.CMAEvolutionStrategy(self.best.z, sigma, options)
        while self.best.evaluations < evaluations and not self._strategy.stop():
            points = self._strategy.ask()
            losses = [self.consider(z, m, "global search") for z, m in zip(points, self.evaluate(points))]
            self._strategy.tell(points, losses)
            self.save()
            progress(self.best.evaluations, self.best.loss)

    def count(self, evaluations: int, progress: Callable[[int, float], object]) -> None:
        """Rounds of `counting.count_round` from the best point; none begins once they have tried `evaluations` landings of both modes.

        `progress` is told all evaluations so far and the misses.
        """
        if self.best.missed is None:
            (first,) = self.look([self.best.z])
            self.best.missed = self.objective.missed(first)
            self._strategy = None

        def evaluate(points: Sequence[Sequence[float]]) -> list[NDArray[np.float64]]:
            found = self.evaluate(points)
            self.best.counted += len(points)
            for z, misfits in zip(points, found):
                self._consider_count(z, misfits)
            progress(self.best.evaluations, float(self.best.missed or 0.0))
            return found

        while self.best.counted < evaluations:
            turn = self.best.rounds
            count_round(self.objective, evaluate, self.best.z, (self.seed, turn), KICKS[turn % len(KICKS)])
            self.best.rounds += 1
            self.save()

    def _consider_count(self, z: Sequence[float], misfits: NDArray[np.float64]) -> None:
        missed = self.objective.missed(misfits)
        if self.best.missed is None or missed < self.best.missed:
            loss = float(np.log1p(misfits**2).sum())
            self.best = replace(self.best, z=list(z), loss=loss, stage="counting search", seed=self.seed, missed=missed)
            self.save()

    def polish(self, evaluations: int, progress: Callable[[int, float], object]) -> None:
        """Least squares (scipy, trust region, Cauchy's loss, bounds) from the best point; the Jacobian's columns side by side."""
        from scipy.optimize import least_squares

        def residuals(z: NDArray[np.float64]) -> NDArray[np.float64]:
            (found,) = self.evaluate([z.tolist()])
            self.consider(z.tolist(), found, "least squares")
            progress(self.best.evaluations, self.best.loss)
            return found

        start = np.clip(folded(self.best.z), 1e-6, 1.0 - 1e-6)
        tries = max(1, evaluations // (len(start) + 1))
        least_squares(residuals, start, jac=self.jacobian, bounds=(0.0, 1.0), loss="cauchy", max_nfev=tries, x_scale="jac")

    def jacobian(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """d misfit/d z (targets, numbers) by central differences, one-sided at the cube's faces."""
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
