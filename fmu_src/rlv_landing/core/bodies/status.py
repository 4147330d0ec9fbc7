"""The status of a landing: its phase."""

from __future__ import annotations

from ..records import Phase

# of a vehicle at rest, at most: speed [m/s] by its kinetic energy, sum of the body's accelerations
# [m/s2, rad/s2]
REST_SPEED = 2e-3
REST_ACCELERATION = 0.05


def phase_of(margin: float, upright: float, depth: float) -> int:
    """The `Phase` of a landing; contact for what has settled, too: see `is_still`.

    Args:
        margin: Stability margin [m].
        upright: Below 0 where the body has turned over.
        depth: Penetration of the footpad or point that is deepest in the ground [m].
    """
    if margin < 0.0 or upright < 0.0:
        return Phase.TOPPLED
    if depth <= 0.0:
        return Phase.FALLING
    return Phase.CONTACT


def phase_at_rest(told: float) -> int:
    """The phase of what has come to rest and whose phase is `told` without regard to that."""
    if is_phase(told, Phase.TOPPLED):
        return Phase.TOPPLED
    if is_phase(told, Phase.FALLING):
        return Phase.FALLING
    return Phase.SETTLED


def is_still(kinetic: float, mass: float, acceleration: float, most: float) -> bool:
    """Whether a vehicle is still: its speed is 2 mm/s at most, its acceleration 0.05 m/s2 at most.

    Args:
        kinetic: Kinetic energy of the vehicle [J].
        mass: Its mass [kg].
        acceleration: Sum of the body's accelerations [m/s2, rad/s2].
        most: How many times that kinetic energy and that acceleration it may have.
    """
    return is_slow(kinetic, most * mass) and acceleration <= most * REST_ACCELERATION


def is_slow(kinetic: float, mass: float) -> bool:
    """Whether a `mass` [kg] of this `kinetic` energy [J] is slower than 2 mm/s."""
    return kinetic <= 0.5 * mass * REST_SPEED * REST_SPEED


def is_phase(told: float, phase: int) -> bool:
    """Whether the output `status.phase` that is `told` is the `phase`."""
    return told == phase
