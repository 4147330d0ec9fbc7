"""`rlv-landing validate`: the paper's section 5 anew."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import LandingError, unknown
from .options import check_writable, choose, parameter_options

if TYPE_CHECKING:
    from ..history import History

FAILED = 1


@click.command()
@parameter_options
@click.option(
    "--test-data", "tests", metavar="[MODE=]FILE.csv", multiple=True,
    help="Measured curves: first column time [s], then columns named as our outputs, SI. Name the mode here or by --mode. Repeat.",
)  # fmt: skip
@click.option(
    "--phase", type=click.Choice(["zero", "forward"]), default="zero", show_default=True, help="Phase of the sensors' 100 Hz low-pass."
)
@click.option(
    "--html", metavar="FILE.html", type=click.Path(path_type=Path), help="Write a report with all figures, one self-contained page."
)
@click.option(
    "--require", metavar="A/B/C",
    help="Least counts within 5, 10, 20 % of the simulation (with --preset yue2022-tests: of the tests, through their sensors), or none "
    "[default: what yue2022-figures, or yue2022-tests, is stated to reach].",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
@click.option("--force", is_flag=True, help="Overwrite the report if it exists.")
def validate(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...], tests: tuple[str, ...], phase: str, html: Path | None,
    require: str | None, as_json: bool, force: bool,
) -> int:  # fmt: skip
    """Set landings beside the paper's section 5: every printed scalar, the summary measures, counts within 5, 10 and 20 %.

    Both drop tests unless --mode names one. Errors are on the scale of the paper's simulation, near-zero scalars on that of their curve.
    Exit code 1 when the counts are below those required.

    \b
    rlv-landing validate
    rlv-landing validate --html report.html
    rlv-landing validate --parameters mine.toml --require none --mode 2-2 --test-data drop7.csv
    """
    from ..studies.validate import STATED, STATED_OF_TESTS, missed_bounds, parse_bounds, stated_bounds
    from ..studies.validate import validate as run

    check_writable(html, ".html", force)
    parameters, modes, label = choose(preset, file, mode, pairs)
    of_tests = preset == "yue2022-tests"
    stated = stated_bounds(modes, STATED_OF_TESTS if of_tests else STATED)
    bounds = None if require == "none" else stated if require is None else parse_bounds(require)
    measured = _measured(tests, modes)
    found = run(parameters, modes, measured, "forward" if phase == "forward" else "zero")
    reached, of = (found.counts_against_test_sensed, "the paper's tests") if of_tests else (found.counts, "the paper's simulation")
    missed = [] if bounds is None else missed_bounds(reached, bounds, of)
    if html is not None:
        from ..report import write_report

        write_report(found, parameters, html, label, phase)
    if as_json:
        required = None if bounds is None else dict(zip(("within_5", "within_10", "within_20"), bounds))
        record = {**found.record(), "parameters": label, "modes": list(modes), "required": required, "missed": missed}
        click.echo(json.dumps(record, indent=1, allow_nan=False))
    else:
        from ..study_tables import validation_tables

        click.echo(validation_tables(found), nl=False)
    for line in missed:
        click.echo(f"missed: {line}", err=True)
    return FAILED if missed else 0


def _measured(tests: tuple[str, ...], modes: tuple[str, ...]) -> dict[str, History]:
    """The measured curves by mode. Raises LandingError where a mode is not named, not run, or named twice."""
    from ..curves import read_curves
    from ..quantities import MODES

    found: dict[str, History] = {}
    for text in tests:
        mode, equals, path = text.partition("=")
        if not equals:
            if len(modes) > 1:
                raise LandingError(f"--test-data {text}: of which drop test? Write --test-data 2-2={text}, or name one with --mode")
            mode, path = modes[0], text
        if mode not in MODES:
            raise unknown("landing mode", mode, MODES)
        if mode not in modes:
            raise LandingError(f"--test-data {text}: mode {mode} is not run; leave --mode out or make it {mode}")
        if mode in found:
            raise LandingError(f"--test-data {text}: there is a file for mode {mode} already; put all curves of a drop test into one")
        found[mode] = read_curves(path)
    return found
