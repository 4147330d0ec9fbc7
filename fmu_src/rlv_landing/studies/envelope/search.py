"""The landing-stability boundary in two quantities, and the critical condition at every point of
it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from .boundary import Crossing, Point, Tracer
from .landed import Landed, land
from .store import Store
from .study import EnvelopeStudy


@dataclass(frozen=True)
class Critical:
    """A point of the boundary: `x`, `y` [SI] halfway between the last landing that holds and the
    first that is lost; of the two, what became of the latter.
    """

    x: float
    y: float
    stable: tuple[float, float]
    lost: tuple[float, float]
    landed: Landed


@dataclass(frozen=True)
class Family:
    """One family's result: boundary `lines` of critical points, and every landing (x, y, landed)."""

    values: Mapping[str, float | str]
    lines: tuple[tuple[Critical, ...], ...]
    landings: tuple[tuple[float, float, Landed], ...]

    def count(self, name: str) -> int:
        """Landings with this outcome."""
        return sum(landed.name == name for _, _, landed in self.landings)


@dataclass(frozen=True)
class Envelope:
    """The families of a study; `landings` that it took, `uniform` that a uniform grid of the same
    resolution takes.
    """

    study: EnvelopeStudy
    families: tuple[Family, ...]

    @property
    def landings(self) -> int:
        """Landings made, all families together."""
        return sum(len(f.landings) for f in self.families)

    @property
    def uniform(self) -> int:
        """Landings of a uniform grid whose spacing is the resolution reached, all families
        together.
        """
        return self.study.lattice.uniform * len(self.families)


def envelope(
    study: EnvelopeStudy,
    workers: int = 1,
    store: Store | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Envelope:
    """The boundary of every family. The result does not depend on `workers`, the number of threads.

    `progress` is told, after each landing, the family's number and the landings so far.
    Interrupted, it stops after the landings under way; those made are in the `store`, and a study
    whose landings it has does not make them again. Raises LandingError where values within the
    axes' ranges make no landing.
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

    def one(point: Point) -> Landed:
        x, y = study.place(*point)
        return land(study, {**values, study.x.name: x, study.y.name: y})

    def judge(points: Sequence[Point]) -> list[bool]:
        new = [p for p in points if (k, p) not in store.found]
        for point, landed in zip(new, pool.map(one, new)):
            store.add(k, point, landed)
            if progress is not None:
                progress(k, len(store.found))
        return [not store.found[k, p].lost(study.criterion) for p in points]

    def critical(crossing: Crossing) -> Critical:
        ends = study.place(*crossing.stable), study.place(*crossing.lost)
        return Critical(*study.place(*crossing.middle), *ends, store.found[k, crossing.lost])

    tracer = Tracer(study.lattice, judge)
    lines = tracer.trace()
    landings = tuple(
        (*study.place(*point), store.found[k, point]) for point in sorted(tracer.verdicts)
    )
    return Family(values, tuple(tuple(critical(c) for c in line) for line in lines), landings)
