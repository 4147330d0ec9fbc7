"""`rlv-landing identify`: estimates parameters from printed or measured landings."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import click

from ..errors import LandingError
from .options import choose, parameter_options


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@parameter_options
@click.option("--free", metavar="NAME[,NAME...]", help="What to identify [default: all that have a prior, see --priors].")
@click.option("--bound", "bounds", metavar="NAME=LO..HI", multiple=True, help="Bounds for a parameter, SI. Repeat.")
@click.option(
    "--scalars", type=click.Choice(["simulation", "tests"]), default="simulation", show_default=True,
    help="The paper's scalars to reach: the 48 of its simulation, or the 35 of its tests, read through the tests' sensor chain.",
)  # fmt: skip
@click.option("--targets", type=click.Path(path_type=Path), metavar="FILE.csv", help="Measured scalars instead: id,value,unit.")
@click.option(
    "--series", metavar="MODE=FILE.csv", multiple=True, help="Measured curves: time, then columns named as our outputs, SI. Repeat."
)
@click.option(
    "--conditions/--no-conditions",
    default=None,
    help="Hold landings to sense, by the prototype's limits [default: with the paper's scalars].",
)
@click.option(
    "--work", type=click.Path(path_type=Path), default=Path("identification"), show_default=True, help="Folder for state and results."
)
@click.option(
    "--evaluations", default=20000, show_default=True, type=click.IntRange(1), metavar="N", help="Landings of both modes to try at most."
)
@click.option("--polish", default=2000, show_default=True, type=click.IntRange(0), help="Landings for the least squares after it.")
@click.option(
    "--sigma", default=0.1, show_default=True, type=click.FloatRange(1e-4, 1.0), help="First spread of the search, as a part of the bounds."
)
@click.option("--population", default=32, show_default=True, type=click.IntRange(4), help="Points a generation.")
@click.option(
    "--count", default=0, show_default=True, type=click.IntRange(0), metavar="N",
    help="Landings for a last search that counts the scalars within 5, 10 and 20 %: no round of it begins after so many.",
)  # fmt: skip
@click.option("--seed", default=1, show_default=True, type=click.IntRange(1), help="Seed of the search.")
@click.option("--workers", type=click.IntRange(1), help="Processes [default: all cores].")
@click.option("--resume", is_flag=True, help="Go on with the search in --work.")
@click.option("--priors", "list_priors", is_flag=True, help="Print what can be identified, between which bounds and why, and stop.")
def identify(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...], free: str | None, bounds: tuple[str, ...],
    targets: Path | None, series: tuple[str, ...], work: Path, evaluations: int, polish: int, sigma: float, population: int, seed: int,
    workers: int | None, resume: bool, list_priors: bool, conditions: bool | None, scalars: str, count: int,
) -> None:  # fmt: skip
    """Estimate what the paper does not print, or your own vehicle's parameters, from peaks, times and curves of landings.

    A global search (CMA-ES) on all cores, then least squares, then a search that counts (--count); both modes at once. Writes
    identified.toml (take it by --parameters) and report.md (fit, numbers at bounds, how well each is determined) to the folder
    --work, which also keeps the best point all along: Ctrl-C loses nothing, --resume goes on. What is not free stays as preset, file
    and --set say; --mode takes one drop test's numbers only, and the report then predicts the other.

    \b
    rlv-landing identify --work identification --seed 3
    rlv-landing identify --parameters start.toml --evaluations 1 --polish 0 --count 40000
    rlv-landing identify --resume --work identification --evaluations 40000
    rlv-landing identify --parameters mine.toml --targets measured.csv --free main_strut.orifice_area_compression,ground.friction

    Exit codes: 0 done, 1 nothing better than the start was found, 2 bad input, 130 interrupted (the best so far is written).
    """
    from tqdm import tqdm

    from ..curves import read_curves
    from ..presets import to_toml
    from ..studies.identify import Search
    from ..studies.identify_report import write_report
    from ..studies.objective import CONDITIONS, Objective, Series, paper_targets, read_targets, targets_of_tests
    from ..studies.priors import PRIORS, FreeNumbers

    if list_priors:
        for p in PRIORS:
            click.echo(f"{p.name:42s} {p.lo:10.4g} ... {p.hi:<10.4g} {'each mode; ' if p.by_mode else ''}{p.reason}")
        return
    parameters, modes, _ = choose(preset, file, mode, pairs)
    numbers = FreeNumbers(parameters, free.split(",") if free else None, dict(map(_bound, bounds)), modes)
    curves = [Series(which, read_curves(path)) for which, path in map(_pair, series)]
    printed = targets_of_tests() if scalars == "tests" else paper_targets()
    wanted = read_targets(targets) if targets else [] if curves else [t for t in printed if t.mode in modes]
    if count and not wanted:
        raise LandingError(f"--count {count} counts scalars, and there are none; give --targets, or leave it out")
    interrupted = False
    # SIGTERM ends as Ctrl-C does: with everything written
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    held = CONDITIONS if (conditions if conditions is not None else not (targets or curves)) else ()
    objective = Objective(numbers, wanted, curves, held, sensors=scalars == "tests")
    with Search(objective, work, seed, workers, resume) as search:
        bar_format = "{desc} {percentage:3.0f}%|{bar}| {n}/{total} [{elapsed}<{remaining}] {postfix}"
        with tqdm(total=evaluations, initial=search.best.evaluations, disable=not sys.stderr.isatty(), bar_format=bar_format) as bar:

            def tell(done: int, loss: float) -> None:
                bar.total = max(bar.total or 0, done)
                bar.update(done - bar.n)
                bar.set_postfix_str(f"loss {loss:.2f}")

            try:
                if not search.counting:
                    bar.set_description_str("global search")
                    search.explore(evaluations, tell, sigma, population)
                    if polish:
                        bar.set_description_str("least squares")
                        bar.total = search.best.evaluations + polish
                        search.polish(polish, tell)
                if count:
                    bar.set_description_str("counting search")
                    bar.total = search.best.evaluations + count - search.best.counted
                    search.count(count, tell)
            except KeyboardInterrupt:
                interrupted = True
        search.save()
        best = numbers.parameters(search.best.z)
        (work / "identified.toml").write_text(to_toml(best), encoding="utf-8")
        if not interrupted:
            (work / "report.md").write_text(write_report(search, best), encoding="utf-8")
    click.echo(f"loss {search.start_loss:.3f} at the start, {search.best.loss:.3f} at the best of {search.best.evaluations} evaluations")
    click.echo(f"parameters: {work / 'identified.toml'}" + ("" if interrupted else f"\nreport: {work / 'report.md'}"))
    if interrupted:
        click.echo("interrupted; --resume goes on", err=True)
        sys.exit(130)
    if search.counting:
        click.echo(f"misses {search.start_missed:.3f} at the start, {search.best.missed:.3f} at the best")
    if not search.improved:
        click.echo("error: nothing better than the start was found; free more, widen --bound, or try another --seed or --sigma", err=True)
        sys.exit(1)


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals:
        raise LandingError(f"{text!r} has no '='; write NAME=VALUE")
    return name.strip(), value.strip()


def _bound(text: str) -> tuple[str, tuple[float, float]]:
    name, value = _pair(text)
    lo, dots, hi = value.partition("..")
    try:
        return name, (float(lo), float(hi if dots else "x"))
    except ValueError:
        raise LandingError(f"--bound {text}: write NAME=LO..HI with two numbers in SI, for example ground.friction=0.1..0.5") from None
