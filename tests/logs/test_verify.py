"""`log verify` repeats the run of a log, and reports the first difference."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from bridge_tools import one_error_line, record, run
from log_tools import (
    assert_bytes_are_known,
    in_attachment,
    in_message,
    in_metadata,
    rewrite,
    small_log,
)
from rclpy.serialization import serialize_message

from rlv_landing import Landing
from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.recover import recover
from rlv_ros_bridge.logs.verification.verify import TOLERANCE, Verification, verify
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.inputs import HEAVE, TILT, WRENCH
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.samples import SampleBytes
from rlv_ros_bridge.messages.topics import APPLIED, APPLIED_GROUND, APPLIED_WRENCH, SAMPLED, Topic
from rlv_ros_bridge.node.input_queue import InputChange

AT = 300_000_000
GROUND = (*HEAVE, *TILT)
# A PoseStamped: encapsulation, stamp, frame "map", and the position from here on.
POSITION = 4 + 8 + 4 + 4


def only_file(log: Path) -> Path:
    (file,) = log.glob("*.mcap")
    return file


def changed(one_log: Path, tmp_path: Path, change: Callable[[Any], Any]) -> Verification:
    return verify(LogReader(rewrite(only_file(one_log), tmp_path / "changed", change)))


def position_x(data: bytes) -> float:
    return float(struct.unpack_from("<d", data, POSITION)[0])


def with_position_x(factor: float) -> Callable[[bytes], bytes]:
    def change(data: bytes) -> bytes:
        changed_data = bytearray(data)
        struct.pack_into("<d", changed_data, POSITION, factor * position_x(data))
        return bytes(changed_data)

    return change


def test_a_log_is_its_run_bit_for_bit_by_the_model_and_by_the_fmu(
    log: Path, fmu: Path, fmu3: Path
) -> None:
    for options in ((), ("--fmu", fmu), ("--fmu", fmu3)):
        done = run("log", "verify", log, *options)
        assert (done.returncode, done.stderr) == (0, "")
        assert "same      bit for bit" in done.stdout
        assert "13013 messages at 1001 instants up to 1 s" in done.stdout
        assert "note" not in done.stdout


def test_messages_after_the_first_are_compared_by_their_bytes(one_log: Path) -> None:
    assert_bytes_are_known(LogReader(one_log))


def test_a_log_of_an_fmu_of_fmi_3_is_its_run_bit_for_bit(fmu3: Path, tmp_path: Path) -> None:
    options = ("--stop-time", "0.3", "--set", "vehicle.mass=190")
    found = verify(LogReader(only_file(record(fmu3, tmp_path / "log", *options))))
    assert (found.instants, found.other_bits, found.not_exact) == (301, 0, "")


def test_one_changed_bit_is_found_with_topic_field_and_time(one_log: Path, tmp_path: Path) -> None:
    before: list[float] = []

    def flip(data: bytes) -> bytes:
        before.append(position_x(data))
        return data[:POSITION] + bytes([data[POSITION] ^ 1]) + data[POSITION + 1 :]

    file = rewrite(only_file(one_log), tmp_path / "changed", in_message("/landing/pose", AT, flip))
    done = run("log", "verify", file, "--json")
    assert done.returncode == 1
    report = json.loads(done.stdout)
    assert not report["same"]
    first = report["first"]
    assert (first["topic"], first["field"], first["time"]) == (
        "/landing/pose",
        "pose.position.x",
        0.3,
    )
    assert first["repeated"] == before[0]
    assert 0.0 < abs(first["recorded"] - first["repeated"]) < 1e-15
    assert (
        "differs   first in /landing/pose at 0.3 s, pose.position.x: "
        in run("log", "verify", file).stdout
    )


@pytest.mark.parametrize("topic", ["/landing/struts", "/landing/leg_3/contact", "/landing/odom"])
def test_a_missing_message_is_found(one_log: Path, tmp_path: Path, topic: str) -> None:
    found = changed(one_log, tmp_path, in_message(topic, AT, lambda data: None))
    assert found.first is not None
    assert (found.first.topic, found.first.time, found.first.recorded) == (topic, 0.3, None)
    assert "missing from the log" in found.text()


def test_a_missing_instant_is_found(one_log: Path, tmp_path: Path) -> None:
    found = changed(
        one_log, tmp_path, lambda r: None if isinstance(r, tuple) and r[1].log_time == AT else r
    )
    assert found.first is not None
    assert (found.first.time, found.first.recorded) == (0.3, None)


def test_a_message_too_many_is_found(one_log: Path, tmp_path: Path) -> None:
    def earlier(record: Any) -> Any:
        if isinstance(record, tuple) and record[0] == "/landing/rpy" and record[1].log_time == AT:
            record[1].log_time -= 1_000_000
        return record

    found = changed(one_log, tmp_path, earlier)
    assert found.first is not None
    assert (found.first.topic, found.first.time, found.first.repeated) == (
        "/landing/rpy",
        0.299,
        None,
    )
    assert "/landing/rpy at 0.299 s: a message more than the repeated run has" in found.text()


def test_huge_times_differ_and_end_the_comparison(one_log: Path, tmp_path: Path) -> None:
    def far(record: Any) -> Any:
        if (
            isinstance(record, tuple)
            and record[0] == "/landing/odom"
            and record[1].log_time == 1_000_000_000
        ):
            record[1].log_time = 2**62 // 1_000_000 * 1_000_000
        return record

    alter, annotate = (
        in_message("/landing/pose", AT, with_position_x(1.0 + 1e-12)),
        in_metadata({"machine": "another", "stop_time": "1e8"}),
    )
    found = changed(one_log, tmp_path, lambda record: annotate(far(alter(record))))
    assert found.first is not None
    assert (found.first.topic, found.first.time) == ("/landing/imu", 1.0)


def test_a_log_of_other_parameters_differs(one_log: Path, tmp_path: Path) -> None:
    def heavier(data: bytes) -> bytes:
        lines = data.decode().splitlines()
        (i,) = [i for i, line in enumerate(lines) if line.startswith("mass = ")]
        lines[i] = "mass = 200.0"
        return "\n".join(lines).encode()

    found = changed(one_log, tmp_path, in_attachment(heavier))
    assert found.first is not None
    assert found.first.recorded != found.first.repeated


@pytest.mark.parametrize(
    ("metadata", "reason"),
    [
        ({"machine": "riscv64 Linux glibc 9.9"}, "on another machine (riscv64 Linux glibc 9.9"),
        ({"model": "0123456789abcdef"}, "by another version of the model"),
        ({"model": None}, "does not say by which model"),
    ],
)
@pytest.mark.parametrize(
    ("factor", "same"), [(1.0, True), (1.0 - 0.5 * TOLERANCE, True), (1.0 - 2.0 * TOLERANCE, False)]
)
def test_another_build_is_compared_within_the_tolerance_and_the_reason_is_reported(
    one_log: Path,
    tmp_path: Path,
    metadata: dict[str, str | None],
    reason: str,
    factor: float,
    *,
    same: bool,
) -> None:
    # The largest value of the field, so that the factor is the share of it.
    reader = LogReader(one_log)
    x = {m.log_time: position_x(m.data) for m in reader.messages(["/landing/pose"])}
    at = max(x, key=lambda time: abs(x[time]))
    alter, annotate = (
        in_message("/landing/pose", at, with_position_x(factor)),
        in_metadata(metadata),
    )
    found = changed(one_log, tmp_path, lambda record: annotate(alter(record)))
    assert found.same == same
    assert reason in found.not_exact
    assert reason in found.text()
    assert ("bit for bit" in found.text()) == (factor == 1.0)


def test_a_cut_log_is_compared_as_far_as_it_goes(one_log: Path, tmp_path: Path) -> None:
    data = only_file(one_log).read_bytes()
    cut = tmp_path / "cut" / "cut_0.mcap.part"
    cut.parent.mkdir()
    cut.write_bytes(data[: len(data) // 2])
    done = run("log", "verify", cut.parent)
    assert done.returncode == 0
    assert "is cut or damaged; what is there was compared" in done.stderr
    assert "of 1 s" in done.stdout
    recovered = verify(LogReader(recover(cut.parent).folder))
    assert recovered.same
    assert 0.2 < recovered.end < 0.8


@pytest.mark.parametrize(
    ("change", "needed"),
    [
        (in_attachment(lambda data: None), "carries no parameters.toml"),
        (in_attachment(lambda data: b"[vehicle]\nmass = 'heavy'"), "parameters.toml: "),
        (in_metadata({"step_size": None}), "do not say step_size"),
        (in_metadata({"step_size": "0.0"}), "step_size = 0 s is not a time above 0 s"),
        (in_metadata({"stop_time": "soon"}), "is not a number of seconds"),
        (in_metadata({"stop_time": "1_0.0"}), "stop_time = '1_0.0' is not a number of seconds"),
        (in_metadata({"step_size": "1e-400"}), "step_size = '1e-400' is not a number of seconds"),
        (in_metadata({"step_size": "\u0661"}), "is not a number of seconds"),
        (in_metadata({"mode": "1-2-1"}), "one was changed"),
        (lambda r: None if isinstance(r, tuple) else r, "cannot be compared: it holds no message"),
    ],
)
def test_what_cannot_be_repeated_is_refused_with_what_is_missing(
    one_log: Path, tmp_path: Path, change: Callable[[Any], Any], needed: str
) -> None:
    with pytest.raises(LandingError) as e:
        changed(one_log, tmp_path, change)
    assert needed in str(e.value)
    assert "\n" not in str(e.value)


def log_with_inputs(whole: Path, folder: Path) -> LogReader:
    """A log as the node writes it, with the parameters of the log `whole` and random inputs.

    The inputs of time 0 are recorded before the first sample.
    """
    reader = LogReader(whole)
    reader.read_through()
    parameters, random = reader.parameters(), Random(7)
    assert parameters is not None
    packer, landing = SampleBytes(Vehicle.of(parameters)), Landing(parameters)
    entries = [
        RecordedTopic(f"/landing/{t.name}", t.type_name, TELEMETRY) for t in (*SAMPLED, *APPLIED)
    ]
    recorder = Recorder(folder, entries, reader.metadata, reader.attachments)
    recorded = [(t, part) for t, part in zip(packer.topics, packer.slices) if t in SAMPLED]

    def change_inputs(k: int) -> None:
        for topic, names, sizes in (
            (APPLIED_WRENCH, WRENCH, (900.0, 400.0, 60.0)),
            (APPLIED_GROUND, GROUND, (1e-3, 0.1, 1e-3, 0.02)),
        ):
            if k == 0 or random.random() < 0.1:
                values = {name: random.uniform(-s, s) for name, s in zip(names, sizes)}
                change = InputChange(topic, k * 1_000_000, values)
                landing.set_inputs(change.values)
                recorder.write(
                    f"/landing/{topic.name}", k * 1_000_000, serialize_message(change.message())
                )

    change_inputs(0)
    for k in range(1001):
        landing.advance_to(k * 1e-3)
        messages = packer.pack(k * 1_000_000, tuple(landing.outputs().values()))
        for topic, part in recorded:
            recorder.write(f"/landing/{topic.name}", k * 1_000_000, messages[part])
        if k:
            change_inputs(k)
    recorder.close()
    return LogReader(folder)


@pytest.mark.parametrize("by_fmu", [False, True])
def test_a_run_with_inputs_is_repeated_bit_for_bit(
    log: Path, fmu: Path, tmp_path: Path, *, by_fmu: bool
) -> None:
    reader = log_with_inputs(log, tmp_path / "inputs")
    found = verify(reader, fmu if by_fmu else None)
    assert (found.first, found.other_bits, found.messages) == (None, 0, 13013)
    assert (
        found.inputs
        == sum(1 for _ in reader.messages([f"/landing/{t.name}" for t in APPLIED]))
        > 150
    )
    assert f"inputs    {found.inputs}, repeated at their times" in found.text()


@pytest.mark.parametrize("topic", [APPLIED_WRENCH, APPLIED_GROUND])
def test_a_run_with_inputs_differs_without_one_of_them(
    one_log: Path, tmp_path: Path, topic: Topic
) -> None:
    changed_log = log_with_inputs(one_log, tmp_path / "inputs")
    times = [m.log_time for m in changed_log.messages([f"/landing/{topic.name}"])]
    assert verify(LogReader(rewrite(changed_log.files[0], tmp_path / "same"))).same
    gone = in_message(f"/landing/{topic.name}", times[len(times) // 2], lambda data: None)
    found = verify(LogReader(rewrite(changed_log.files[0], tmp_path / "gone", gone)))
    assert found.first is not None
    assert found.first.time > times[len(times) // 2] / 1e9


@pytest.mark.parametrize(
    ("log_time", "reason"),
    [
        (500_000_000, "at 0.5 s has the stamp 0.500000001 s; one of the two was changed"),
        (500_000_001, "at 0.500000001 s is not at a sample: those are 0.001 s apart"),
    ],
)
def test_inputs_whose_times_were_changed_are_refused(
    one_log: Path, tmp_path: Path, log_time: int, reason: str
) -> None:
    message = InputChange(APPLIED_WRENCH, 500_000_001, dict.fromkeys(WRENCH, 1.0)).message()
    with pytest.raises(LandingError) as e:
        verify(with_input(one_log, tmp_path / "log", log_time, serialize_message(message)))
    assert reason in str(e.value)


@pytest.mark.parametrize("force", [1e12, math.nan])
def test_inputs_out_of_bounds_are_refused(one_log: Path, tmp_path: Path, force: float) -> None:
    message = InputChange(APPLIED_WRENCH, 500_000_000, dict.fromkeys(WRENCH, force)).message()
    with pytest.raises(LandingError) as e:
        verify(with_input(one_log, tmp_path / "log", 500_000_000, serialize_message(message)))
    expected = "its input /landing/applied/external_wrench at 0.5 s cannot be: "
    assert f"{expected}external.force_x = {force:g} N" in str(e.value)


def test_inputs_of_another_type_are_refused(one_log: Path, tmp_path: Path) -> None:
    with pytest.raises(
        LandingError,
        match="external_wrench is std_msgs/msg/String, not geometry_msgs/msg/WrenchStamped",
    ):
        verify(with_input(one_log, tmp_path / "log", 0, bytes(16), "std_msgs/msg/String"))


def with_input(
    log: Path, folder: Path, log_time: int, data: bytes, type_name: str = APPLIED_WRENCH.type_name
) -> LogReader:
    """A log with the metadata and parameters of `log` that holds one input and nothing else."""
    reader = LogReader(log)
    reader.read_through()
    name = f"/landing/{APPLIED_WRENCH.name}"
    recorder = Recorder(
        folder, [RecordedTopic(name, type_name, TELEMETRY)], reader.metadata, reader.attachments
    )
    recorder.write(name, log_time, data)
    recorder.close()
    return LogReader(folder)


def test_the_command_refuses_logs_that_are_not_of_a_landing(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log")
    done = run("log", "verify", file)
    assert done.returncode == 2
    one_error_line(done)
