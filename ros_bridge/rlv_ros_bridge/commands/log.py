"""The commands `rlv-landing log`: info, verify, recover, export. They need no ROS 2."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rlv_landing.commands.number_types import Number
from rlv_landing.commands.options import (
    HELP_NAMES,
    PICTURES,
    WIDE,
    Group,
    check_writable,
    force_option,
    json_option,
    plot_option,
    start_option,
)
from rlv_landing.errors import LandingError, one_line
from rlv_landing.text.durable import writing
from rlv_landing.text.files import shown_name

from ..logs.libraries import require_log_readers

if TYPE_CHECKING:
    from ..logs.reader import LogReader
    from ..logs.rows.instants import RowChoice

EXIT_DIFFERS = 1
EXIT_CUT = 3
LOG = click.argument("log", type=click.Path(path_type=Path))


@click.group(cls=Group, context_settings=HELP_NAMES)
def log() -> None:
    """Look into recorded logs, repeat their runs, rescue what is cut, export. Needs no ROS 2.

    LOG is a log's folder or its .mcap file (.mcap.part: not finished by its writer).
    """


@log.command(context_settings=WIDE)
@LOG
@json_option("Print as JSON: times in s, forces in N, strokes in m, accelerations in m/s2.")
@click.option("--check", is_flag=True, help="Read every byte, and find damage within it.")
def info(log: Path, *, as_json: bool, check: bool) -> None:
    """Show the contents of a log: topics, parameters, outcome and peaks of the landing.

    They come from the log's summary and its record of the landing. A log that lacks them, cut or of
    another program, is read through, as is every log with --check. LOG may be cut, or damaged.

    \b
    Examples:
      rlv-landing log info logs/20260131T120000Z-2-2
      rlv-landing log info run1_0.mcap --json

    Exit codes: 0 complete, 2 no such log or not MCAP, 3 read but cut or damaged.
    """
    require_log_readers()
    from ..logs.bag_reader import open_log
    from ..logs.info import log_info

    found = log_info(open_log(log), check=check)
    click.echo(json.dumps(found.as_dict(), indent=2) if as_json else found.text())
    if not found.complete:
        warn_incomplete_and_exit(log, found.damage)


@log.command(context_settings=WIDE)
@LOG
@click.option(
    "--fmu",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Repeat with this FMU instead of the Python model.",
)
@json_option()
def verify(log: Path, fmu: Path | None, *, as_json: bool) -> None:
    """Repeat the run from the log's own parameters and compare every field of every sample.

    Values are the same bit for bit if the model and the machine are those of the log. Otherwise
    they are within 1 % of each field's largest value, for the smallest difference grows with every
    contact. The output says which applies, and why.

    \b
    Examples:
      rlv-landing log verify logs/20260131T120000Z-2-2
      rlv-landing log verify logs/20260131T120000Z-2-2 --fmu build/RlvLanding.fmu

    Exit codes: 0 the same, 1 differs, 2 the log cannot be repeated.
    """
    require_log_readers()
    from ..logs.bag_reader import open_log
    from ..logs.verification.verify import verify as compare

    found = compare(open_log(log), fmu)
    click.echo(json.dumps(found.as_dict(), indent=2) if as_json else found.text())
    if found.cut:
        click.echo(
            one_line(f"warning: {log} is cut or damaged; what is there was compared"), err=True
        )
    if not found.same:
        sys.exit(EXIT_DIFFERS)


@log.command(context_settings=WIDE)
@LOG
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FOLDER",
    help="Default: beside the log, its name with -recovered.",
)
@json_option()
def recover(log: Path, output: Path | None, *, as_json: bool) -> None:
    """Recover a cut or damaged log: copy all that is whole to a new log that every reader opens.

    A log is cut if its writer was killed.

    \b
    Examples:
      rlv-landing log recover logs/20260131T120000Z-2-2
      rlv-landing log recover run1_0.mcap.part --output rescued

    Exit codes: 0 recovered, or nothing to recover; 2 nothing whole in it, or the new log cannot be
    written.
    """
    require_log_readers()
    from ..logs.recover import recover as restore

    found = restore(log, output)
    if as_json:
        click.echo(json.dumps(found.as_dict(), indent=2))
    elif not found.folder:
        click.echo(f"{log} is complete; nothing to recover")
    else:
        click.echo(found.text())


@log.command(context_settings=WIDE)
@LOG
@click.argument("output", type=click.Path(path_type=Path), required=False)
@click.option(
    "--topics",
    multiple=True,
    metavar="NAME[,NAME...]",
    help="Columns of these topics only, full or relative names. Repeatable.",
)
@start_option()
@click.option("--end", type=Number("s"), metavar="SECONDS", help="Up to this simulation time.")
@click.option(
    "--every",
    type=Number("s"),
    metavar="SECONDS",
    help="Only the first instant in each of these. Default: all.",
)
@plot_option()
@force_option()
def export(
    log: Path,
    output: Path | None,
    *,
    topics: tuple[str, ...],
    plot: Path | None,
    force: bool,
    **span: float | None,
) -> None:
    """Write a landing to OUTPUT, .csv or .parquet, one row for each instant.

    Columns are named as the FMU's variables, SI, in the model's axes. LOG may also be a rosbag2
    recording of the same topics, MCAP or sqlite3; other topics in it are ignored.

    \b
    Examples:
      rlv-landing log export logs/20260131T120000Z-2-2 landing.parquet
      rlv-landing log export run1 struts.csv --topics struts --every 0.01 --end 0.5
      rlv-landing log export recording --plot landing.png

    Exit codes: 0 written, 2 bad input, 3 written but the log is cut or damaged.
    """
    require_log_readers()
    from ..logs.bag_reader import open_log
    from ..logs.rows.instants import RowChoice

    _check_outputs(output, plot, topics, force=force)
    reader = open_log(log)
    notes: list[str] = []
    if output is not None:
        notes = _export_rows(reader, output, split_names(topics), RowChoice(**span))
    if plot is not None:
        notes = _export_picture(reader, plot, shown_name(log), RowChoice(**span))
    for note in notes:
        click.echo(one_line(note), err=True)
    if reader.cut:
        warn_incomplete_and_exit(log, reader.damage)


def _check_outputs(
    output: Path | None, plot: Path | None, topics: tuple[str, ...], *, force: bool
) -> None:
    """Check that there is something to write, and that it can be written.

    Raises:
        LandingError: There is nothing, an ending is wrong, a file exists and `force` is not given,
            or the picture lacks topics.
    """
    from rlv_landing.tables.history_file import ENDINGS

    if output is None and plot is None:
        raise LandingError(
            "nothing to write; name a file OUTPUT.csv or OUTPUT.parquet, or --plot FILE.png|svg|pdf"
        )
    if output is not None and output.suffix not in ENDINGS:
        raise LandingError(f"{output} must end in {' or '.join(ENDINGS)}")
    check_writable(output, output.suffix if output is not None else "", force=force)
    check_writable(plot, PICTURES, force=force)
    if plot is not None and topics:
        raise LandingError("--plot needs every topic; leave --topics out")


def _export_rows(
    reader: LogReader, output: Path, topics: list[str], choice: RowChoice
) -> list[str]:
    """Write the rows of a log to a file; notes on what was left out."""
    from rlv_landing.tables.history_file import Written, write_parts

    from ..fmu.peaks import known_extremes
    from ..logs.rows.parts import HistoryParts, with_parts

    def write(parts: HistoryParts) -> tuple[Written, list[str]]:
        peaks = parts.peaks()
        extremes = known_extremes(peaks) if peaks else None
        return write_parts(parts, output, extremes), parts.notes()

    done, notes = with_parts(reader, topics, choice, write)
    click.echo(
        f"{output}: {done.rows} instants from {done.first:g} s to {done.last:g} s, "
        f"{done.columns} columns"
    )
    return notes


def _export_picture(reader: LogReader, plot: Path, title: str, choice: RowChoice) -> list[str]:
    """Draw the overview of a log's landing to a file; notes on what was left out."""
    from rlv_landing.figures.plots import COLUMNS, save_overview

    from ..logs.history import drawn_history

    history, notes = drawn_history(reader, choice, COLUMNS)
    with writing(plot):
        save_overview(history, plot, title)
    click.echo(f"picture: {plot}")
    return notes


def split_names(texts: tuple[str, ...]) -> list[str]:
    """The names in texts of names that are separated by commas."""
    return [name.strip() for text in texts for name in text.split(",") if name.strip()]


def warn_incomplete_and_exit(log: Path, damage: list[str] | None = None) -> None:
    """Warns that the log is incomplete, and ends the command with its exit code for that.

    Args:
        log: the log as given.
        damage: what is wrong besides a missing end.
    """
    if damage:
        click.echo(
            one_line(
                f"warning: {log} is damaged ({damage[0]}); what is whole was read, "
                "`rlv-landing log recover` saves it"
            ),
            err=True,
        )
    else:
        click.echo(
            one_line(
                f"warning: {log} is cut: its writer did not finish it; all up to there was read"
            ),
            err=True,
        )
    sys.exit(EXIT_CUT)
