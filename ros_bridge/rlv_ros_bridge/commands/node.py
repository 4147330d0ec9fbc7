"""The command `rlv-landing node`. ROS 2, FMPy and MCAP are imported when it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from rlv_landing.choices import parse_pairs
from rlv_landing.commands.number_types import Number, WholeNumber
from rlv_landing.errors import LandingError, one_line
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.text.durable import writing
from rlv_landing.text.files import is_utf8

from ..messages.topics import check_namespace
from ..node.run_summary import EXIT_RECORDING_FAILED, print_summary
from ..ros.arguments import ROS_COMMAND_SETTINGS, split_ros_args


@click.command(context_settings=ROS_COMMAND_SETTINGS)
@click.option(
    "--mode", metavar="2-2|1-2-1|space", help="Landing mode. Default: the parameters' own (2-2)."
)
@click.option(
    "--preset",
    metavar="NAME",
    help="Preset of parameters. Default: the FMU's own vehicle, else yue2022-figures.",
)
@click.option(
    "--parameters",
    "parameters_file",
    metavar="FILE.toml",
    help="Parameters from a TOML file, instead of a preset.",
)
@click.option(
    "--set",
    "changes",
    metavar="NAME=VALUE",
    multiple=True,
    help='Change a parameter (SI, or as "-2 deg"). Repeatable.',
)
@click.option("--fmu", metavar="FILE", help="The FMU to step. Default: that of this installation.")
@click.option(
    "--realtime-factor",
    type=Number(),
    metavar="X",
    help="1: real time (default); 0: as fast as possible.",
)
@click.option(
    "--step",
    "step_size",
    type=Number("s"),
    metavar="SECONDS",
    help="Communication step and publishing period. Default: 0.001.",
)
@click.option(
    "--stop-time", type=Number("s"), metavar="SECONDS", help="End of the landing. Default: 1."
)
@click.option("--record", metavar="FOLDER", help="Record to this folder, which must not exist yet.")
@click.option(
    "--log-root",
    metavar="FOLDER",
    default="logs",
    show_default=True,
    help="Record below this folder, as UTC time and mode.",
)
@click.option("--no-record", is_flag=True, help="Do not record.")
@click.option(
    "--log-must-be-complete",
    is_flag=True,
    help="Wait for a disk that is too slow for the landing, instead of leaving messages out.",
)
@click.option(
    "--namespace",
    metavar="NAME",
    default="landing",
    show_default=True,
    help="Namespace of node and topics.",
)
@click.option(
    "--wait-for-subscribers",
    type=WholeNumber(),
    metavar="N",
    help="Start when N subscriptions on `struts` are matched. Default: 0.",
)
@click.option(
    "--wait-timeout",
    type=Number("s"),
    metavar="SECONDS",
    help="Longest wait for them. Default: 30.",
)
@click.option(
    "--start-delay",
    type=Number("s"),
    metavar="SECONDS",
    help="Wait for so long after that; /clock is held meanwhile. Default: 0.",
)
@click.option(
    "--managed",
    is_flag=True,
    help="Wait for lifecycle transitions by others, and stay, instead of landing at once.",
)
@click.option(
    "--report",
    is_flag=True,
    help="Afterwards print our peaks beside the paper's, and write landing.png beside the log.",
)
@click.argument("ros_args", nargs=-1, type=click.UNPROCESSED)
def node(
    ros_args: tuple[str, ...], *, namespace: str, managed: bool, report: bool, **options: Any
) -> None:
    """Land once as a ROS 2 node: step the FMU, publish every sample, record to MCAP.

    Topics below the namespace: struts, pose, rpy, twist, odom, accel, top/accel, leg_1..4/contact,
    markers; and /clock, /diagnostics. SI units; x forward, y left, z up; stamps are simulation
    time.

    \b
    Examples:
      rlv-landing node --mode 2-2 --report
      rlv-landing node --preset yue2022-table2 --set vehicle.mass=200 --set "drop.tilt=-2 deg"
      rlv-landing node --fmu MyStage.fmu
      rlv-landing node --realtime-factor 0 --record /data/run1
      rlv-landing node --no-record --ros-args --log-level warn
      rlv-landing node --managed --ros-args --params-file landing.yaml

    Exit codes: 0 landed, 1 recording failed on the way or left messages out, 2 bad input, 130, 143
    or 129 after SIGINT, SIGTERM or SIGHUP (the log is complete all the same).
    """
    from ..ros.setup import StopFlag, require_ros

    with StopFlag() as stop:
        passed_on = split_ros_args(ros_args)
        recording = _recording_parameters(options, report=report)
        changes = parse_pairs(options.pop("changes"), PARAMETER_QUANTITIES, "parameter")
        settings = {name: value for name, value in options.items() if value is not None}
        _refuse_other_encodings({**settings, **recording, "namespace": namespace})
        check_namespace(namespace)
        if not settings["log_must_be_complete"]:
            # It may be set among the ROS arguments.
            del settings["log_must_be_complete"]
        if managed:
            settings["autostart"] = False
        require_ros()
        if "fmu" not in settings:
            _build_first_fmu()
        from ..node.land import land

        summary = land({**settings, **recording, **changes}, passed_on, stop, namespace)
    if summary is None:
        sys.exit(128 + stop.number if stop.number else 0)
    print_summary(summary)
    if report and summary.folder is not None:
        try:
            _print_report(summary.folder)
        except LandingError as e:
            if not summary.recording_error:
                raise
            # the disk that was too full for the log is so for the picture
            click.echo(one_line(f"error: {e}"), err=True)
    if summary.signal:
        sys.exit(128 + summary.signal)
    if summary.recording_error or summary.unrecorded:
        sys.exit(EXIT_RECORDING_FAILED)


def _build_first_fmu() -> None:
    """Build the FMU of an installation by pip, which has none before its first landing."""
    from ..fmu.installed import cached_fmu, installed_fmu

    file = installed_fmu()
    if file.is_file() or file != cached_fmu():
        return
    from .fmu import build_default

    click.echo(f"building the FMU, once: {file}")
    build_default(file)


def _refuse_other_encodings(settings: dict[str, Any]) -> None:
    """Refuse texts that are not UTF-8: they become ROS parameters, which are.

    Raises:
        LandingError: a setting is such a text.
    """
    for name, value in settings.items():
        if isinstance(value, str) and not is_utf8(value):
            raise LandingError(
                f"{name} = {value!r} is not UTF-8, as ROS parameters are; rename the file or folder"
            )


def _recording_parameters(options: dict[str, Any], *, report: bool) -> dict[str, str]:
    """The ROS parameters of recording, from the options, which are taken out of `options`.

    Raises:
        LandingError: the options contradict each other.
    """
    record, log_root, no_record = (options.pop(n) for n in ("record", "log_root", "no_record"))
    if no_record and (record or report):
        raise LandingError(
            f"--no-record and {'--record' if record else '--report'} contradict each other; "
            "leave one out"
        )
    if no_record:
        return {}
    return {"record": record} if record else {"log_root": log_root}


def _print_report(folder: Path) -> None:
    from rlv_landing.figures.plots import save_overview
    from rlv_landing.tables.landing import comparison_table, summary_table

    from ..logs.history import measured_history
    from ..logs.info import log_info
    from ..logs.reader import LogReader

    reader = LogReader(folder)
    history = measured_history(reader)
    mode = reader.metadata["mode"]
    landing = log_info(reader).landing or {}
    click.echo(summary_table(history, f"{mode} landing", landing.get("outcome", "")))
    try:
        click.echo(comparison_table(history, mode))
    except LandingError as e:
        click.echo(f"no comparison with the paper: {e}")
    picture = folder / "landing.png"
    with writing(picture):
        save_overview(history, picture, f"{reader.metadata.get('preset', '')}, mode {mode}")
    click.echo(f"picture: {picture}")
