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
@json_option()
@force_option("Overwrite the report if it exists.")
def validate(
    tests: tuple[str, ...], html: Path | None, *, as_json: bool, force: bool, **options: Any
) -> int:
    """Set landings beside the paper's section 5.

    It prints every printed scalar, the summary measures, and the counts within 5, 10 and 20 %.
    Both drop tests are run unless --mode names one. Errors are on the scale of the paper's
    simulation, near-zero scalars on that of their curve. The exit code is 1 when the counts are
    below those required.

    \b
    rlv-landing validate
    rlv-landing validate --html report.html
    rlv-landing validate --parameters mine.toml --require none --mode 2-2 --test-data drop7.csv
    """
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
