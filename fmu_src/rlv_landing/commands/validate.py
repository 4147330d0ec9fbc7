"""`rlv-landing validate`: landings beside section 5 of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import LandingError, unknown
from .options import check_writable, choose_symmetric, force_option, json_option, parameter_options
from .printing import print_checked

if TYPE_CHECKING:
    from ..history import History

# the preset that is identified with the paper's tests, and judged by them
TESTS_PRESET = "yue2022-tests"


@click.command()
@parameter_options
@click.option(
    "--test-data",
    "tests",
    metavar="[MODE=]FILE.csv",
    multiple=True,
    help="Measured curves: first column time [s], then columns named as our outputs, SI. "
    "Name the mode here or by --mode. Repeat.",
)
@click.option(
    "--phase",
    type=click.Choice(["zero", "forward"]),
    default="zero",
    show_default=True,
    help="Phase of the sensors' 100 Hz low-pass.",
)
@click.option(
    "--html",
    metavar="FILE.html",
    type=click.Path(path_type=Path),
    help="Write a report with all figures, one self-contained page.",
)
@click.option(
    "--require",
    metavar="A/B/C",
    help="Least counts within 5, 10, 20 % of the simulation, or none "
    "[default: those that the preset is stated to reach].",
)
@click.option(
    "--case",
    metavar="NAME",
    is_flag=False,
    flag_value="",
    help="Land a case from elsewhere instead, and set its numbers beside ours: one that comes with "
    "the package, all, or a FILE.toml of your own. Without a name: list them.",
)
@click.option(
    "--plot",
    metavar="FILE.png",
    type=click.Path(path_type=Path),
    help="With --case: draw the differences in parts of their tolerances.",
)
@json_option()
@force_option("Overwrite the report or the figure if it exists.")
def validate(
    tests: tuple[str, ...],
    html: Path | None,
    case: str | None,
    plot: Path | None,
    *,
    as_json: bool,
    force: bool,
    **options: Any,
) -> int:
    """Set landings beside the paper's section 5, or beside a case from elsewhere.

    It prints every printed scalar, the summary measures, and the counts within 5, 10 and 20 %.
    Both drop tests are run unless --mode names one. Errors are on the scale of the paper's
    simulation, near-zero scalars on that of their curve. The exit code is 1 when the counts are
    below those required. A case has a vehicle and tolerances of its own; the exit code is 1 when a
    number is beyond its tolerance.

    \b
    rlv-landing validate
    rlv-landing validate --html report.html
    rlv-landing validate --parameters mine.toml --require none --mode 2-2 --test-data drop7.csv
    rlv-landing validate --case
    rlv-landing validate --case three-legs-friction
    """
    if case is not None:
        _refuse_beside_case({**options, "test_data": tests, "html": html})
        return _cases(case, plot, as_json=as_json, force=force)
    if plot is not None:
        raise LandingError("--plot draws the differences of a case: name one by --case")
    from ..validation.required_counts import (
        STATED,
        STATED_OF_TESTS,
        missed_bounds,
        parse_bounds,
        stated_bounds,
    )
    from ..validation.validate import validate as run

    phase, require = options.pop("phase"), options.pop("require")
    check_writable(html, ".html", force=force)
    of_tests = options["preset"] == TESTS_PRESET
    parameters, modes, label = choose_symmetric(**options)
    bounds = (
        None
        if require == "none"
        else stated_bounds(modes, STATED_OF_TESTS if of_tests else STATED)
        if require is None
        else parse_bounds(require)
    )
    found = run(parameters, modes, _measured(tests, modes), phase)
    reached = found.counts_against_test_sensed if of_tests else found.counts
    of = "the paper's tests" if of_tests else "the paper's simulation"
    missed = [] if bounds is None else missed_bounds(reached, bounds, of)
    if html is not None:
        from ..figures.report import write_report

        write_report(found, parameters, html, label, phase)

    def tables() -> str:
        from ..tables.study_tables import validation_tables

        return validation_tables(found)

    levels = ("within_5", "within_10", "within_20")
    record = {
        **found.record(),
        "parameters": label,
        "modes": list(modes),
        "required": None if bounds is None else dict(zip(levels, bounds)),
    }
    return print_checked(record, tables, missed, as_json=as_json)


def _refuse_beside_case(options: dict[str, Any]) -> None:
    """Check that no option of the paper's landings is given beside --case."""
    given = {name: value for name, value in options.items() if name != "phase"}
    names = {"file": "parameters", "pairs": "set", "test_data": "test-data"}
    for name, value in given.items():
        if value:
            raise LandingError(
                f"--{names.get(name, name)} and --case: a case has its own vehicle and numbers; "
                "leave one out"
            )


def _cases(name: str, plot: Path | None, *, as_json: bool, force: bool) -> int:
    """Print the cases that there are, or land one or all of them."""
    from ..cases.case_file import case_names, find_case
    from ..cases.compare import compare
    from ..tables.case_tables import case_list, case_tables

    check_writable(plot, ".png", force=force)
    if not name:
        if plot is not None:
            raise LandingError("--plot needs a case: --case all, or one of those that are listed")
        found = [find_case(known) for known in case_names()]
        record = {"cases": [{"name": c.name, "title": c.title, "source": c.source} for c in found]}
        return print_checked(record, lambda: case_list(found), [], as_json=as_json)
    results = [compare(find_case(n)) for n in (case_names() if name == "all" else [name])]
    if plot is not None:
        from ..figures.case_figure import save_differences

        save_differences(results, plot)
    missed = [line for result in results for line in result.missed]
    return print_checked(
        {"cases": [result.record() for result in results]},
        lambda: case_tables(results, every=name != "all"),
        missed,
        as_json=as_json,
    )


def _measured(tests: tuple[str, ...], modes: tuple[str, ...]) -> dict[str, History]:
    """The measured curves by mode.

    Raises:
        LandingError: A mode is not named, not run, or named twice.
    """
    from ..quantities import MODES
    from ..validation.curves import read_curves

    found: dict[str, History] = {}
    for text in tests:
        mode, equals, path = text.partition("=")
        if not equals:
            if len(modes) > 1:
                raise LandingError(
                    f"--test-data {text}: of which drop test? Write --test-data 2-2={text}, "
                    "or name one with --mode"
                )
            mode, path = modes[0], text
        if mode not in MODES:
            raise unknown("landing mode", mode, MODES)
        if mode not in modes:
            raise LandingError(
                f"--test-data {text}: mode {mode} is not run; leave --mode out or make it {mode}"
            )
        if mode in found:
            raise LandingError(
                f"--test-data {text}: there is a file for mode {mode} already; "
                "put all curves of a drop test into one"
            )
        found[mode] = read_curves(path)
    return found
