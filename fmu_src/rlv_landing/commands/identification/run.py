"""Runs a search of `rlv-landing identify`: its effort, its progress, its files and its ends."""

from __future__ import annotations

import sys
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from ...errors import one_line
from ...signals.interrupts import answer
from ...text.durable import ANOTHER_WORK, unwritable, write_durably
from ..printing import FAILED, exit_code

if TYPE_CHECKING:
    from ...identification.free_numbers import FreeNumbers
    from ...identification.identify import Search
    from ...signals.handlers import Hold

# a process with the model and its targets beyond what it shares, and both modes' landings, at least
BYTES_PER_PROCESS = 30e6
SECONDS_PER_EVALUATION = 6e-3
# a point of a generation with its landings' misfits; the loss of an evaluation, and its text
BYTES_PER_POINT, BYTES_PER_EVALUATION = 3e3, 60.0
FEWER = "take fewer: a search ends where it converges, and --resume goes on"


def check_effort(options: dict[str, Any]) -> None:
    """Refuse more evaluations than 30 days take, and what does not fit into memory.

    That is the processes, a generation of the search, and the losses that it keeps.

    Raises:
        LandingError: They are more.
    """
    from ...effort import check_duration, check_memory
    from ...workers import default_workers

    workers = options["workers"] or default_workers()
    check_memory(
        f"--workers {workers}", BYTES_PER_PROCESS * workers, "leave it out: one for each core"
    )
    check_memory(
        f"--population {options['population']}",
        BYTES_PER_POINT * options["population"],
        "take fewer points",
    )
    generation = options["population"] if options["evaluations"] > 1 else 0
    count = max(options["evaluations"], generation, options["polish"], options["count"])
    check_duration(
        f"{count} evaluations by {workers} processes",
        SECONDS_PER_EVALUATION * count / min(workers, default_workers()),
        FEWER,
    )
    check_memory(
        f"--evaluations {options['evaluations']}",
        BYTES_PER_EVALUATION * options["evaluations"],
        FEWER,
        at_most=True,
    )


def _fail(error: Exception, work: Path) -> NoReturn:
    """End a search that the disk or the machine does not let go on."""
    reason = (
        unwritable(work, error, ANOTHER_WORK, kept=True)
        if isinstance(error, OSError)
        else "a process of the search was killed; take fewer --workers, or free memory"
    )
    click.echo(one_line(f"error: {reason}; --resume goes on from what {work} holds"), err=True)
    sys.exit(exit_code(error) if isinstance(error, OSError) else FAILED)


def run(search: Search, work: Path, options: dict[str, Any], hold: Hold) -> list[str] | None:
    """Search, and write the best point and the report; the fit in short lines.

    It is None where this was interrupted; the best point so far is then written. Signals that
    `hold` has noted since the search was made interrupt it at the start.
    """
    try:
        with search:
            try:
                hold.release()
                _search(search, options)
                _write_best(search, work)
                return _report(search, work)
            except KeyboardInterrupt:
                answer()
                _write_best(search, work)
                return None
            except (OSError, BrokenExecutor) as e:
                _fail(e, work)
    except KeyboardInterrupt:
        # it came while the processes started or ended
        answer()
        _write_best(search, work)
        return None


def _write_best(search: Search, work: Path) -> None:
    """Write the best point so far: the search's files, and `identified.toml`."""
    from ...identification.origins import identified_toml

    search.save()
    best = search.objective.free.parameters(search.best.z)
    text = identified_toml(best, search.best, sys.argv[1:])
    write_durably(work / "identified.toml", text.encode())


def _report(search: Search, work: Path) -> list[str]:
    """Write the report; the fit in short lines."""
    from ...identification.identify_report import short_report, write_report

    best = search.objective.free.parameters(search.best.z)
    write_durably(work / "report.md", write_report(search, best).encode())
    return short_report(search.objective, best)


def start_note(numbers: FreeNumbers) -> str:
    """A line on the numbers for which the search begins at a bound; empty without any."""
    outside = numbers.outside
    if not outside:
        return ""
    more = f" and {len(outside) - 3} more" if len(outside) > 3 else ""
    return (
        f"note: {', '.join(outside[:3])}{more}: the start is outside the bounds, and the search "
        "begins at the nearest; --bound NAME=LO..HI sets others"
    )


def _search(search: Search, options: dict[str, Any]) -> None:
    """Search, with progress on a terminal."""
    from tqdm import tqdm

    bar_format = "{desc} {percentage:3.0f}%|{bar}| {n}/{total} [{elapsed}<{remaining}] {postfix}"
    with tqdm(
        total=options["evaluations"],
        initial=search.best.evaluations,
        disable=not sys.stderr.isatty(),
        bar_format=bar_format,
    ) as bar:

        def show_progress(done: int, loss: float) -> None:
            bar.total = max(bar.total or 0, done)
            bar.update(done - bar.n)
            bar.set_postfix_str(f"{'misses' if search.best.counting else 'loss'} {loss:.2f}")

        if not search.best.counting:
            bar.set_description_str("global search")
            search.global_search(
                options["evaluations"], show_progress, options["sigma"], options["population"]
            )
            if options["polish"]:
                bar.set_description_str("least squares")
                bar.total = search.best.evaluations + options["polish"]
                search.refine(options["polish"], show_progress)
        if options["count"]:
            bar.set_description_str("counting search")
            bar.total = search.best.evaluations + options["count"] - search.best.counted
            search.count(options["count"], show_progress)
