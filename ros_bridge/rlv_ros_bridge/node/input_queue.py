"""Inputs from other nodes: checked on arrival, applied at the next step, ended after a timeout."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from rlv_landing.errors import LandingError

from ..messages.inputs import (
    HEAVE,
    JOINTS,
    TILT,
    WRENCH,
    out_of_plane,
    read_ground,
    read_wrench,
    wrench_vectors,
)
from ..messages.samples import set_stamp, set_vector
from ..messages.topics import APPLIED_GROUND, APPLIED_WRENCH, WORLD_FRAME, Topic

NO_WRENCH = dict.fromkeys(WRENCH, 0.0)
NO_MOTION = dict.fromkeys((*HEAVE, *TILT), 0.0)
# Messages that wait while the landing is paused; of more than these the newest are kept.
LONGEST_QUEUE = 1000


@dataclass(frozen=True)
class InputChange:
    """New values of inputs from a simulation time on.

    `topic` is the topic `applied/...` on which the change is published. `nanoseconds` is the
    simulation time from which on it acts [ns]. `values` are inputs by name, SI.
    """

    topic: Topic
    nanoseconds: int
    values: Mapping[str, float]

    def message(self) -> Any:
        """The message of `topic`, from which `inputs.READINGS` reads the same values."""
        if self.topic is APPLIED_WRENCH:
            message = WrenchStamped()
            force, torque = wrench_vectors(self.values)
            set_vector(message.wrench.force, force)
            set_vector(message.wrench.torque, torque)
        else:
            message = JointState(name=list(JOINTS))
            message.position = [self.values[position] for position, _ in JOINTS.values()]
            message.velocity = [self.values[rate] for _, rate in JOINTS.values()]
        message.header.frame_id = WORLD_FRAME
        set_stamp(message.header.stamp, self.nanoseconds)
        return message


class InputQueue:
    """Receives messages of `external_wrench` and `ground` in any thread.

    The landing's thread collects the resulting changes by `changes_at`. `received` and `refused`
    count messages.

    Args:
        timeout: wall time after a topic's last message [s] after which the wrench becomes 0, or the
            ground stops where it is; 0: never.
        warn: called with a text when a message cannot be used, and after a timeout.
    """

    def __init__(self, timeout: float, warn: Callable[[str], None]) -> None:
        self.timeout = timeout
        self.received = 0
        self.refused = 0
        self._warn = warn
        self._arrived: deque[tuple[Topic, dict[str, float]]] = deque(maxlen=LONGEST_QUEUE)
        self.clear()

    def clear(self) -> None:
        """Resets to no inputs and no waiting messages, for a new landing."""
        self._arrived.clear()
        self._wrench = dict(NO_WRENCH)
        self._ground, self._ground_since = dict(NO_MOTION), 0
        # Arrival of the last message of each topic whose timeout has not passed [s].
        self._last_arrival: dict[Topic, float] = {}

    def receive_wrench(self, message: Any) -> None:
        """Takes a message of `external_wrench`."""
        if out_of_plane(message):
            self._warn(
                "external_wrench: force y and torques x and z are ignored: "
                "the body moves in its plane"
            )
        self._receive(APPLIED_WRENCH, read_wrench, message)

    def receive_ground(self, message: Any) -> None:
        """Takes a message of `ground`."""
        self._receive(APPLIED_GROUND, read_ground, message)

    def _receive(self, topic: Topic, read: Callable[[Any], dict[str, float]], message: Any) -> None:
        try:
            values = read(message)
        except LandingError as e:
            self.refused += 1
            self._warn(f"input refused, the previous one stays in force: {e}")
            return
        self.received += 1
        self._arrived.append((topic, values))

    def changes_at(self, nanoseconds: int) -> list[InputChange]:
        """The changes for a step that begins at the simulation time `nanoseconds` [ns].

        Of several messages of a topic the last counts.
        """
        if not self._arrived and not self._last_arrival:
            return []
        changed: dict[Topic, None] = {}
        now = time.monotonic()
        while self._arrived:
            topic, values = self._arrived.popleft()
            changed[topic] = None
            self._last_arrival[topic] = now
            if topic is APPLIED_WRENCH:
                self._wrench = values
            else:
                self._ground = {**self._ground_at(nanoseconds), **values}
                self._ground_since = nanoseconds
        for topic, arrival in list(self._last_arrival.items()):
            if self.timeout and now - arrival > self.timeout:
                del self._last_arrival[topic]
                if self._end_input(topic, nanoseconds):
                    changed[topic] = None
        return [
            InputChange(
                topic, nanoseconds, self._wrench if topic is APPLIED_WRENCH else self._ground
            )
            for topic in changed
        ]

    def _ground_at(self, nanoseconds: int) -> dict[str, float]:
        """The ground's motion at the simulation time `nanoseconds` [ns], at constant rates."""
        passed = 1e-9 * (nanoseconds - self._ground_since)
        moved = {
            name: self._ground[name] + passed * self._ground[rate] for name, rate in JOINTS.values()
        }
        return {**self._ground, **moved}

    def _end_input(self, topic: Topic, nanoseconds: int) -> bool:
        """Sets the wrench to 0, or stops the ground, after a timeout; whether that is a change."""
        if topic is APPLIED_WRENCH:
            if self._wrench == NO_WRENCH:
                return False
            self._wrench = dict(NO_WRENCH)
            self._warn(f"no external_wrench for {self.timeout:g} s: it is set to 0")
            return True
        if not (self._ground[HEAVE[1]] or self._ground[TILT[1]]):
            return False
        self._ground = {**self._ground_at(nanoseconds), HEAVE[1]: 0.0, TILT[1]: 0.0}
        self._ground_since = nanoseconds
        self._warn(f"no ground for {self.timeout:g} s: it stops where it is")
        return True
