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
    PLANAR,
    InputTable,
    ground_joints,
    merged,
    out_of_plane,
    read_ground,
    read_wrench,
    wrench_vectors,
)
from ..messages.samples import set_stamp, set_vector
from ..messages.topics import APPLIED_GROUND, APPLIED_WRENCH, WORLD_FRAME, Topic
from .commanded_ground import CommandedGround

# Messages that wait while the landing is paused; of more than these the newest are kept.
LONGEST_QUEUE = 1000


@dataclass(frozen=True)
class InputChange:
    """New values of inputs from a simulation time on.

    `topic` is the topic `applied/...` on which the change is published. `nanoseconds` is the
    simulation time from which on it acts [ns]. `values` are inputs by name, SI. `table` says how
    messages carry them.
    """

    topic: Topic
    nanoseconds: int
    values: Mapping[str, float]
    table: InputTable = PLANAR

    def message(self) -> Any:
        """The message of `topic`, from which `inputs.READINGS` reads the same values."""
        if self.topic is APPLIED_WRENCH:
            message = WrenchStamped()
            force, torque = wrench_vectors(self.values, self.table)
            set_vector(message.wrench.force, force)
            set_vector(message.wrench.torque, torque)
        else:
            message = JointState()
            message.name, message.position, message.velocity = ground_joints(
                self.values, self.table
            )
        message.header.frame_id = WORLD_FRAME
        set_stamp(message.header.stamp, self.nanoseconds)
        return message


class InputQueue:
    """Receives messages of `external_wrench` and `ground` in any thread.

    The landing's thread collects the resulting changes by `changes_at`. `received` and `refused`
    count messages. Ground positions without velocities are handled by `CommandedGround`.

    Args:
        timeout: wall time after a topic's last message [s] after which the wrench becomes 0, or a
            velocity of the ground ends; 0: never.
        warn: called with a text when a message cannot be used, and after a timeout.
        table: how messages carry the landing's inputs.
    """

    def __init__(
        self, timeout: float, warn: Callable[[str], None], table: InputTable = PLANAR
    ) -> None:
        self.timeout = timeout
        self.received = 0
        self.refused = 0
        self._warn, self._table = warn, table
        self._arrived: deque[tuple[Topic, dict[str, float]]] = deque(maxlen=LONGEST_QUEUE)
        self.clear(1, lambda values: None)

    def clear(self, step_ns: int, check_start: Callable[[Mapping[str, float]], object]) -> None:
        """Resets to no inputs and no waiting messages, for a new landing.

        Args:
            step_ns: the landing's step [ns].
            check_start: raises LandingError for ground inputs that the landing cannot start with.
        """
        self._arrived.clear()
        self._wrench = self._table.no_wrench
        self._ground, self._check_start = CommandedGround(step_ns, self._table.joints), check_start
        # Arrival of the last message of each topic whose timeout has not passed [s].
        self._last_arrival: dict[Topic, float] = {}

    def receive_wrench(self, message: Any) -> None:
        """Takes a message of `external_wrench`."""
        if out_of_plane(message, self._table):
            self._warn(
                "external_wrench: force y and torques x and z are ignored: "
                "the body moves in its plane"
            )
        self._receive(APPLIED_WRENCH, read_wrench, message)

    def receive_ground(self, message: Any) -> None:
        """Takes a message of `ground`."""
        self._receive(APPLIED_GROUND, read_ground, message)

    def _receive(self, topic: Topic, read: Callable[..., dict[str, float]], message: Any) -> None:
        try:
            values = read(message, self._table)
        except LandingError as e:
            self._refuse(e)
            return
        self.received += 1
        self._arrived.append((topic, values))

    def changes_at(self, nanoseconds: int) -> list[InputChange]:
        """The changes for a step that begins at the simulation time `nanoseconds` [ns].

        Of several messages of a topic the last counts, for the ground joint by joint.
        """
        stopped = self._ground.stop_at_goals(nanoseconds)
        if not (stopped or self._arrived or self._last_arrival):
            return []
        changed: dict[Topic, None] = {APPLIED_GROUND: None} if stopped else {}
        now = time.monotonic()
        ground: dict[str, float] = {}
        while self._arrived:
            topic, values = self._arrived.popleft()
            self._last_arrival[topic] = now
            if topic is APPLIED_WRENCH:
                self._wrench = values
                changed[topic] = None
            else:
                ground = merged(ground, values, self._table)
        if ground and (nanoseconds > 0 or self._can_start(ground)):
            self._ground.command(nanoseconds, ground)
            changed[APPLIED_GROUND] = None
        for topic, arrival in list(self._last_arrival.items()):
            if self.timeout and now - arrival > self.timeout:
                del self._last_arrival[topic]
                if self._end_input(topic, nanoseconds):
                    changed[topic] = None
        return [
            InputChange(
                topic,
                nanoseconds,
                self._wrench if topic is APPLIED_WRENCH else self._ground.values(nanoseconds),
                self._table,
            )
            for topic in changed
        ]

    def _can_start(self, values: Mapping[str, float]) -> bool:
        """Whether the landing can start with the ground inputs `values`; else they are refused."""
        try:
            self._check_start({**self._ground.values(0), **values})
        except LandingError as e:
            self._refuse(e)
            return False
        return True

    def _refuse(self, reason: LandingError) -> None:
        self.refused += 1
        self._warn(f"input refused, the previous one stays in force: {reason}")

    def _end_input(self, topic: Topic, nanoseconds: int) -> bool:
        """Ends an input after a timeout; whether that is a change.

        The wrench becomes 0, and the ground no longer goes on at a velocity.
        """
        if topic is APPLIED_WRENCH:
            if self._wrench == self._table.no_wrench:
                return False
            self._wrench = self._table.no_wrench
            self._warn(f"no external_wrench for {self.timeout:g} s: it is set to 0")
            return True
        if not self._ground.stop(nanoseconds):
            return False
        self._warn(f"no ground for {self.timeout:g} s: a velocity ends where the ground is")
        return True
