"""A DDS participant without ROS or Fast DDS receives the landing, with the shipped profile."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from bridge_tools import HERE, ROOT, TIMEOUT, command, environment
from remote import ACTIVATE, CLEANUP, CONFIGURE, DEACTIVATE, Remote

from rlv_ros_bridge.logs.reader import Decoder, LogReader

PROFILE = ROOT / "ros_bridge" / "config" / "foreign_dds.xml"
# Cyclone DDS on this machine only, as the node is by ROS_AUTOMATIC_DISCOVERY_RANGE.
LOCAL = (
    "<CycloneDDS><Domain>"
    '<General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General>'
    '<Discovery><Peers><Peer Address="127.0.0.1"/></Peers>'
    "<ParticipantIndex>auto</ParticipantIndex></Discovery>"
    "</Domain></CycloneDDS>"
)


def test_cyclone_dds_in_another_process_gets_every_joint_state(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    output = tmp_path / "received.json"
    listener = subprocess.Popen(
        [sys.executable, str(HERE / "cyclone_listener.py"), str(output), "1001"],
        env=environment(domain, CYCLONEDDS_URI=LOCAL),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    processes.append(listener)
    line = command(
        "node", "--managed", "--fmu", fmu, "--record", tmp_path / "log", "--wait-for-subscribers", 1
    )
    env = environment(domain, FASTDDS_DEFAULT_PROFILES_FILE=str(PROFILE))
    node = subprocess.Popen(
        line, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    processes.append(node)
    assert listener.stdout is not None
    assert listener.stdout.readline().strip() == "matched"
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        assert remote.change(ACTIVATE)
        remote.until(lambda: listener.poll() is not None)
        assert remote.change(DEACTIVATE)
        assert remote.change(CLEANUP)
        remote.shut_down()
        _, err = node.communicate(timeout=TIMEOUT)
    assert node.returncode == 0, err
    _, err = listener.communicate(timeout=TIMEOUT)
    assert listener.returncode == 0, err
    received = json.loads(output.read_text())
    reader = LogReader(tmp_path / "log")
    decode = Decoder(reader)
    logged = [(m.log_time, decode(m)) for m in reader.messages(["/landing/struts"])]
    assert received == [
        [stamp, list(m.name), list(m.position), list(m.effort)] for stamp, m in logged
    ]
