"""Work against precision: runs the peers, reads off the cost at equal error, and draws it.

Time is the processor time of the thread in one plain landing, the best of several turns. All runs
take turns one after another, so that other work on the machine affects all alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import exp, log
from pathlib import Path
from time import thread_time

from peers import Peer
from problem import Error, Problem

from rlv_landing.figures.style import FAINT

TURNS = 15
# of processor time [s], after which a run takes no more turns
ENOUGH_SECONDS = 0.3
COLOURS = {"ours": "Blues", "C": "Greys", "other": "Oranges", "simulator": "Purples"}
MARKERS = "osD^vP*X<>"


@dataclass
class Run:
    """One peer at one tolerance: error, best time [s] and right-hand sides (a simulator: steps)."""

    peer: Peer
    tolerance: float
    error: Error | None = None
    failure: str = ""
    seconds: float = float("inf")
    spent: float = 0.0
    calls: int = 0

    def find_error(self, problem: Problem) -> None:
        """Land once for the error."""
        with self._record_failure():
            self.error = self.peer.error(problem, self.tolerance)

    def time(self, problem: Problem) -> None:
        """Land once plainly, unless it has failed or has had enough turns."""
        if self.failure or self.spent > ENOUGH_SECONDS:
            return
        with self._record_failure():
            task = self.peer.task(problem, self.tolerance)
            start = thread_time()
            task.land()
            seconds = thread_time() - start
            self.seconds, self.spent, self.calls = (
                min(self.seconds, seconds),
                self.spent + seconds,
                task.calls(),
            )

    @contextmanager
    def _record_failure(self) -> Iterator[None]:
        """Record a failure of the solver."""
        try:
            yield
        except (ArithmeticError, TimeoutError, Warning) as failure:
            self.failure = f"{type(failure).__name__}: {failure}"


def measure(peers: Iterable[Peer], problem: Problem, report: Callable[[str], object]) -> list[Run]:
    """All runs of the `peers`; those that do not end have a `failure`."""
    runs = [Run(peer, tolerance) for peer in peers for tolerance in peer.tolerances]
    for run in runs:
        report(f"{problem.mode}: error of {run.peer.name} at {run.tolerance:g}")
        run.find_error(problem)
    for turn in range(TURNS):
        report(f"{problem.mode}: time, turn {turn + 1} of {TURNS}")
        for run in runs:
            run.time(problem)
    return runs


@dataclass(frozen=True)
class Cost:
    """Cost at an error of the peaks: seconds, right-hand sides (steps) and stroke error [m].

    `bound` is "≤" if even the loosest run is better than required, ">" if the tightest is not good
    enough; the numbers are that run's.
    """

    seconds: float
    calls: float
    stroke: float
    bound: str = ""


def cost(runs: list[Run], target: float) -> Cost:
    """Cost of a peer at which every peak is within `target`, at every tighter tolerance too.

    Between the loosest run that keeps the target and the next looser one, logarithms are
    interpolated.
    """
    numbers = [
        (r.error.peaks, r.seconds, float(r.calls), r.error.stroke)
        for r in sorted(runs, key=lambda r: r.tolerance)
        if r.error is not None and not r.failure
    ]
    kept = 0
    while kept < len(numbers) and numbers[kept][0] <= target:
        kept += 1
    if kept == 0:
        return Cost(*numbers[0][1:], ">")
    if kept == len(numbers):
        return Cost(*numbers[-1][1:], "≤")
    good, bad = numbers[kept - 1], numbers[kept]
    part = log(target / good[0]) / log(bad[0] / good[0])
    return Cost(*(exp((1.0 - part) * log(a) + part * log(b)) for a, b in zip(good[1:], bad[1:])))


def draw(runs: dict[str, list[Run]], path: Path, note: str) -> None:
    """Draw every peer's error over its time, one panel per mode, as a PNG."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 6.4), layout="constrained")
    axes = figure.subplots(1, len(runs), sharex=True, sharey=True)
    peers = list(dict.fromkeys(run.peer for mode in runs.values() for run in mode))
    kinds = {kind: [p for p in peers if p.kind == kind] for kind in COLOURS}
    for ax, (mode, all_runs) in zip(axes, runs.items()):
        for kind, members in kinds.items():
            for i, peer in enumerate(members):
                points = [
                    (1e3 * r.seconds, r.error.peaks)
                    for r in all_runs
                    if r.peer is peer and not r.failure
                ]
                colour = colormaps[COLOURS[kind]](0.9 - 0.5 * i / max(len(members), 2))
                ax.plot(
                    *zip(*points),
                    marker=MARKERS[i],
                    markersize=4.5,
                    linewidth=1.2,
                    color=colour,
                    label=peer.name,
                )
        ax.axhline(1e-3, color=FAINT, linewidth=0.8, linestyle=":")
        ax.set(
            xscale="log",
            yscale="log",
            xlabel="processor time of a 1 s landing [ms]",
            ylim=(3e-7, 3.0),
        )
        ax.set_title(f"mode {mode}", loc="left")
        ax.grid(visible=True, which="major", linewidth=0.3)
    axes[0].set_ylabel("largest error of any peak force or stroke [of its peak]")
    figure.legend(
        *axes[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=3,
        frameon=False,
        fontsize=8.5,
    )
    figure.suptitle(note, x=0.01, ha="left", fontsize=9)
    figure.savefig(path, dpi=120, metadata={"Software": None})
