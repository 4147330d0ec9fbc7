"""The status of a landing: its phase."""

from __future__ import annotations

from ..records import Phase

# of a vehicle at rest, at most: speed [m/s] by its kinetic energy, sum of the body's accelerations
# [m/s2, rad/s2]
REST_SPEED = 2e-3
REST_ACCELERATION = 0.05


def phase_of(
    margin: float, upright: float, depth: float, kinetic: float, mass: float, acceleration: float
) -> int:
    """The `Phase` of a landing.

    Settled: a footpad or a point of the body touches, the kinetic energy is that of 2 mm/s at most,
    and the body's acceleration is below 0.05 m/s2.

    Args:
        margin: Stability margin [m].
        upright: Below 0 where the body has turned over.
        depth: Penetration of the footpad or point that is deepest in the ground [m].
        kinetic: Kinetic energy of the vehicle [J].
        mass: Its mass [kg].
        acceleration: Sum of the body's accelerations [m/s2, rad/s2].
    """
    if margin < 0.0 or upright < 0.0:
        return Phase.TOPPLED
    if depth <= 0.0:
        return Phase.FALLING
    if not is_slow(kinetic, mass):
        return Phase.CONTACT
    if acceleration > REST_ACCELERATION:
        return Phase.CONTACT
    return Phase.SETTLED


def is_slow(kinetic: float, mass: float) -> bool:
    """Whether a `mass` [kg] of this `kinetic` energy [J] is slower than 2 mm/s."""
    return kinetic <= 0.5 * mass * REST_SPEED * REST_SPEED


def is_phase(told: float, phase: int) -> bool:
    """Whether the output `status.phase` that is `told` is the `phase`."""
    return told == phase
