"""Inputs as messages: ROS axes to the model's inputs and back.

Needs no ROS 2: a message is anything with the ROS message's fields.

`external_wrench` (geometry_msgs/WrenchStamped, frame `map`): force x forward and z up [N] at the
CG, torque about +y (nose down, as the pitch) [N m]. `ground` (sensor_msgs/JointState): joints
`ground_heave` (position [m] up, velocity [m/s]) and `ground_tilt` (position [rad] about +y,
velocity [rad/s]).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rlv_landing.errors import LandingError
from rlv_landing.parameters import check_value
from rlv_landing.quantities import INPUTS_BY_NAME

from .axes import IN_PLANE, from_ros, to_ros
from .topics import APPLIED_GROUND, APPLIED_WRENCH, WORLD_FRAME

WRENCH = ("external.force_x", "external.force_y", "external.moment")
HEAVE = ("ground.heave", "ground.heave_rate")
TILT = ("ground.tilt", "ground.tilt_rate")
# joint of `ground` -> the inputs that its position and velocity are
JOINTS: dict[str, tuple[str, str]] = {"ground_heave": HEAVE, "ground_tilt": TILT}


def read_wrench(message: Any) -> dict[str, float]:
    """The inputs that a WrenchStamped asks for.

    Raises:
        LandingError: another frame than the world's, not finite, out of bounds.
    """
    frame = message.header.frame_id
    if frame not in ("", WORLD_FRAME):
        raise LandingError(
            f"external_wrench is given in the frame {frame!r}; "
            f"give it in {WORLD_FRAME!r}, at the CG"
        )
    force, torque = message.wrench.force, message.wrench.torque
    x, y, _ = from_ros(force.x, force.y, force.z)
    return _checked(dict(zip(WRENCH, (x, y, torque.y))))


def out_of_plane(message: Any) -> bool:
    """Whether a WrenchStamped has parts that act across the body's plane.

    These are force y and torques x and z; the planar body cannot follow them, so `read_wrench`
    leaves them out.
    """
    force, torque = message.wrench.force, message.wrench.torque
    return bool(force.y or torque.x or torque.z)


def read_ground(message: Any) -> dict[str, float]:
    """The inputs that a JointState of `ground` asks for.

    A joint that it does not name stays as it is. Without velocities they are positions alone.

    Raises:
        LandingError: an unknown joint, positions or velocities that do not fit the names, not
            finite, out of bounds.
    """
    names, positions, velocities = (
        list(message.name),
        list(message.position),
        list(message.velocity),
    )
    if not names or len(positions) != len(names) or len(velocities) not in (0, len(names)):
        raise LandingError(
            f"ground has {len(names)} names, {len(positions)} positions and {len(velocities)} "
            "velocities; give a position, and a velocity or none, for each of "
            f"{' and '.join(JOINTS)}"
        )
    values: dict[str, float] = {}
    for i, name in enumerate(names):
        if name not in JOINTS:
            raise LandingError(
                f"ground has no joint {name!r}; its joints are {' and '.join(JOINTS)}"
            )
        position, rate = JOINTS[name]
        values[position] = positions[i]
        if velocities:
            values[rate] = velocities[i]
    return _checked(values)


def merged(ground: Mapping[str, float], later: Mapping[str, float]) -> dict[str, float]:
    """The inputs that two messages of `ground` ask for together.

    For a joint that both name, those of the later one count.
    """
    named = {own for pair in JOINTS.values() if pair[0] in later for own in pair}
    return {**{name: value for name, value in ground.items() if name not in named}, **later}


def _checked(values: Mapping[str, float]) -> dict[str, float]:
    return {name: float(check_value(INPUTS_BY_NAME[name], value)) for name, value in values.items()}


# What a log holds of them: topic, relative to the namespace -> the inputs that act from the
# message's stamp on.
READINGS: dict[str, Callable[[Any], dict[str, float]]] = {
    APPLIED_WRENCH.name: read_wrench,
    APPLIED_GROUND.name: read_ground,
}


def wrench_vectors(
    values: Mapping[str, float],
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Force and torque in ROS axes: the inverse of `read_wrench`, digit for digit."""
    x, y, moment = (values[name] for name in WRENCH)
    return to_ros(x, y, IN_PLANE), (0.0, moment, 0.0)
