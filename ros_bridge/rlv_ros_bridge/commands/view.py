"""The command `rlv-landing view`: a log, or the landing that runs at present, in a browser.

What it needs is imported when it runs.
"""

from __future__ import annotations

import sys
import threading
import webbrowser
from pathlib import Path
from typing import Any

import click

from rlv_landing.commands.options import check_writable, parameter_options
from rlv_landing.errors import LandingError

from ..ros.interruption import ends_tidily
from ..ros.setup import StopFlag, require_ros
from .animate import landing_of_log, tell_drawn
from .log import EXIT_CUT, WIDE

PORT = 9090
# How often signals are looked after [s].
LOOK_ROUND_SECONDS = 0.1


@click.command(context_settings=WIDE)
@click.argument("log", required=False, type=click.Path(path_type=Path))
@parameter_options
@click.option(
    "--namespace",
    metavar="NAME",
    default="landing",
    show_default=True,
    help="Without LOG: where the landing publishes.",
)
@click.option(
    "--port",
    type=int,
    metavar="N",
    default=PORT,
    show_default=True,
    help="Serve the page at N and its data at N + 1.",
)
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@click.option(
    "--save",
    type=click.Path(path_type=Path),
    metavar="FILE.rrd",
    help="Write a recording for the Rerun viewer, serve nothing.",
)
@click.option("--force", is_flag=True, help="Overwrite a file that exists.")
def view(
    log: Path | None, preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...],
    namespace: str, port: int, no_browser: bool, save: Path | None, force: bool,
) -> None:  # fmt: skip
    """Show a landing in a browser: the vehicle in space beside force, stroke, pitch and speed.

    Ctrl-C ends it.

    LOG is a log's folder or file, or a rosbag2 recording of the same topics; it is played five
    times slower, in a loop: space pauses, the arrow keys step, the time line moves, curves zoom.
    Without LOG the live topics are shown, of a node or of a replay; that needs ROS 2. Options that
    name a vehicle are for recordings that do not carry their parameters.

    The viewer is Rerun's, from the extra `view`. It listens on this machine only, and neither it
    nor the page tells anybody anything.

    \b
    Examples:
      rlv-landing view logs/20260131T120000Z-2-2
      rlv-landing view logs/20260131T120000Z-2-2 --save landing.rrd     # then: rerun landing.rrd
      rlv-landing view & rlv-landing node --mode 1-2-1
      rlv-landing view --no-browser --port 9100        # from elsewhere: ssh -L 9100:127.0.0.1:9100 -L 9101:127.0.0.1:9101 HOST

    A live recording ends with a signal, or when the landing is reset, and is complete then.

    Exit codes: 0 written, 2 bad input, 3 written but the log is cut or damaged, 130 or 143 ended by
        SIGINT or SIGTERM.
    """
    given = (preset, file, mode, pairs)
    check_writable(save, ".rrd", force=force)
    if log is None and any(given):
        raise LandingError(
            "live topics need no vehicle named; leave --preset, --parameters, --mode and --set out"
        )
    require_viewer()
    with ends_tidily():
        if log is None:
            ended = (
                _record(namespace, save) if save is not None else _show(namespace, port, no_browser)
            )
        else:
            ended = _show_log(log, given, save, port, no_browser)
    sys.exit(ended)


def require_viewer() -> None:
    """Raises LandingError, saying what to install, unless Rerun is there."""
    try:
        import rerun  # noqa: F401
        import rerun_cli  # noqa: F401
    except ImportError as e:
        raise LandingError(
            f'the viewer is missing ({e}); install it with pip install "rlv-landing[view]"'
        ) from None


def _show_log(
    log: Path, given: tuple[Any, ...], save: Path | None, port: int, no_browser: bool
) -> int:
    from ..viewer.rerun_log import scene_of
    from ..viewer.rerun_scene import SavedScene

    history, parameters, cut = landing_of_log(log, given)
    scene = scene_of(history, parameters)
    if cut:
        tell_drawn(log)
    if save is not None:
        with SavedScene(save) as saved:
            saved.begin(scene, live=False)
            saved.finish()
        click.echo(f"{save}: {len(history)} instants; open it by: rerun {save}")
        return EXIT_CUT if cut else 0
    with StopFlag() as stop, _server(port) as server:
        scene.stream.connect_grpc(server.data, default_blueprint=scene.blueprint(live=False))
        _tell(server.address, no_browser)
        while not stop and server.runs():
            stop.wait(LOOK_ROUND_SECONDS)
        scene.stream.disconnect()
    return 128 + stop.number


def _show(namespace: str, port: int, no_browser: bool) -> int:
    require_ros()
    from ..viewer.rerun_live import watch

    shown: list[Any] = []
    with StopFlag() as stop, _server(port) as server:

        def begin(scene: Any) -> None:
            scene.stream.connect_grpc(server.data, default_blueprint=scene.blueprint(live=True))
            shown.append(scene)

        _tell(server.address, no_browser)
        click.echo(f"waiting for a landing below /{namespace.strip('/')}")
        watch(namespace, begin, server.runs, stop)
        for scene in shown:
            scene.stream.disconnect()
    return 128 + stop.number


def _record(namespace: str, save: Path) -> int:
    require_ros()
    from ..viewer.rerun_live import watch
    from ..viewer.rerun_scene import SavedScene

    landings = 0
    with StopFlag() as stop, SavedScene(save) as saved:

        def begin(scene: Any) -> None:
            nonlocal landings
            landings += 1
            if landings == 1:
                saved.begin(scene, live=False)

        click.echo(
            f"waiting for a landing below /{namespace.strip('/')}; Ctrl-C ends the recording"
        )
        samples = watch(namespace, begin, lambda: landings < 2, stop)
        if not landings:
            raise LandingError(
                f"nothing was heard below /{namespace.strip('/')}; check --namespace and ROS_DOMAIN_ID"
            )
        saved.finish()
    click.echo(f"{save}: {samples} instants; open it by: rerun {save}")
    return 128 + stop.number if stop else 0


def _server(port: int) -> Any:
    from ..viewer.rerun_server import ViewerServer

    return ViewerServer(port)


def _tell(address: str, no_browser: bool) -> None:
    click.echo(f"{address}\nCtrl-C ends the view")
    if not no_browser:
        # Some browsers keep who opened them waiting.
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
