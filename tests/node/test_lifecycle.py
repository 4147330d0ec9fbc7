"""The node's lifecycle, services and parameters, from another process."""

from __future__ import annotations

import json
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from bridge_tools import TIMEOUT, complaints, run, start
from remote import ACTIVATE, CLEANUP, CONFIGURE, DEACTIVATE, Remote
from std_msgs.msg import String

from rlv_landing import Landing, load_preset
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.quantities import (
    INPUT_NAMES,
    LEGS,
    OUTPUT_NAMES,
    PEAK_QUANTITIES,
    STATISTIC_QUANTITIES,
)
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.node.settings import settings_of

Processes = list[subprocess.Popen[str]]


@pytest.fixture
def managed(
    fmu: Path, tmp_path: Path, domain: int, processes: Processes
) -> Iterator[tuple[subprocess.Popen[str], Remote]]:
    """A node that waits for transitions, and a participant that makes them.

    Its logs and temporary files are below `tmp_path`.
    """
    (tmp_path / "tmp").mkdir()
    # Its output of a thousand configurations would fill the pipe.
    quiet = ("--ros-args", "--log-level", "warn")
    options = (
        "--managed",
        "--fmu",
        fmu,
        "--realtime-factor",
        0,
        "--log-root",
        tmp_path / "logs",
        *quiet,
    )
    node = start("node", *options, domain=domain, TMPDIR=str(tmp_path / "tmp"))
    processes.append(node)
    with Remote(domain) as remote:
        yield node, remote


def ended(node: subprocess.Popen[str]) -> tuple[int, list[str]]:
    _, err = node.communicate(timeout=TIMEOUT)
    return node.returncode, complaints(err)


def complete(log: Path) -> LogReader:
    """A log that has been read to its end, and is whole."""
    reader = LogReader(log)
    assert list(reader.messages())
    assert not reader.cut
    return reader


def mass(log: Path) -> float:
    parameters = complete(log).parameters()
    assert parameters is not None
    return parameters.vehicle.mass


def test_transitions_load_land_pause_and_free(
    managed: tuple[subprocess.Popen[str], Remote], tmp_path: Path
) -> None:
    node, remote = managed
    assert remote.state() == "unconfigured"
    assert remote.trigger("step") == (False, "there is no landing; configure the node first")
    assert remote.change(CONFIGURE)
    assert remote.state() == "inactive"
    listed = json.loads(remote.first(String, "/landing/variables").data)
    assert [v["name"] for v in listed] == [
        *parameters_of("2-2"),
        *INPUT_NAMES,
        *OUTPUT_NAMES,
        *(q.name for q in (*STATISTIC_QUANTITIES, *PEAK_QUANTITIES)),
    ]
    assert list((tmp_path / "tmp").glob("rlv-landing-fmu-*"))
    assert remote.set(realtime_factor=0.5)[0].successful
    assert remote.change(ACTIVATE)
    success, reason = remote.trigger("step")
    assert not success
    assert "deactivate it" in reason
    assert remote.change(DEACTIVATE)
    success, before = remote.trigger("step")
    assert success
    assert remote.set(step_count=5)[0].successful
    success, after = remote.trigger("step")
    assert success
    assert float(after.split()[1]) == pytest.approx(float(before.split()[1]) + 5e-3, abs=1e-9)
    assert remote.set(realtime_factor=0.0)[0].successful
    assert remote.change(ACTIVATE)
    remote.until(lambda: any((tmp_path / "logs").glob("*/metadata.yaml")))
    assert remote.change(DEACTIVATE)
    assert remote.change(CLEANUP)
    assert remote.state() == "unconfigured"
    assert list((tmp_path / "tmp").glob("rlv-landing-fmu-*")) == []
    remote.shut_down()
    assert ended(node)[0] == 0
    # Paused, stepped and at two paces: the same landing, digit for digit.
    (log,) = (tmp_path / "logs").iterdir()
    found = history_of(complete(log))
    expected = Landing(load_preset("yue2022-figures"), "2-2").run(1.0, 1e-3)
    for name in ("body.y", "body.pitch", "leg[1].main_strut.force", "leg[3].contact.force_z"):
        assert np.array_equal(found[name], expected[name]), name


def test_a_reset_applies_the_parameters_that_were_set_before_it(
    managed: tuple[subprocess.Popen[str], Remote], tmp_path: Path
) -> None:
    node, remote = managed
    assert remote.change(CONFIGURE)
    assert remote.set(step_count=100)[0].successful
    assert remote.trigger("step") == (True, "at 0.1 s")
    assert remote.set(vehicle__mass="0.3 t")[0].successful
    assert remote.get("vehicle.mass") == [300.0]
    assert remote.set(vehicle__mass=200)[0].successful
    assert remote.trigger("reset") == (True, "back to 0 s")
    assert remote.set(step_count=2000)[0].successful
    assert remote.trigger("step") == (True, "at 1 s, finished")
    success, reason = remote.trigger("step")
    assert not success
    assert "~/reset begins another" in reason
    assert remote.change(CLEANUP)
    node.send_signal(signal.SIGTERM)
    assert ended(node)[0] == 143
    first, second = sorted((tmp_path / "logs").iterdir(), key=mass)
    assert (mass(first), mass(second)) == (178.0, 200.0)
    assert (len(history_of(complete(first))), len(history_of(complete(second)))) == (101, 1001)
    expected = Landing(
        load_preset("yue2022-figures").with_values({"vehicle.mass": 200.0}), "2-2"
    ).run(1.0, 1e-3)
    assert np.array_equal(history_of(complete(second))["body.y"], expected["body.y"])


def test_parameters_are_described_checked_and_kept_while_landing(
    managed: tuple[subprocess.Popen[str], Remote],
) -> None:
    node, remote = managed
    assert remote.names() >= {*parameters_of("2-2"), *settings_of(LEGS)}
    (mass,) = remote.describe("vehicle.mass")
    q = PARAMETER_QUANTITIES["vehicle.mass"]
    assert mass.description == f"{q.meaning} [kg]"
    assert (mass.floating_point_range[0].from_value, mass.floating_point_range[0].to_value) == (
        q.lo,
        q.hi,
    )
    for name, value, reason in (
        ("vehicle__mass", -1.0, "vehicle.mass = -1 kg is outside [1, 1e+06] kg"),
        ("vehicle__mass", float("nan"), "vehicle.mass = nan kg is outside [1, 1e+06] kg"),
        ("vehicle__mass", "heavy", "vehicle.mass = 'heavy' is not a number with a unit"),
        (
            "vehicle__transverse_load_at",
            "knee",
            "vehicle.transverse_load_at = 'knee' is not one of footpad, joint",
        ),
        ("main_strut__stroke_max", 1.9, "main_strut.stroke_max = 1.9 m sweeps"),
        ("realtime_factor", -1.0, "realtime_factor = -1 is outside [0, 1000]"),
        ("step_size", 1.0000005e-3, "not a whole number of nanoseconds"),
        ("stop_time", 1e-9, "is below the step of 0.001 s"),
    ):
        (result,) = remote.set(**{name: value})
        assert not result.successful, name
        assert reason in result.reason
    longer = remote.set_together(main_strut__volume_lower=0.01, main_strut__stroke_max=1.9)
    assert longer.successful, longer.reason
    assert remote.get("main_strut.volume_lower", "main_strut.stroke_max") == [0.01, 1.9]
    back = remote.set_together(
        main_strut__volume_lower=0.0003956246382439225,
        main_strut__stroke_max=0.05,
        stop_time=30.0,
        realtime_factor=1.0,
    )
    assert back.successful, back.reason
    assert remote.change(CONFIGURE)
    assert remote.change(ACTIVATE)
    (result,) = remote.set(vehicle__mass=150.0)
    assert not result.successful
    assert "cannot be changed while the node lands" in result.reason
    assert remote.get("vehicle.mass") == [178.0]
    assert remote.set(realtime_factor=0.0)[0].successful
    node.send_signal(signal.SIGINT)
    assert ended(node)[0] == 130


def test_parameters_come_from_a_parameter_file_too(fmu: Path, tmp_path: Path) -> None:
    file = tmp_path / "landing.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n"
        "    stop_time: 0.05\n    vehicle: {mass: 200}\n    drop: {tilt: -0.02}\n"
    )
    done = run(
        "node",
        "--fmu",
        fmu,
        "--realtime-factor",
        0,
        "--record",
        tmp_path / "log",
        "--ros-args",
        "--params-file",
        file,
    )
    assert done.returncode == 0, done.stderr
    parameters = complete(tmp_path / "log").parameters()
    assert parameters is not None
    assert (parameters.vehicle.mass, parameters.drop.tilt) == (200.0, -0.02)


def test_a_failed_configuration_is_reported_and_can_be_corrected(
    managed: tuple[subprocess.Popen[str], Remote], fmu: Path, tmp_path: Path
) -> None:
    node, remote = managed
    assert remote.set(fmu=str(tmp_path / "none.fmu"))[0].successful
    assert not remote.change(CONFIGURE)
    assert remote.state() == "unconfigured"
    assert remote.set(fmu=str(fmu))[0].successful
    assert remote.change(CONFIGURE)
    node.send_signal(signal.SIGINT)
    code, lines = ended(node)
    assert code == 130
    assert len(lines) == 1
    assert "there is no FMU" in lines[0]


def resources(process: int) -> tuple[int, int, int]:
    """Threads, open files, and memory [kB] of a process."""
    status = dict(
        line.split(":", 1) for line in Path(f"/proc/{process}/status").read_text().splitlines()
    )
    return (
        int(status["Threads"]),
        len(list(Path(f"/proc/{process}/fd").iterdir())),
        int(status["VmRSS"].split()[0]),
    )


@pytest.mark.torture
def test_repeated_lifecycles_leave_no_memory_files_or_threads_behind(
    managed: tuple[subprocess.Popen[str], Remote], tmp_path: Path, many: Callable[[int], int]
) -> None:
    node, remote = managed
    cycles = many(20)
    assert remote.set(stop_time=0.02)[0].successful
    before = (0, 0, 0)
    for i in range(cycles):
        assert remote.change(CONFIGURE)
        assert remote.change(ACTIVATE)
        assert remote.change(DEACTIVATE)
        assert remote.change(CLEANUP)
        if i == 4:
            before = resources(node.pid)
    after = resources(node.pid)
    assert after[0] <= before[0]
    assert after[1] <= before[1]
    # pythonfmu itself keeps up to 15 kB of each instance.
    assert after[2] - before[2] < 64 * (cycles - 5) + 4096
    assert list((tmp_path / "tmp").iterdir()) == []
    remote.shut_down()
    assert ended(node) == (0, [])
    assert all((log / "metadata.yaml").is_file() for log in (tmp_path / "logs").iterdir())


def test_the_folder_of_a_killed_node_is_removed_by_the_next(
    fmu: Path, tmp_path: Path, domain: int, processes: Processes
) -> None:
    options = ("--managed", "--fmu", fmu, "--no-record")
    killed = start("node", *options, domain=domain, TMPDIR=str(tmp_path))
    processes.append(killed)
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        (left,) = tmp_path.glob("rlv-landing-fmu-*")
        killed.kill()
        killed.wait(TIMEOUT)
    assert left.is_dir()
    living = start("node", *options, "--namespace", "other", domain=domain, TMPDIR=str(tmp_path))
    processes.append(living)
    with Remote(domain, "/other/landing_node") as remote:
        assert remote.change(CONFIGURE)
        (kept,) = tmp_path.glob("rlv-landing-fmu-*")
        assert kept != left
        # The folder of a running process stays.
        third = run(
            "node", "--fmu", fmu, "--no-record", "--realtime-factor", 0, "--stop-time", 0.01
        )
        assert third.returncode == 0, third.stderr
        assert kept.is_dir()
        living.send_signal(signal.SIGINT)
        assert ended(living) == (130, [])
    assert list(tmp_path.glob("rlv-landing-fmu-*")) == []
