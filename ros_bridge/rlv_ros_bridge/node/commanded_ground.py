"""The motion of the ground that messages ask for; velocities that they lack are derived."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rlv_landing.inputs.ground_way import LONGEST_INTERVAL

from ..messages.inputs import JOINTS, GroundJoint

# a message after a longer pause must not take that long to act [ns of simulation time]
LONGEST_SPACING = round(1e9 * LONGEST_INTERVAL)


@dataclass
class _Joint:
    """The motion of one of the ground's positions.

    `position` [m or rad] is that at the simulation time `since` [ns], `rate` [m/s or rad/s] its
    rate. If `end` [ns] is not None, the rate ends there. `goal` [m or rad] is the position in the
    last message, `commanded` [ns] the time of the last message that was news.
    """

    position: float = 0.0
    rate: float = 0.0
    since: int = 0
    goal: float = 0.0
    end: int | None = None
    commanded: int = 0

    def at(self, now: int) -> float:
        """The position at the simulation time `now` [ns]."""
        if self.end is not None and now >= self.end:
            return self.goal
        return self.position + 1e-9 * (now - self.since) * self.rate

    def move(self, now: int, position: float, rate: float) -> None:
        self.position, self.rate, self.since, self.end = position, rate, now, None


class CommandedGround:
    """Positions of the ground over the simulation time, as messages ask for them.

    A position with a velocity is the ground's from then on. If it is the last message's position
    again, with a velocity other than 0, the ground goes on from where it is at the velocity.
    Towards a position without a velocity the ground moves at a constant rate, over 1.5 times the
    time since the last one, at least one step. So messages at uneven times still give one motion
    without stops. The start counts as a message, and the last position again is no news. At time 0
    the ground is where the message says.

    Args:
        step_ns: the landing's step [ns].
        joints: the joints of `ground`.
    """

    def __init__(self, step_ns: int, joints: Mapping[str, GroundJoint] = JOINTS) -> None:
        self._step = step_ns
        # (position, rate): the inputs
        self._names = [(joint.position, joint.rate) for joint in joints.values()]
        self._joints = {position: _Joint() for position, _ in self._names}
        # when the first joint reaches its goal [ns]
        self._next_goal: float = math.inf

    def values(self, now: int) -> dict[str, float]:
        """The inputs that give the ground's motion at the simulation time `now` [ns]."""
        found = {}
        for position, rate in self._names:
            joint = self._joints[position]
            found[position], found[rate] = joint.at(now), joint.rate
        return found

    def command(self, now: int, values: Mapping[str, float]) -> None:
        """Takes the inputs of a message at the simulation time `now` [ns].

        Args:
            now: simulation time [ns].
            values: positions by input name, and their rates if the message has any.
        """
        for position, rate in self._names:
            if position not in values:
                continue
            joint, goal = self._joints[position], values[position]
            here, again, joint.goal = joint.at(now), joint.goal == goal, goal
            stays = joint.end is not None or (joint.rate == 0.0 and here == goal)
            if again and stays and rate not in values:
                continue
            spacing = min(now - joint.commanded, LONGEST_SPACING)
            joint.commanded = now
            if rate in values or spacing == 0:
                velocity = values.get(rate, 0.0)
                held = again and velocity != 0.0
                joint.move(now, here if held else goal, velocity)
                continue
            half = -(-spacing // (2 * self._step)) * self._step
            joint.move(now, here, 0.0)
            joint.rate = (goal - joint.position) / (1e-9 * (spacing + half))
            joint.end = now + spacing + half
        self._note_next_goal()

    def stop_at_goals(self, now: int) -> bool:
        """Stops what has reached its goal at the simulation time `now` [ns]; whether any has."""
        if now < self._next_goal:
            return False
        arrived = [j for j in self._joints.values() if j.end is not None and now >= j.end]
        for joint in arrived:
            joint.move(now, joint.goal, 0.0)
        self._note_next_goal()
        return bool(arrived)

    def _note_next_goal(self) -> None:
        ends = [j.end for j in self._joints.values() if j.end is not None]
        self._next_goal = min(ends, default=math.inf)

    def stop(self, now: int) -> bool:
        """Stops what moves at a commanded velocity, at the simulation time `now` [ns].

        What is on its way to a goal goes on to it.

        Returns:
            Whether anything is stopped.
        """
        moving = [j for j in self._joints.values() if j.rate != 0.0 and j.end is None]
        for joint in moving:
            joint.move(now, joint.at(now), 0.0)
        return bool(moving)
