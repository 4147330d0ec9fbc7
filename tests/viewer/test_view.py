"""The command `view`: what it serves, what it writes, how it ends, what it refuses."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from ipaddress import ip_address
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import numpy as np
import psutil
import pytest
from bridge_tools import TIMEOUT, environment, new_domain, one_error_line, run, start
from page_pixels import Started
from rerun.chunk import RrdReader

from rlv_landing.history import History
from rlv_ros_bridge.fmu.folder import ProcessFolder
from rlv_ros_bridge.logs.history import log_history
from rlv_ros_bridge.viewer.rerun_scene import curves
from rlv_ros_bridge.viewer.rerun_server import FOLDER_PREFIX


def drawn(path: Path) -> dict[str, tuple[Any, list[Any]]]:
    """The contents of a recording: entity -> times [s] and what is drawn at each of them."""
    found: dict[str, dict[float, Any]] = {}
    for chunk in RrdReader(path).stream():
        if chunk.is_static or "sim_time" not in chunk.timeline_names:
            continue
        batch = chunk.to_record_batch()
        times = batch.column("sim_time").cast("int64").to_numpy() / 1e9
        names = [name for name in batch.schema.names if ":" in name]
        rows = zip(*(batch.column(name).to_pylist() for name in names))
        found.setdefault(str(chunk.entity_path).strip("/"), {}).update(zip(times, rows))
    return {
        entity: (np.array(sorted(rows)), [rows[t] for t in sorted(rows)])
        for entity, rows in found.items()
    }


def assert_curves_are(found: dict[str, tuple[Any, list[Any]]], history: History, mode: str) -> None:
    """Every value of every curve is the history's at the same time, digit for digit."""
    for curve in curves(mode):
        times, rows = found[curve.entity]
        at = np.searchsorted(history.time, times - 1e-9)
        expected = (
            np.stack([history[name][at] for name in curve.lines.values()], axis=-1) * curve.factor
        )
        assert np.array_equal(np.array([row[0] for row in rows]), expected), curve.entity


def test_a_log_becomes_a_recording_with_vehicle_forces_and_curves_at_every_instant(
    log: Path, mode: str, tmp_path: Path
) -> None:
    film = tmp_path / "landing.rrd"
    done = run("view", log, "--save", film)
    assert (done.returncode, done.stderr) == (0, "")
    assert [p.name for p in tmp_path.iterdir()] == [film.name]
    found, history = drawn(film), log_history(log)
    parts = {
        f"vehicle/{part}"
        for part in ("body", "main_struts", "auxiliary_struts", "footpads", "contact_force")
    }
    assert set(found) == parts | {curve.entity for curve in curves(mode)}
    assert {len(times) for times, _ in found.values()} == {len(history)} == {1001}
    assert_curves_are(found, history, mode)
    arrows = [
        dict(zip(("vectors", "origins"), row[::-1])) for row in found["vehicle/contact_force"][1]
    ]
    up = np.array([[vector[2] for vector in row["vectors"]] for row in arrows])
    forces = np.stack([history[f"leg[{leg}].contact.force_y"] for leg in (1, 2, 3, 4)], axis=-1)
    assert np.array_equal(up > 0.0, forces > 0.0)


def test_a_cut_log_is_shown_as_far_as_it_is_whole_and_reported_as_cut(
    one_log: Path, tmp_path: Path
) -> None:
    (whole,) = one_log.glob("*.mcap")
    cut = tmp_path / "cut.mcap.part"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    done = run("view", cut, "--save", tmp_path / "cut.rrd")
    assert done.returncode == 3
    assert done.stderr.strip() == (
        f"warning: {cut} is cut or damaged; what is whole was drawn, "
        "`rlv-landing log recover` saves it"
    )
    history = log_history(cut)
    assert 100 < len(history) < 900
    assert_curves_are(drawn(tmp_path / "cut.rrd"), history, "2-2")


def test_live_topics_are_recorded_as_the_log_has_them(
    fmu: Path, tmp_path: Path, processes: list[subprocess.Popen[str]]
) -> None:
    domain, film = new_domain(), tmp_path / "live.rrd"
    view = start("view", "--save", film, domain=domain)
    processes.append(view)
    assert view.stdout is not None
    assert view.stdout.readline().startswith("waiting for a landing below /landing")
    # What the view says how to start a landing of which it misses nothing.
    program, command, *options = view.stdout.readline().split()
    assert (program, command) == ("rlv-landing", "node")
    node = (
        "node",
        "--fmu",
        fmu,
        "--mode",
        "1-2-1",
        "--record",
        tmp_path / "log",
        "--realtime-factor",
        0.5,
        "--set",
        "ground.slope=0.02",
    )
    done = run(*node, *options, domain=domain)
    assert done.returncode == 0, done.stderr
    view.send_signal(signal.SIGINT)
    _, stderr = view.communicate(timeout=TIMEOUT)
    assert (view.returncode, stderr) == (130, "")
    history, found = log_history(tmp_path / "log"), drawn(film)
    assert_curves_are(found, history, "1-2-1")
    assert len(found["body/pitch"][0]) == 1001
    assert len(found["vehicle/body"][0]) == 32


@pytest.fixture(
    params=[signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=lambda number: number.name
)
def number(request: pytest.FixtureRequest) -> signal.Signals:
    value: signal.Signals = request.param
    return value


def test_the_viewer_is_served_on_this_machine_only_sends_no_data_and_ends_with_the_command(
    one_log: Path, viewing: Callable[..., Started], number: signal.Signals
) -> None:
    view, address, port = viewing(one_log)
    with urlopen(address) as page:
        policy = page.headers["Content-Security-Policy"].split("; ")
    assert f"connect-src 'self' http://127.0.0.1:{port + 1}" in policy
    assert not any("//" in part for part in policy if not part.startswith("connect-src"))
    (program,) = psutil.Process(view.pid).children()
    configuration = Path(program.environ()["XDG_CONFIG_HOME"])
    assert (
        json.loads((configuration / "rerun" / "analytics.json").read_text())["analytics_enabled"]
        is False
    )
    ours, theirs = (
        [c.laddr for c in who.net_connections() if c.status == psutil.CONN_LISTEN]
        for who in (psutil.Process(view.pid), program)
    )
    assert {(place.ip, place.port) for place in ours} == {
        ("127.0.0.1", port),
        ("127.0.0.1", port + 1),
    }
    # Rerun's own server answers any host: it is where no site's page finds it.
    (hidden,) = {ip_address(place.ip) for place in theirs}
    assert hidden.is_loopback
    assert hidden != ip_address("127.0.0.1")
    for served in (port, port + 1):
        asked = Request(f"http://127.0.0.1:{served}/", headers={"Host": "evil.example"})
        with pytest.raises(HTTPError, match="403"):
            urlopen(asked)
    view.send_signal(number)
    assert view.wait(TIMEOUT) == (-number if number is signal.SIGKILL else 128 + number)
    program.wait(TIMEOUT)
    if number is signal.SIGKILL:
        # the next view removes it
        ProcessFolder(FOLDER_PREFIX).remove()
    assert not configuration.exists()
    if number is not signal.SIGKILL:
        assert view.stderr is not None
        assert view.stderr.read() == ""


@pytest.fixture
def used_port() -> Iterator[int]:
    """A port that somebody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (
            ("{log}", "--no-browser", "--port", "{used_port}"),
            "port {used_port} cannot be listened on",
        ),
        (("{log}", "--no-browser", "--port", "80"), "port = 80 is outside [1024, 65534]"),
        (("{folder}/none",), "there is no log"),
        (("{log}", "--mode", "2-2", "--save", "{folder}/a.rrd"), "carries its parameters"),
        (("{log}", "--save", "{folder}/a.mp4"), "must end in .rrd"),
        (("{log}", "--save", "{folder}/there.rrd"), "exists; --force overwrites it"),
        (("--mode", "2-2"), "live topics need no vehicle named"),
    ],
)
def test_bad_options_are_refused_in_one_line(
    one_log: Path, tmp_path: Path, used_port: int, arguments: tuple[str, ...], expected: str
) -> None:
    (tmp_path / "there.rrd").write_bytes(b"mine")
    names = {"log": one_log, "folder": tmp_path, "used_port": used_port}
    done = run("view", *(argument.format(**names) for argument in arguments))
    assert (done.returncode, expected.format(**names) in one_error_line(done)) == (2, True), (
        done.stderr
    )
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("there.rrd", b"mine")]


def test_without_rerun_the_command_says_what_to_install(one_log: Path) -> None:
    hidden = (
        "import sys; sys.modules['rerun'] = None\n"
        "from rlv_ros_bridge.__main__ import run; sys.exit(run())"
    )
    done = subprocess.run(
        [sys.executable, "-c", hidden, "view", one_log],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.returncode == 2
    assert 'pip install "rlv-landing[view]"' in one_error_line(done)


def test_help_shows_without_loading_the_viewer_or_ros(tmp_path: Path) -> None:
    done = run("view", "--help", cwd=tmp_path)
    assert done.returncode == 0
    for taught in (
        "rlv-landing view logs/",
        "--save",
        "--no-browser",
        "--namespace",
        "Ctrl-C",
        "Exit codes: 0",
        "130, 143 or",
    ):
        assert taught in done.stdout
    assert not any(tmp_path.iterdir())
