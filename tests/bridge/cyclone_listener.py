"""A participant without ROS and Fast DDS: `cyclone_listener.py OUTPUT COUNT`.

Receives `rt/landing/struts` by Cyclone DDS. Prints `matched` once its reader has found the writer.
Ends after COUNT samples, and writes stamps, positions and forces as JSON.
"""

import json
import os
import sys
from dataclasses import dataclass
from pathlib import Path

from cyclonedds.core import Listener, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64, int32, sequence, uint32
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class JointState(IdlStruct, typename="sensor_msgs::msg::dds_::JointState_"):
    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


def main(output: str, count: int) -> None:
    participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepAll)
    # A volatile reader gets what is written after it has found the writer.
    matched = Listener(
        on_subscription_matched=lambda _reader, status: (
            print("matched", flush=True) if status.current_count else None
        )
    )
    reader = DataReader(
        participant, Topic(participant, "rt/landing/struts", JointState), qos=qos, listener=matched
    )
    received: list[tuple[int, list[str], list[float], list[float]]] = []
    while len(received) < count:
        for m in reader.take_iter(timeout=duration(seconds=60)):
            received.append(
                (
                    m.header.stamp.sec * 10**9 + m.header.stamp.nanosec,
                    list(m.name),
                    list(m.position),
                    list(m.effort),
                )
            )
            if len(received) == count:
                break
        else:
            break
    Path(output).write_text(json.dumps(received), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
