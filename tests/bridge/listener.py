"""A subscriber in a process of its own: `listener.py OUTPUT ANNOUNCE NAME=TYPE=COUNT ...`.

Prints `listening` once its subscriptions are there and `announced` after ANNOUNCE messages of the
last topic. Ends when each topic has had its COUNT (where given), or half a second after the last
message once its standard input is closed.
"""

from __future__ import annotations

import faulthandler
import importlib
import pickle
import sys
import threading
import time
from functools import partial
from pathlib import Path
from typing import IO, Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile

COUNTS: dict[str, int] = {}


def receive(file: IO[bytes], topic: str, message: bytes, info: Any) -> None:
    pickle.dump((topic, info["source_timestamp"], info["received_timestamp"], message), file)
    COUNTS[topic] += 1


def two_arguments(file: IO[bytes], topic: str) -> Any:
    # rclpy counts the callback's arguments to see whether it wants the message's info.
    return lambda message, info: receive(file, topic, message, info)


def main(output: str, announce: int, topics: list[list[str]]) -> None:
    closed = threading.Event()
    expected = {name: int(count) for name, _, count in topics}
    with Path(output).open("wb") as file, rclpy.init():
        node = Node("listener")
        for name, kind, _ in topics:
            package, middle, short = kind.split("/")
            COUNTS[name] = 0
            message_type = getattr(importlib.import_module(f"{package}.{middle}"), short)
            node.create_subscription(
                message_type, name, two_arguments(file, name), QoSProfile(depth=10000), raw=True
            )
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        print("listening", flush=True)
        threading.Thread(target=partial(wait_for_end, closed), daemon=True).start()
        last, quiet_since, announced = topics[-1][0], time.monotonic(), False
        while True:
            before = sum(COUNTS.values())
            executor.spin_once(timeout_sec=0.1)
            if sum(COUNTS.values()) > before:
                quiet_since = time.monotonic()
            if announce and not announced and COUNTS[last] >= announce:
                announced = True
                print("announced", flush=True)
            if any(expected.values()) and all(
                COUNTS[name] >= count for name, count in expected.items()
            ):
                break
            if closed.is_set() and time.monotonic() - quiet_since > 0.5:
                break
        file.flush()
        executor.shutdown()
        node.destroy_node()


def wait_for_end(closed: threading.Event) -> None:
    sys.stdin.read()
    closed.set()


if __name__ == "__main__":
    faulthandler.enable()
    main(sys.argv[1], int(sys.argv[2]), [pair.split("=") for pair in sys.argv[3:]])
