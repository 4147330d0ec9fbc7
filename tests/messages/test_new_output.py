"""One line in the table of fields adds an output to a message, everywhere.

The line is added to a copy of the package; the node, the log's commands and the reading are the
copy's own.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_landing.quantities import OUTPUT_NAMES

ROOT = Path(__file__).resolve().parents[2]
STORE = get_typestore(Stores.ROS2_KILTED)
TABLE = "FIELDS: tuple[Field, ...] = (\n"
MARGIN, LIQUID = "status.stability_margin", "leg[3].main_strut.liquid_mass"
STOP_TIME = 0.2

# The sample 0, 1, 2, ... through each way that a sample takes to a message: as objects and packed.
BOTH_WAYS = """
from rclpy.serialization import deserialize_message
from rlv_landing.quantities import OUTPUT_NAMES
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.message_types import message_class
from rlv_ros_bridge.messages.samples import SampleBytes, SampleMessages
from rlv_ros_bridge.messages.topics import {topic}

values = [float(i) for i in range(len(OUTPUT_NAMES))]
vehicle = Vehicle(9.81, 0.5)
filled, packer = SampleMessages(vehicle), SampleBytes(vehicle)
filled.fill(0, values)
data = packer.pack(0, values)[packer.slices[packer.topics.index({topic})]]
packed = deserialize_message(data, message_class({topic}.type_name))
for m in (filled.messages[{topic}], packed):
    print(m.{path})
"""
COLUMNS = """
import sys
from rlv_ros_bridge.logs.history import log_history

for value in log_history(sys.argv[1])[sys.argv[2]]:
    print(value.hex())
"""


@dataclass(frozen=True)
class Added:
    """A line of the table: the topic's constant and name, a path, an output, and a sign."""

    topic: str
    name: str
    path: str
    output: str
    sign: float
    line: str


CASES = [
    Added("RPY", "rpy", "vector.x", MARGIN, 1.0, f'Field(RPY, ("vector.x",), ("{MARGIN}",)),'),
    Added(
        "ODOM",
        "odom",
        "pose.covariance[35]",
        LIQUID,
        1.0,
        f'Field(ODOM, ("pose.covariance[35]",), ("{LIQUID}",)),',
    ),
    Added(
        "TWIST",
        "twist",
        "twist.angular.z",
        MARGIN,
        -1.0,
        f'Field(TWIST, ("twist.angular.z",), ("{MARGIN}",), lambda x: (-x,), lambda x: (-x,)),',
    ),
]


def run(
    bridge: Path, arguments: Sequence[object], code: int = 0
) -> subprocess.CompletedProcess[str]:
    """Python with the bridge of the folder `bridge`, by itself on its network; its exit code."""
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join((str(bridge), str(ROOT / "fmu_src"))),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF",
    }
    done = subprocess.run(
        [sys.executable, *map(str, arguments)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done


def command(bridge: Path, *arguments: object, code: int = 0) -> str:
    return run(bridge, ["-m", "rlv_ros_bridge", *arguments], code).stdout


def numbers(message: object, path: str) -> float:
    owner, _, index = path.partition("[")
    value = message
    for name in owner.split("."):
        value = getattr(value, name)
    return float(value[int(index[:-1])] if index else value)  # type: ignore[index,arg-type]


@pytest.fixture(scope="module")
def landing() -> History:
    return Landing(load_preset("yue2022-figures", "2-2")).run(STOP_TIME, 1e-3)


@pytest.fixture
def copy(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The bridge with one more line, which is the test's parameter."""
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(
        ROOT / "ros_bridge" / "rlv_ros_bridge",
        tmp_path / "bridge" / "rlv_ros_bridge",
        ignore=ignored,
    )
    table = tmp_path / "bridge" / "rlv_ros_bridge" / "messages" / "fields.py"
    text = table.read_text(encoding="utf-8")
    assert text.count(TABLE) == 1
    table.write_text(text.replace(TABLE, f"{TABLE}    {request.param.line}\n"), encoding="utf-8")
    return tmp_path / "bridge"


@pytest.mark.parametrize(
    ("copy", "added"), [(a, a) for a in CASES], indirect=["copy"], ids=[a.path for a in CASES]
)
def test_one_line_fills_packs_records_verifies_and_reads_back_an_output(
    copy: Path, added: Added, landing: History, fmu: Path, tmp_path: Path
) -> None:
    position = OUTPUT_NAMES.index(added.output)
    both = run(copy, ["-c", BOTH_WAYS.format(topic=added.topic, path=added.path)]).stdout
    assert [float(line) for line in both.split()] == [added.sign * position] * 2

    log = tmp_path / "log"
    command(
        copy,
        "node",
        "--fmu",
        fmu,
        "--realtime-factor",
        0,
        "--stop-time",
        STOP_TIME,
        "--record",
        log,
    )
    with Reader(log) as reader:
        recorded = [
            numbers(STORE.deserialize_cdr(data, connection.msgtype), added.path)
            for connection, _, data in reader.messages()
            if connection.topic == f"/landing/{added.name}"
        ]
    assert np.array_equal(recorded, added.sign * landing[added.output])

    assert "same      bit for bit" in command(copy, "log", "verify", log)
    without = command(ROOT / "ros_bridge", "log", "verify", log, code=1)
    assert f"/landing/{added.name} at 0 s, {added.path}: " in without

    columns = run(copy, ["-c", COLUMNS, log, added.output]).stdout
    assert np.array_equal([float.fromhex(x) for x in columns.split()], landing[added.output])
