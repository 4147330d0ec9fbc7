"""Bad input to the bridge's commands: one clear line, an exit code, nothing left behind."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from bridge_tools import one_error_line, run

from rlv_landing.cli import cli
from rlv_landing.errors import LandingError
from rlv_ros_bridge.fmu.builds import build_metadata
from rlv_ros_bridge.messages.topics import check_namespace

NODE_CASES: dict[str, tuple[tuple[str, ...], str]] = {
    "unknown parameter": (("--set", "vehicle.mas=1"), "did you mean vehicle.mass?"),
    "parameter out of bounds": (
        ("--set", "vehicle.mass=-1"),
        "vehicle.mass = -1 kg is outside [1, 1e+06] kg",
    ),
    "parameter not a number": (("--set", "vehicle.mass=nan"), "vehicle.mass = nan kg is outside"),
    "parameter in another unit": (
        ("--set", "vehicle.mass=3 m"),
        "vehicle.mass = '3 m' has the wrong unit",
    ),
    "parameter without value": (("--set", "vehicle.mass"), "has no '='"),
    "parameters that do not fit together": (
        ("--set", "main_strut.stroke_max=1.9"),
        "main_strut.stroke_max = 1.9 m",
    ),
    "negative step": (("--step", "-0.001"), "step_size = -0.001"),
    "step not a number": (("--step", "nan"), "step_size = nan"),
    "step of half a nanosecond": (("--step", "0.0010000005"), "not a whole number of nanoseconds"),
    "stop before the first step": (("--stop-time", "0"), "stop_time = 0 s is below the step"),
    "real-time factor of months": (
        ("--realtime-factor", "1e-7"),
        "at realtime_factor = 1e-07 would take 116 days at least",
    ),
    "name that is no namespace": (("--namespace", "1x"), "namespace '1x' is none of ROS 2's"),
    "negative real-time factor": (("--realtime-factor", "-1"), "realtime_factor = -1 is outside"),
    "unknown mode": (("--mode", "2-1"), "unknown landing mode '2-1'"),
    "unknown preset": (("--preset", "yue2022-figure"), "did you mean yue2022-figures?"),
    "preset and file": (("--preset", "yue2022-figures", "--parameters", "x.toml"), "not both"),
    "missing parameter file": (
        ("--parameters", "nosuch.toml"),
        "there is no parameter file nosuch.toml",
    ),
    "unknown option": (("--step-size", "1"), "unknown argument '--step-size'"),
    "unknown ROS parameter": (
        ("--ros-args", "-p", "vehicle.masss:=3.0"),
        "did you mean vehicle.mass?",
    ),
    "ROS parameter of the wrong type": (
        ("--ros-args", "-p", "vehicle.mass:=heavy"),
        "vehicle.mass = 'heavy' is not a number",
    ),
    "ROS parameter in another unit": (
        ("--ros-args", "-p", "drop.tilt:='-2 m'"),
        "drop.tilt = '-2 m' has the wrong unit",
    ),
    "ROS parameter with a decimal comma": (
        ("--ros-args", "-p", "drop.tilt:='-1,5 deg'"),
        "write a point instead of the comma: -1.5 deg",
    ),
    "report without a record": (("--no-record", "--report"), "contradict each other"),
    "no subscribers in time": (
        ("--wait-for-subscribers", "1", "--wait-timeout", "0.1"),
        "only 0 of 1 subscribers",
    ),
}


@pytest.mark.parametrize(
    "name", ["a//b", "a/", "~", "a-b", "{x}", "1x", "a/1", "\u00e4", "a" * 300]
)
def test_names_that_ros_does_not_take_are_refused_before_it_starts(name: str) -> None:
    with pytest.raises(LandingError, match="is none of ROS 2's; write at most 200 letters"):
        check_namespace(name)
    for command in ("view", "node"):
        with pytest.raises(LandingError, match="is none of ROS 2's"):
            cli.main([command, "--namespace", name], standalone_mode=False)


@pytest.mark.parametrize("name", ["", "/", "a", "/a", "a/b_1/_c"])
def test_names_that_ros_takes_are_taken(name: str) -> None:
    check_namespace(name)


@pytest.mark.parametrize("case", NODE_CASES)
def test_node_refuses(case: str, fmu: Path, tmp_path: Path) -> None:
    arguments, message = NODE_CASES[case]
    done = run("node", "--fmu", fmu, "--realtime-factor", "0", *arguments, cwd=tmp_path)
    assert message in one_error_line(done)
    assert done.returncode == 2
    assert list(tmp_path.iterdir()) == []


def test_node_refuses_what_is_not_our_fmu(fmu: Path, tmp_path: Path) -> None:
    text, archive, foreign = (
        tmp_path / "text.fmu",
        tmp_path / "archive.fmu",
        tmp_path / "foreign.fmu",
    )
    text.write_text("not a zip")
    with zipfile.ZipFile(archive, "w") as z:
        z.writestr("readme.txt", "no model here")
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(foreign, "w") as z:
        z.writestr(
            "modelDescription.xml",
            source.read("modelDescription.xml")
            .replace(b'modelName="RlvLanding"', b'modelName="Pendulum"')
            .replace(b'generationTool="rlv-landing', b'generationTool="pendulums'),
        )
    for path, message in (
        (tmp_path / "missing.fmu", "there is no FMU"),
        (text, "is not an FMU"),
        (archive, "is not an FMU"),
        (foreign, "holds the model 'Pendulum', which is not of rlv-landing"),
    ):
        done = run("node", "--fmu", path, "--record", tmp_path / "log")
        line = one_error_line(done)
        assert message in line
        assert path.name in line
        assert done.returncode == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["archive.fmu", "foreign.fmu", "text.fmu"]


def test_a_device_or_a_damaged_archive_has_no_model(fmu: Path, tmp_path: Path) -> None:
    data = bytearray(fmu.read_bytes())
    data[: len(data) * 3 // 4] = bytes(len(data) * 3 // 4)
    damaged = tmp_path / "damaged.fmu"
    damaged.write_bytes(data)
    assert build_metadata(fmu)["model"]
    for path in (Path("/dev/zero"), damaged, tmp_path):
        assert build_metadata(path)["model"] == ""


def test_node_never_overwrites_and_says_what_cannot_be_written(fmu: Path, tmp_path: Path) -> None:
    existing, file = tmp_path / "existing", tmp_path / "file"
    existing.mkdir()
    file.write_text("here")
    done = run("node", "--fmu", fmu, "--record", existing)
    assert "exists; logs are never overwritten" in one_error_line(done)
    assert done.returncode == 2
    done = run("node", "--fmu", fmu, "--log-root", file / "logs")
    assert "cannot be made" in one_error_line(done)
    assert done.returncode == 2
    assert list(existing.iterdir()) == []
    assert file.read_text() == "here"


def test_replay_refuses(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")
    text, empty = tmp_path / "text.mcap", tmp_path / "empty.mcap"
    text.write_text("this is not MCAP at all")
    empty.touch()
    for arguments, message in (
        ((tmp_path / "missing",), "there is no log"),
        ((tmp_path,), "text.mcap is not MCAP"),
        ((text,), "is not MCAP"),
        ((empty,), "is empty"),
        ((one_log, "--topics", "strust"), "unknown topic 'strust'; did you mean struts?"),
        ((one_log, "--rate", "0"), "--rate = 0 is outside"),
        ((one_log, "--rate", "nan"), "--rate = nan is outside"),
        ((one_log, "--start", "7"), "the log is 1 s long"),
        ((one_log, "--duration", "-1"), "--duration = -1 s must be above 0 s"),
        ((whole, "more"), "unknown argument 'more'"),
        ((one_log, "--remap", "struts"), "--remap 'struts' is not OLD:=NEW"),
        ((one_log, "--remap", "strust:=a"), "unknown topic 'strust'; did you mean struts?"),
        (
            (one_log, "--remap", "struts:=a", "--remap", "/landing/struts:=b"),
            "two names, 'a' and 'b'",
        ),
        ((one_log, "--remap", "struts:=pose"), "cannot both be played as /landing/pose"),
        ((one_log, "--remap", "struts:=2 b"), "'/landing/2 b' cannot be a topic: "),
        (
            (one_log, "--topics", "pose", "--remap", "struts:=a"),
            "is not among the topics chosen by --topics",
        ),
    ):
        if message.startswith("text.mcap"):
            empty.unlink()
        done = run("replay", *arguments)
        assert message in one_error_line(done), arguments
        assert done.returncode == 2
        if not empty.exists():
            empty.touch()
