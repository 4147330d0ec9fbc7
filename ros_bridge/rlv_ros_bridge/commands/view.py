"""The command `rlv-landing view`: a landing in a browser. Rerun is imported when it runs."""

from __future__ import annotations

import sys
import threading
import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from rlv_landing.commands.number_types import WholeNumber
from rlv_landing.commands.options import WIDE, check_writable, force_option, parameter_options
from rlv_landing.errors import LandingError, reason_of

from ..messages.topics import check_namespace
from ..ros.setup import StopFlag, require_ros
from .landing_source import VehicleOptions, read_landing, warn_incomplete
from .log import EXIT_CUT

PORT, NAMESPACE = 9090, "landing"
# Period of checking for signals [s].
POLL_SECONDS = 0.1


@dataclass(frozen=True)
class ServerOptions:
    """The port of the viewer's page, and whether only its address is printed."""

    port: int
    no_browser: bool


@click.command(context_settings=WIDE)
@click.argument("log", required=False, type=click.Path(path_type=Path))
@parameter_options
@click.option(
    "--namespace",
    metavar="NAME",
    default=NAMESPACE,
    show_default=True,
    help="Without LOG: where the landing publishes.",
)
@click.option(
    "--port",
    type=WholeNumber(),
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
@force_option("Overwrite a file that exists.")
def view(log: Path | None, *, save: Path | None, force: bool, **options: Any) -> None:
    """Show a landing in a browser: the vehicle in space beside force, stroke, pitch and speed.

    Ctrl-C ends it.

    LOG is a log's folder or file, or a rosbag2 recording of the same topics. It is played five
    times slower, in a loop: space pauses, the arrow keys step, the time line moves, curves zoom.
    Without LOG the live topics of a node or of a replay are shown; that needs ROS 2. Options that
    name a vehicle are for recordings that do not carry their parameters.

    The viewer is Rerun's, from the extra `view`. It listens on this machine only. Neither it nor
    the page sends data elsewhere.

    \b
    Examples:
      rlv-landing view logs/20260131T120000Z-2-2
      rlv-landing view logs/20260131T120000Z-2-2 --save landing.rrd     # then: rerun landing.rrd
      rlv-landing view & rlv-landing node --mode 1-2-1 --wait-for-subscribers 1
      rlv-landing view --no-browser --port 9100
          (from elsewhere: ssh -L 9100:127.0.0.1:9100 -L 9101:127.0.0.1:9101 HOST)

    A live recording ends with a signal, or when the landing is reset, and is complete then.

    Exit codes: 0 written, 2 bad input, 3 written but the log is cut or damaged, 130, 143 or
    129 ended by SIGINT, SIGTERM or SIGHUP.
    """
    vehicle = VehicleOptions.pop_from(options)
    server = ServerOptions(options["port"], options["no_browser"])
    namespace = options["namespace"]
    check_namespace(namespace)
    check_writable(save, ".rrd", force=force)
    if log is None and vehicle.is_given:
        raise LandingError(
            "live topics need no vehicle named; leave --preset, --parameters, --mode and --set out"
        )
    require_viewer()
    if log is not None:
        code = _show_log(log, vehicle, save, server)
    elif save is not None:
        code = _save_live(namespace, save)
    else:
        code = _show_live(namespace, server)
    sys.exit(code)


def require_viewer() -> None:
    """Checks that Rerun is installed.

    Raises:
        LandingError: it is missing; the text says what to install.
    """
    try:
        import rerun  # noqa: F401
        import rerun_cli  # noqa: F401
    except ImportError as e:
        raise LandingError(
            f"the viewer is missing ({reason_of(e)}); "
            'install it with pip install "rlv-landing[view]"'
        ) from None


def _show_log(log: Path, vehicle: VehicleOptions, save: Path | None, options: ServerOptions) -> int:
    """Saves or shows the landing in a log; the exit code."""
    from ..viewer.rerun_log import landing_scene
    from ..viewer.rerun_scene import SavedScene

    history, parameters, cut = read_landing(log, vehicle)
    scene = landing_scene(history, parameters)
    if cut:
        warn_incomplete(log)
    if save is not None:
        with SavedScene(save) as saved:
            saved.begin(scene)
            saved.finish()
        click.echo(f"{save}: {len(history)} instants; open it by: rerun {save}")
        return EXIT_CUT if cut else 0
    with StopFlag() as stop, _server(options) as server:
        scene.stream.connect_grpc(server.data, default_blueprint=scene.blueprint(live=False))
        _print_address(server.address, options)
        while not stop and server.check_running():
            stop.wait(POLL_SECONDS)
        scene.stream.disconnect()
    return 128 + stop.number


def _show_live(namespace: str, options: ServerOptions) -> int:
    """Shows live landings until a signal comes; the exit code."""
    require_ros()
    from ..viewer.rerun_live import watch

    shown: list[Any] = []
    with StopFlag() as stop, _server(options) as server:

        def connect(scene: Any) -> None:
            scene.stream.connect_grpc(server.data, default_blueprint=scene.blueprint(live=True))
            shown.append(scene)

        _print_address(server.address, options)
        click.echo(_waiting_text(namespace))
        watch(namespace, connect, server.check_running, stop)
        for scene in shown:
            scene.stream.disconnect()
    return 128 + stop.number


def _save_live(namespace: str, save: Path) -> int:
    """Saves the first live landing; the exit code."""
    require_ros()
    from ..viewer.rerun_live import watch
    from ..viewer.rerun_scene import SavedScene

    landings = 0
    with StopFlag() as stop, SavedScene(save) as saved:

        def save_first(scene: Any) -> None:
            nonlocal landings
            landings += 1
            if landings == 1:
                saved.begin(scene)

        click.echo(f"{_waiting_text(namespace)}\nCtrl-C ends the recording")
        samples = watch(namespace, save_first, lambda: landings < 2, stop)
        if not landings:
            raise LandingError(
                f"nothing was published below /{namespace.strip('/')}; "
                "check --namespace and ROS_DOMAIN_ID"
            )
        saved.finish()
    click.echo(f"{save}: {samples} instants; open it by: rerun {save}")
    return 128 + stop.number if stop else 0


def _waiting_text(namespace: str) -> str:
    """What to start in another terminal, so that nothing of a landing is missed."""
    name = namespace.strip("/")
    chosen = "" if name == NAMESPACE else f" --namespace {name}"
    return (
        f"waiting for a landing below /{name}; one that waits for this view is seen whole:\n"
        f"  rlv-landing node{chosen} --wait-for-subscribers 1\n"
        "  rlv-landing replay LOG --wait-for-subscribers 1"
    )


def _server(options: ServerOptions) -> Any:
    from ..viewer.rerun_server import ViewerServer

    return ViewerServer(options.port)


def _print_address(address: str, options: ServerOptions) -> None:
    click.echo(f"{address}\nCtrl-C ends the view")
    if not options.no_browser:
        # Some browsers return only when they are closed.
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
