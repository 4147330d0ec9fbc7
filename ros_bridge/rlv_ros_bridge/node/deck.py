"""The motion of the ground that messages ask for, with the velocity derived where they give none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..messages.inputs import JOINTS

# the spacing [ns of simulation time] that messages are taken to have at most: after a longer
# silence a first one must not take that long to act
LONGEST_SPACING = 500_000_000


@dataclass
class _Joint:
    """Position [m or rad] at the simulation time `since` [ns], and its rate a second; the rate
    takes it to `goal` by `end`, where that is not None. `told`: when a message last told it.
    """

    position: float = 0.0
    rate: float = 0.0
    since: int = 0
    goal: float = 0.0
    end: int | None = None
    told: int | None = None

    def at(self, now: int) -> float:
        """The position at the simulation time `now` [ns]."""
        if self.end is not None and now >= self.end:
            return self.goal
        return self.position + 1e-9 * (now - self.since) * self.rate

    def move(self, now: int, position: float, rate: float) -> None:
        self.position, self.rate, self.since, self.end = position, rate, now, None


class Deck:
    """Heave and tilt of the ground over the simulation time, in steps of `step_ns` [ns].

    A position with a velocity is the ground's from then on. One without a velocity is where the
    ground shall be: it moves there steadily, within the time since the message before and half as
    much again, a step at least, so that messages that come as evenly as a network lets them are one
    motion between their points. Where there was no message before, the landing itself moves the
    ground, over its next step. At time 0 it lies where it is told to.
    """

    def __init__(self, step_ns: int) -> None:
        self._step = step_ns
        self._joints = {position: _Joint() for position, _ in JOINTS.values()}

    def values(self, now: int) -> dict[str, float]:
        """The inputs that are the ground's motion at the simulation time `now` [ns]."""
        found = {}
        for position, rate in JOINTS.values():
            joint = self._joints[position]
            found[position], found[rate] = joint.at(now), joint.rate
        return found

    def tell(self, now: int, values: Mapping[str, float]) -> None:
        """Take up what a message says at the simulation time `now` [ns]: positions, and their rates
        where it has any.
        """
        for position, rate in JOINTS.values():
            if position not in values:
                continue
            joint, goal = self._joints[position], values[position]
            spacing = 0 if joint.told is None else min(now - joint.told, LONGEST_SPACING)
            joint.told = now
            if rate in values or spacing == 0:
                joint.move(now, goal, values.get(rate, 0.0))
                continue
            half = -(-spacing // (2 * self._step)) * self._step
            joint.move(now, joint.at(now), 0.0)
            joint.rate = (goal - joint.position) / (1e-9 * (spacing + half))
            joint.goal, joint.end = goal, now + spacing + half

    def arrive(self, now: int) -> bool:
        """Let what has come to where it was told to be stand still there; whether anything has."""
        arrived = [j for j in self._joints.values() if j.end is not None and now >= j.end]
        for joint in arrived:
            joint.move(now, joint.goal, 0.0)
        return bool(arrived)

    def stand(self, now: int) -> bool:
        """Let the ground stand still where it is; whether it moved."""
        moving = [j for j in self._joints.values() if j.rate != 0.0]
        for joint in moving:
            joint.move(now, joint.at(now), 0.0)
        return bool(moving)
