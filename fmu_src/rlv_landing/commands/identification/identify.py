"""`rlv-landing identify`: estimates parameters from printed or measured landings."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from ...signals.handlers import Hold
from ..number_types import NumberRange, WholeNumber
from ..options import HELP_NAMES, choose_symmetric, parameter_options, workers_option
from ..printing import INTERRUPTED, print_warning
from .data import objective_of
from .run import check_effort, run, start_note

NOTHING_BETTER = 1


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
    help="Measured scalars instead: id,value,unit, and mode, weight, scale where needed. An id is "
    "a response of sweeps or a scalar of the paper's. With --scalars tests they are read through "
    "the same sensors.",
)
@click.option(
    "--series",
    metavar="MODE=FILE.csv",
    multiple=True,
    help='Measured curves: time, then columns named as our outputs, SI or "NAME [kN]". Repeat.',
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
@workers_option("Processes")
@click.option("--resume", is_flag=True, help="Continue with the search in --work.")
@click.option(
    "--priors",
    "list_priors",
    is_flag=True,
    help="Print what of the chosen vehicle can be identified, bounds and reasons, and stop.",
)
def identify(work: Path, *, list_priors: bool, **options: Any) -> None:
    """Estimate parameters from peaks, times and curves of landings.

    They are those that the paper does not print, or your own vehicle's. A global search (CMA-ES)
    on all cores is followed by least squares, and with --count by a search that counts the scalars
    within 5, 10 and 20 %; both modes at once. The folder --work gets identified.toml (for
    --parameters) and report.md (fit, numbers at bounds, how well each is determined). It also keeps
    the best point all along: after Ctrl-C, --resume continues. A parameter that is not free keeps
    the value of preset, file and --set. --mode takes one drop test's numbers only; of the paper's
    scalars the report then predicts the other's.

    \b
    The paper's vehicle:
    rlv-landing identify --work identification --seed 3
    rlv-landing identify --parameters start.toml --evaluations 1 --polish 0 --count 40000
    rlv-landing identify --resume --work identification --evaluations 40000

    \b
    Your own vehicle, in four steps:
    1. rlv-landing parameters --toml > mine.toml: write its masses, lengths and first guesses.
    2. rlv-landing identify --parameters mine.toml --priors: what can be free, and its bounds.
       They follow your first guesses; --bound "ground.friction=0.1..0.4" sets others.
    3. measured.csv with your numbers, curves.csv with your curves, or both:
         id,value,unit,mode                          time [ms],leg[1].main_strut.force [kN]
         leg[1].main_strut.force.min,-41,kN,2-2      0.0,-1.2
         leg[3].main_strut.stroke.max,180,mm,2-2     0.2,-1.3
       Times are the landing's: its first contact is at drop.contact_time.
    4. rlv-landing identify --parameters mine.toml --targets measured.csv \\
           --series 2-2=curves.csv \\
           --free main_strut.orifice_area_compression,ground.friction
       Free few numbers; the report says which of them the data determine.

    Exit codes: 0 done, 1 nothing better than the start was found, or a full disk, 2 bad input, 130
    interrupted (the best so far is written).
    """
    from ...audit.transverse import joint_warning
    from ...identification.identify import Search

    if list_priors:
        _print_priors(options)
        return
    check_effort(options)
    objective = objective_of(options)
    print_warning(joint_warning(map(objective.free.base.for_mode, objective.modes)))
    with Hold() as hold:
        search = Search(
            objective, work, options["seed"], options["workers"], resume=options["resume"]
        )
        if not options["resume"] and (note := start_note(objective.free)):
            click.echo(note, err=True)
        fit = run(search, work, options, hold)
    best = search.best
    click.echo(
        f"loss {best.start_loss:.3f} at the start, {best.loss:.3f} at the best of "
        f"{best.evaluations} evaluations"
    )
    if best.counting:
        click.echo(f"misses {best.start_missed:.3f} at the start, {best.missed:.3f} at the best")
    for line in fit or ():
        click.echo(line)
    click.echo(f"parameters: {work / 'identified.toml'}")
    if fit is None:
        click.echo("interrupted; --resume goes on", err=True)
        sys.exit(INTERRUPTED)
    click.echo(f"report: {work / 'report.md'}")
    if not best.improved:
        click.echo(
            "error: nothing better than the start was found; free more, widen --bound, "
            "or try another --seed or --sigma",
            err=True,
        )
        sys.exit(NOTHING_BETTER)


def _print_priors(options: dict[str, Any]) -> None:
    from ...identification.vehicle_priors import priors_of
    from ...tables.prior_table import prior_table

    parameters, modes, _ = choose_symmetric(
        options["preset"], options["file"], options["mode"], options["pairs"]
    )
    click.echo(prior_table(priors_of(parameters, modes[0]).values()), nl=False)
