"""`rlv-landing identify`: estimates parameters from printed or measured landings."""

from __future__ import annotations

import signal
import sys
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from ..choices import split_pair
from ..errors import LandingError, one_line
from ..text.durable import write_durably
from .number_types import NumberRange, WholeNumber
from .options import HELP_NAMES, choose, parameter_options
from .printing import print_warning

if TYPE_CHECKING:
    from ..identification.identify import Search
    from ..identification.objective import Objective

NOTHING_BETTER, FAILED, INTERRUPTED = 1, 1, 130
# a process with the model and its targets beyond what it shares, and both modes' landings, at least
BYTES_PER_PROCESS = 30e6
SECONDS_PER_EVALUATION = 6e-3


@click.command(context_settings=HELP_NAMES)
@parameter_options
@click.option(
    "--free",
    metavar="NAME[,NAME...]",
    help="Parameters to identify [default: all that have a prior, see --priors].",
)
@click.option(
    "--bound",
    "bounds",
    metavar="NAME=LO..HI",
    multiple=True,
    help='Bounds for a parameter, SI or with units: "30 mm..60 mm". Repeat.',
)
@click.option(
    "--scalars",
    type=click.Choice(["simulation", "tests"]),
    default="simulation",
    show_default=True,
    help="Scalars to reach: the 48 of the paper's simulation, or the 35 of its tests, "
    "read through the tests' sensor chain.",
)
@click.option(
    "--targets",
    type=click.Path(path_type=Path),
    metavar="FILE.csv",
    help="Measured scalars instead: id,value,unit; with --scalars tests through the same sensors.",
)
@click.option(
    "--series",
    metavar="MODE=FILE.csv",
    multiple=True,
    help="Measured curves: time, then columns named as our outputs, SI. Repeat.",
)
@click.option(
    "--conditions/--no-conditions",
    default=None,
    help="Penalise landings beyond the prototype's limits [default: with the paper's scalars].",
)
@click.option(
    "--work",
    type=click.Path(path_type=Path),
    default=Path("identification"),
    show_default=True,
    help="Folder for state and results.",
)
@click.option(
    "--evaluations",
    default=20000,
    show_default=True,
    type=WholeNumber(1, 10**9),
    metavar="N",
    help="Landings of both modes to try at most.",
)
@click.option(
    "--polish",
    default=2000,
    show_default=True,
    type=WholeNumber(0, 10**9),
    help="Landings for the least squares after the search.",
)
@click.option(
    "--sigma",
    default=0.1,
    show_default=True,
    type=NumberRange(1e-4, 1.0),
    help="First spread of the search, as a part of the bounds.",
)
@click.option(
    "--population",
    default=32,
    show_default=True,
    type=WholeNumber(4, 100_000),
    help="Points a generation.",
)
@click.option(
    "--count",
    default=0,
    show_default=True,
    type=WholeNumber(0, 10**9),
    metavar="N",
    help="Landings for a last search that counts the scalars within 5, 10 and 20 %: "
    "no round of it begins after so many.",
)
@click.option(
    "--seed",
    default=1,
    show_default=True,
    type=WholeNumber(1, 2**31 - 1),
    help="Seed of the search.",
)
@click.option("--workers", type=WholeNumber(1, 1024), help="Processes [default: all cores].")
@click.option("--resume", is_flag=True, help="Continue with the search in --work.")
@click.option(
    "--priors",
    "list_priors",
    is_flag=True,
    help="Print the parameters that can be identified, their bounds and the reasons, and stop.",
)
def identify(work: Path, *, list_priors: bool, **options: Any) -> None:
    """Estimate parameters from peaks, times and curves of landings.

    They are those that the paper does not print, or your own vehicle's. A global search (CMA-ES)
    on all cores is followed by least squares, and with --count by a search that counts the scalars
    within 5, 10 and 20 %; both modes at once. The folder --work gets identified.toml (for
    --parameters) and report.md (fit, numbers at bounds, how well each is determined). It also keeps
    the best point all along: after Ctrl-C, --resume continues. A parameter that is not free keeps
    the value of preset, file and --set. --mode takes one drop test's numbers only; the report then
    predicts the other.

    \b
    rlv-landing identify --work identification --seed 3
    rlv-landing identify --parameters start.toml --evaluations 1 --polish 0 --count 40000
    rlv-landing identify --resume --work identification --evaluations 40000
    rlv-landing identify --parameters mine.toml --targets measured.csv \\
        --free main_strut.orifice_area_compression,ground.friction

    Exit codes: 0 done, 1 nothing better than the start was found, or a full disk, 2 bad input, 130
    interrupted (the best so far is written).
    """
    from ..audit.transverse import joint_warning
    from ..identification.identify import Search
    from ..identification.identify_report import write_report
    from ..presets import to_toml

    if list_priors:
        _print_priors()
        return
    _check_effort(options)
    objective = _objective(options)
    print_warning(joint_warning(map(objective.free.base.for_mode, objective.modes)))
    # SIGTERM ends as Ctrl-C does: with everything written
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with Search(
        objective, work, options["seed"], options["workers"], resume=options["resume"]
    ) as search:
        try:
            finished = _search(search, options)
            search.save()
            best = objective.free.parameters(search.best.z)
            write_durably(work / "identified.toml", to_toml(best).encode())
            if finished:
                write_durably(work / "report.md", write_report(search, best).encode())
        except (OSError, BrokenExecutor) as e:
            _fail(e, work)
    click.echo(
        f"loss {search.best.start_loss:.3f} at the start, {search.best.loss:.3f} at the best of "
        f"{search.best.evaluations} evaluations"
    )
    if search.best.counting:
        click.echo(
            f"misses {search.best.start_missed:.3f} at the start, "
            f"{search.best.missed:.3f} at the best"
        )
    click.echo(f"parameters: {work / 'identified.toml'}")
    if not finished:
        click.echo("interrupted; --resume goes on", err=True)
        sys.exit(INTERRUPTED)
    click.echo(f"report: {work / 'report.md'}")
    if not search.best.improved:
        click.echo(
            "error: nothing better than the start was found; free more, widen --bound, "
            "or try another --seed or --sigma",
            err=True,
        )
        sys.exit(NOTHING_BETTER)


def _check_effort(options: dict[str, Any]) -> None:
    """Refuse more evaluations than 30 days take, and more processes than fit into memory.

    Raises:
        LandingError: They are more.
    """
    from ..effort import check_duration, check_memory
    from ..workers import default_workers

    workers = options["workers"] or default_workers()
    check_memory(
        f"--workers {workers}", BYTES_PER_PROCESS * workers, "leave it out: one for each core"
    )
    count = max(options["evaluations"], options["polish"], options["count"])
    check_duration(
        f"{count} evaluations by {workers} processes",
        SECONDS_PER_EVALUATION * count / min(workers, default_workers()),
        "take fewer: a search ends where it converges, and --resume goes on",
    )


def _fail(error: Exception, work: Path) -> NoReturn:
    """End a search that the disk or the machine does not let go on."""
    reason = (
        f"{work} cannot be written: {error.strerror or error}; make room"
        if isinstance(error, OSError)
        else "a process of the search was killed; take fewer --workers, or free memory"
    )
    click.echo(one_line(f"error: {reason}; --resume goes on from what {work} holds"), err=True)
    sys.exit(FAILED)


def _print_priors() -> None:
    from ..identification.priors import PRIORS

    for p in PRIORS:
        scope = "each mode; " if p.by_mode else ""
        click.echo(f"{p.name:42s} {p.lo:10.4g} ... {p.hi:<10.4g} {scope}{p.reason}")


def _objective(options: dict[str, Any]) -> Objective:
    """The free parameters, targets, curves and conditions that the options choose."""
    from ..identification.conditions import CONDITIONS
    from ..identification.free_numbers import FreeNumbers
    from ..identification.objective import Objective, Series
    from ..identification.targets import paper_targets, read_targets, targets_of_tests
    from ..validation.curves import read_curves

    parameters, modes, _ = choose(
        options["preset"], options["file"], options["mode"], options["pairs"]
    )
    names = options["free"].split(",") if options["free"] else None
    numbers = FreeNumbers(parameters, names, dict(map(_bound, options["bounds"])), modes)
    pairs = [split_pair(pair, "--series") for pair in options["series"]]
    curves = [Series(mode, read_curves(path)) for mode, path in pairs]
    targets, conditions = options["targets"], options["conditions"]
    sensors, count = options["scalars"] == "tests", options["count"]
    if targets:
        wanted = read_targets(targets)
    elif curves:
        wanted = []
    else:
        printed = targets_of_tests() if sensors else paper_targets()
        wanted = [t for t in printed if t.mode in modes]
    if count and not wanted:
        raise LandingError(
            f"--count {count} counts scalars, and there are none; give --targets, or leave it out"
        )
    if conditions is None:
        conditions = not (targets or curves)
    return Objective(numbers, wanted, curves, CONDITIONS if conditions else (), sensors=sensors)


def _search(search: Search, options: dict[str, Any]) -> bool:
    """Search with progress on a terminal; False where it was interrupted."""
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

        try:
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
        except KeyboardInterrupt:
            return False
    return True


def _bound(text: str) -> tuple[str, tuple[float, float]]:
    from ..identification.priors import quantity
    from ..text.values import check_together, to_si

    name, value = split_pair(text, "--bound")
    lo, dots, hi = (part.strip() for part in value.partition(".."))
    if not dots:
        raise LandingError(
            f"--bound {text}: write NAME=LO..HI, for example ground.friction=0.1..0.5, "
            'or with units, main_strut.stroke_max="30 mm..60 mm"'
        )
    q = quantity(name)
    bounds = to_si(q, lo), to_si(q, hi)
    check_together(q, (lo, hi))
    return name, bounds
