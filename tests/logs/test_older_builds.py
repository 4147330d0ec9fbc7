"""FMUs of older versions, which lack later quantities, repeat their own logs bit for bit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
from geometry_msgs.msg import WrenchStamped
from log_tools import rewrite
from rclpy.serialization import deserialize_message, serialize_message

from rlv_landing.errors import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_ros_bridge.fmu.builds import build_metadata
from rlv_ros_bridge.fmu.runner import FmuRunner
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.topics import CONTACTS, IMU, TOP_IMU, resolve

OF_LATER_VERSIONS = (
    "energy.friction",
    "peak.leg[1].contact.force.max",
    "peak.leg[1].contact.force.max_time",
    "solver.max_steps_per_second",
)


def without_variables(fmu: Path, target: Path, *names: str) -> Path:
    """A copy of an FMU that has other names for some variables, so that it lacks those."""
    with ZipFile(fmu) as source, ZipFile(target, "w") as archive:
        for entry in source.namelist():
            data = source.read(entry)
            if entry == "modelDescription.xml":
                for name in names:
                    assert data.count(f'name="{name}"'.encode()) == 1
                    data = data.replace(f'name="{name}"'.encode(), f'name="z.{name}"'.encode())
            archive.writestr(entry, data)
    return target


def test_an_older_fmu_without_later_quantities_repeats_its_logs_bit_for_bit(
    one_log: Path, fmu: Path, tmp_path: Path
) -> None:
    older = without_variables(fmu, tmp_path / "older.fmu", *OF_LATER_VERSIONS)
    reader = LogReader(one_log)
    found = verify(reader, older)
    assert (found.same, found.other_bits, found.not_exact) == (True, 0, "")
    assert found.values == verify(reader, fmu).values
    assert found.peaks == verify(reader, fmu).peaks - 1


def test_an_older_fmu_without_a_compared_output_is_refused_by_its_name(
    one_log: Path, fmu: Path, tmp_path: Path
) -> None:
    older = without_variables(fmu, tmp_path / "older.fmu", "body.ax")
    with pytest.raises(LandingError, match=r"has no variable 'body\.ax'"):
        verify(LogReader(one_log), older)


def test_an_older_fmu_takes_no_parameter_and_no_input_that_it_lacks(
    fmu: Path, tmp_path: Path
) -> None:
    older = without_variables(fmu, tmp_path / "older.fmu", "ground.friction", "ground.heave")
    with pytest.raises(LandingError, match=r"has no variable 'ground\.friction'"):
        FmuRunner(older, {"ground.friction": 0.4}, needed=())
    default = PARAMETER_QUANTITIES["ground.friction"].default
    with FmuRunner(older, {"ground.friction": default}, needed=()) as runner:
        runner.set_inputs({"external.force_x": 1.0})
        with pytest.raises(LandingError, match=r"has no variable 'ground\.heave'"):
            runner.set_inputs({"ground.heave": 0.1})


@pytest.mark.parametrize(
    "file",
    [
        "core/leg.py",
        "core/struts/kinds.py",
        "assembly/start.py",
        "events/search.py",
        "quantities.py",
        "parameters.py",
        "landing.py",
    ],
)
def test_the_digest_of_a_build_is_of_all_its_model_files_also_of_older_ones(
    tmp_path: Path, file: str
) -> None:
    digests = set()
    for text in ("a = 1", "a = 2"):
        with ZipFile(tmp_path / "model.fmu", "w") as archive:
            archive.writestr("resources/rlv_landing_0_1_0/touchdown.py", "")
            archive.writestr(f"resources/rlv_landing_0_1_0/{file}", text)
        digests.add(build_metadata(tmp_path / "model.fmu")["model"])
    assert len(digests) == 2


def test_an_older_log_without_inertial_sensors_and_with_other_frames_is_its_run(
    one_log: Path, tmp_path: Path
) -> None:
    (file,) = one_log.glob("*.mcap")
    reader = LogReader(one_log)
    # topics and namespace are known from the messages on
    assert sum(1 for _ in reader.messages()) > 0
    absent = {resolve(reader.namespace, topic.name) for topic in (IMU, TOP_IMU)}
    contact = resolve(reader.namespace, CONTACTS[0].name)
    assert absent <= {channel.topic for channel in reader.channels.values()}

    def older(record: Any) -> Any:
        if not isinstance(record, tuple) or record[0] != contact:
            return record
        message = deserialize_message(record[1].data, WrenchStamped)
        message.header.frame_id = "map"
        return contact, replace(record[1], data=serialize_message(message))

    found = verify(LogReader(rewrite(file, tmp_path / "older", older, absent)))
    assert (found.same, found.other_bits, found.older) == (True, 0, True)
    assert "its names of frames are not compared" in found.text()
    complete = LogReader(rewrite(file, tmp_path / "other", older))
    assert verify(complete).first is not None
