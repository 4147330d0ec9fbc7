"""The inputs that reach the node: checked when they come, applied at the next step, given up when
their sender falls silent.
"""

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
    JOINTS,
    WRENCH,
    merged,
    out_of_plane,
    read_ground,
    read_wrench,
    wrench_vectors,
)
from ..messages.samples import set_stamp, set_vector
from ..messages.topics import APPLIED_GROUND, APPLIED_WRENCH, WORLD_FRAME, Topic
from .deck import Deck

NO_WRENCH = dict.fromkeys(WRENCH, 0.0)
# Waiting messages while the landing is paused; of more than these the newest are kept.
LONGEST_QUEUE = 1000


@dataclass(frozen=True)
class Applied:
    """A change of inputs: values by name, which act from the simulation time `nanoseconds` on;
    `topic` tells it.
    """

    topic: Topic
    nanoseconds: int
    values: Mapping[str, float]

    def message(self) -> Any:
        """The message that tells it, from which `inputs.READINGS` reads the same values."""
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
    """Takes the messages of `external_wrench` and `ground` in any thread; `take` hands the changes
    out in the landing's.

    `timeout` [s of wall time] after the last message the wrench is taken back to 0, and a moving
    ground stands still where it is; 0: never. How a ground moves of which only positions are told
    is `Deck`'s. `received` and `refused` count messages; `warn` is
    told why one cannot be used.
    """

    def __init__(self, timeout: float, warn: Callable[[str], None]) -> None:
        self.timeout = timeout
        self.received = 0
        self.refused = 0
        self._warn = warn
        self._arrived: deque[tuple[Topic, dict[str, float]]] = deque(maxlen=LONGEST_QUEUE)
        self.clear(1, lambda values: None)

    def clear(self, step_ns: int, check_start: Callable[[Mapping[str, float]], object]) -> None:
        """For a new landing in steps of `step_ns` [ns]: nothing acts, nothing waits. `check_start`
        raises LandingError for a ground that it cannot start above.
        """
        self._arrived.clear()
        self._wrench = dict(NO_WRENCH)
        self._deck, self._check_start = Deck(step_ns), check_start
        # When the last message came, of those topics that will be given up [s].
        self._heard: dict[Topic, float] = {}

    def take_wrench(self, message: Any) -> None:
        """A message of `external_wrench`."""
        if out_of_plane(message):
            self._warn(
                "external_wrench: force y and torques x and z are left out: the body moves in its plane"
            )
        self._receive(APPLIED_WRENCH, read_wrench, message)

    def take_ground(self, message: Any) -> None:
        """A message of `ground`."""
        self._receive(APPLIED_GROUND, read_ground, message)

    def _receive(self, topic: Topic, read: Callable[[Any], dict[str, float]], message: Any) -> None:
        try:
            values = read(message)
        except LandingError as e:
            self._refuse(e)
            return
        self.received += 1
        self._arrived.append((topic, values))

    def take(self, nanoseconds: int) -> list[Applied]:
        """What changes at the simulation time `nanoseconds`, at which a step begins.

        Of several messages the last one counts.
        """
        changed: dict[Topic, None] = {}
        if self._deck.arrive(nanoseconds):
            changed[APPLIED_GROUND] = None
        now = time.monotonic()
        ground: dict[str, float] = {}
        while self._arrived:
            topic, values = self._arrived.popleft()
            self._heard[topic] = now
            if topic is APPLIED_WRENCH:
                self._wrench = values
                changed[topic] = None
            else:
                ground = merged(ground, values)
        if ground and (nanoseconds > 0 or self._may_start(ground)):
            self._deck.tell(nanoseconds, ground)
            changed[APPLIED_GROUND] = None
        for topic, heard in list(self._heard.items()):
            if self.timeout and now - heard > self.timeout:
                del self._heard[topic]
                if self._give_up(topic, nanoseconds):
                    changed[topic] = None
        return [
            Applied(
                topic,
                nanoseconds,
                self._wrench if topic is APPLIED_WRENCH else self._deck.values(nanoseconds),
            )
            for topic in changed
        ]

    def _may_start(self, values: Mapping[str, float]) -> bool:
        """Whether the landing can start above the ground that lies and moves as messages say."""
        try:
            self._check_start({**self._deck.values(0), **values})
        except LandingError as e:
            self._refuse(e)
            return False
        return True

    def _refuse(self, reason: LandingError) -> None:
        self.refused += 1
        self._warn(f"input refused, what acted goes on: {reason}")

    def _give_up(self, topic: Topic, nanoseconds: int) -> bool:
        """Whether the silence on `topic` changes anything."""
        if topic is APPLIED_WRENCH:
            if self._wrench == NO_WRENCH:
                return False
            self._wrench = dict(NO_WRENCH)
            self._warn(f"no external_wrench for {self.timeout:g} s: it is taken back to 0")
            return True
        if not self._deck.stand(nanoseconds):
            return False
        self._warn(f"no ground for {self.timeout:g} s: it stands still where it is")
        return True
