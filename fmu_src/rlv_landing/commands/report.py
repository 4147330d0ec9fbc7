"""`rlv-landing report`: a page or a PDF on landings of any vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..text.durable import writing
from .number_types import Number
from .options import (
    HELP_NAMES,
    check_writable,
    chosen_parameters,
    every_option,
    force_option,
    set_option,
)
from .printing import print_warning

if TYPE_CHECKING:
    from ..figures.landing_report.sections import Landed

ENDINGS = (".html", ".pdf")


@click.command(context_settings=HELP_NAMES)
@click.argument("vehicles", metavar="VEHICLE.toml|PRESET...", nargs=-1, required=True)
@click.option(
    "-o",
    "--output",
    metavar="FILE.html|pdf",
    type=click.Path(path_type=Path),
    default="report.html",
    show_default=True,
    help="The report.",
)
@click.option("--mode", metavar="MODE", help="Landing mode of all: 2-2, 1-2-1 or space.")
@set_option()
@click.option(
    "--until", type=Number("s"), metavar="S", help="End time [s] [default: at rest, or lost]."
)
@every_option(5e-4)
@click.option("--audit/--no-audit", default=True, show_default=True, help="Audit each vehicle.")
@force_option("Overwrite the report if it exists.")
def report(
    vehicles: tuple[str, ...], *, output: Path, audit: bool, force: bool, **options: Any
) -> None:
    """Land vehicles and write a report: drawing, outcome, margins, loads, curves, audit.

    Loads are those at both body joints of each leg and at the footpad, six components, each peak
    with what acts at the same time. Several vehicles stand side by side in the first table.

    \b
    rlv-landing report my_stage/vehicle.toml -o stage.html
    rlv-landing report my_stage/vehicle.toml my_hopper/vehicle.toml --mode 1-2-1 -o both.pdf

    Exit codes: 0 written, 2 bad input or a file that cannot be written, 130 interrupted. A missed
    bound of the audit is in the report; `rlv-landing audit` has an exit code for it.
    """
    from ..audit.transverse import warning_of
    from ..figures.landing_report.page import write
    from ..figures.landing_report.sections import side_by_side

    check_writable(output, ENDINGS, force=force)
    landings = [_landed(vehicle, audit=audit, **options) for vehicle in vehicles]
    for found in landings:
        print_warning(warning_of(found.history))
    with writing(output):
        write(landings, output)
    (verdicts,) = [row[1:] for row in side_by_side(landings).rows if row[0] == "audit"]
    for found, verdict in zip(landings, verdicts, strict=True):
        audited = f"; audit: {verdict}" if audit else ""
        click.echo(f"{found.title}: {found.outcome.name} at {found.outcome.time:.3f} s{audited}")
    click.echo(f"report: {output}")


def _landed(
    vehicle: str,
    *,
    mode: str | None,
    pairs: tuple[str, ...],
    until: float | None,
    every: float,
    audit: bool,
) -> Landed:
    """The landing of a vehicle, with the audit of its mode.

    Raises:
        LandingError: There is no such vehicle, or it cannot land.
    """
    from ..audit.audit import audit as audited
    from ..figures.landing_report.sections import Landed
    from ..landing import Landing
    from ..presets import preset_names
    from ..studies.whole_landing import whole_landing

    preset = vehicle if vehicle in preset_names() else None
    parameters = chosen_parameters(preset, None if preset else vehicle, mode, pairs)
    history = whole_landing(Landing(parameters), until, every, decided=until is None)
    found = audited(parameters, (parameters.drop.mode,)) if audit else ()
    return Landed(preset or _name(Path(vehicle)), history, found)


def _name(file: Path) -> str:
    """A file's name, or its folder's where it is the `vehicle.toml` of `rlv-landing new`."""
    return file.resolve().parent.name if file.stem == "vehicle" else file.stem
