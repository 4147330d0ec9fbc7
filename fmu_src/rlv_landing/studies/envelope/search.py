"""The landing-stability boundary in two quantities, with the critical condition along it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from .boundary import Crossing, Point, Tracer
from .judged_landing import JudgedLanding, judged_landing
from .store import Store
from .study import EnvelopeStudy


@dataclass(frozen=True)
class Critical:
    """A point of the boundary.

    Attributes:
        x: Halfway between the last stable landing and the first lost one [SI].
        y: The same along the vertical axis [SI].
        stable: The last stable landing's (x, y) [SI].
        lost: The first lost landing's (x, y) [SI].
        landing: The first lost landing.
    """

    x: float
    y: float
    stable: tuple[float, float]
    lost: tuple[float, float]
    landing: JudgedLanding


@dataclass(frozen=True)
class Family:
    """One family's result: boundary `lines` of critical points, and all `landings`.

    A landing is (x, y, judged landing), x and y in SI.
    """

    values: Mapping[str, float | str]
    lines: tuple[tuple[Critical, ...], ...]
    landings: tuple[tuple[float, float, JudgedLanding], ...]

    def count(self, name: str) -> int:
        """Landings with this outcome."""
        return sum(landing.name == name for _, _, landing in self.landings)


@dataclass(frozen=True)
class Envelope:
    """The results of a study, family by family."""

    study: EnvelopeStudy
    families: tuple[Family, ...]

    @property
    def landings(self) -> int:
        """Landings made, all families together."""
        return sum(len(f.landings) for f in self.families)

    @property
    def uniform(self) -> int:
        """Landings of a uniform grid of the resolution reached, all families together."""
        return self.study.lattice.uniform * len(self.families)


def envelope(
    study: EnvelopeStudy,
    workers: int = 1,
    store: Store | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Envelope:
    """Find the boundary of every family.

    Interrupted, it stops after the landings under way.

    Args:
        study: The study.
        workers: Number of threads; the result does not depend on it.
        store: Landings made before, which are not made again; every new one is added.
        progress: Called after each landing with the family's number and the landings so far.

    Raises:
        LandingError: Values within the axes' ranges make no landing.
    """
    kept = store if store is not None else Store(study)
    with ThreadPoolExecutor(workers) as pool:
        try:
            return Envelope(
                study,
                tuple(_family(study, k, kept, pool, progress) for k in range(len(study.families))),
            )
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _family(
    study: EnvelopeStudy,
    k: int,
    store: Store,
    pool: ThreadPoolExecutor,
    progress: Callable[[int, int], object] | None,
) -> Family:
    values = study.families[k]

    def land(point: Point) -> JudgedLanding:
        x, y = study.values_at(*point)
        return judged_landing(study, {**values, study.x.name: x, study.y.name: y})

    def judge(points: Sequence[Point]) -> list[bool]:
        new = [p for p in points if (k, p) not in store.found]
        for point, landing in zip(new, pool.map(land, new)):
            store.add(k, point, landing)
            if progress is not None:
                progress(k, len(store.found))
        return [not store.found[k, p].lost(study.criterion) for p in points]

    def critical(crossing: Crossing) -> Critical:
        ends = study.values_at(*crossing.stable), study.values_at(*crossing.lost)
        return Critical(*study.values_at(*crossing.middle), *ends, store.found[k, crossing.lost])

    tracer = Tracer(study.lattice, judge)
    lines = tracer.trace()
    landings = tuple(
        (*study.values_at(*point), store.found[k, point]) for point in sorted(tracer.verdicts)
    )
    return Family(values, tuple(tuple(critical(c) for c in line) for line in lines), landings)
