"""Inputs as messages: ROS axes to the model's inputs and back.

Needs no ROS 2: a message is anything with the ROS message's fields.

`external_wrench` (geometry_msgs/WrenchStamped, frame `map`): force [N] at the CG and torque [N m].
A symmetric landing takes force x forward and z up, and the torque about +y (nose down, as the
pitch). `ground` (sensor_msgs/JointState): joints `ground_heave` (position [m] up, velocity [m/s])
and `ground_tilt` (position [rad] about +y, velocity [rad/s]); in space also `ground_surge` and
`ground_sway` (along +x and +y), `ground_roll` and `ground_yaw` (about +x and +z). The deck has its
pose when it is turned by the yaw, then the roll, then the tilt about the map's axes, and moved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from rlv_landing.errors import LandingError
from rlv_landing.parameters import check_value
from rlv_landing.quantities import Interface, Quantity

from .axes import IN_PLANE, from_ros, to_ros
from .fields import IN_A_PLANE
from .topics import APPLIED_GROUND, APPLIED_WRENCH, WORLD_FRAME


@dataclass(frozen=True)
class GroundJoint:
    """A joint of `ground`: the inputs that its position and velocity are.

    The sign is -1 where the map's axis is against the model's.
    """

    position: str
    rate: str
    sign: float = 1.0


@dataclass(frozen=True, eq=False)
class InputTable:
    """How messages carry the inputs of a landing.

    Attributes:
        quantities: the inputs by name.
        forces: the inputs that are the forces along the model's x, y, z; None: none.
        moments: those that are the moments about the map's x, y, z with their signs; None: none.
        joints: the joints of `ground`.
    """

    quantities: Mapping[str, Quantity]
    forces: tuple[str | None, ...]
    moments: tuple[tuple[str, float] | None, ...]
    joints: Mapping[str, GroundJoint]

    @property
    def no_wrench(self) -> dict[str, float]:
        """The inputs that `external_wrench` carries, all 0."""
        moments = (moment[0] for moment in self.moments if moment)
        return dict.fromkeys((*filter(None, self.forces), *moments), 0.0)


# of symmetric landings
WRENCH = ("external.force_x", "external.force_y", "external.moment")
HEAVE = ("ground.heave", "ground.heave_rate")
TILT = ("ground.tilt", "ground.tilt_rate")
JOINTS = {"ground_heave": GroundJoint(*HEAVE), "ground_tilt": GroundJoint(*TILT)}
JOINTS_IN_SPACE = {
    "ground_surge": GroundJoint("ground.surge", "ground.surge_rate"),
    "ground_sway": GroundJoint("ground.sway", "ground.sway_rate", -1.0),
    **JOINTS,
    "ground_roll": GroundJoint("ground.roll", "ground.roll_rate"),
    "ground_yaw": GroundJoint("ground.yaw", "ground.yaw_rate"),
}


@cache
def input_table_of(interface: Interface) -> InputTable:
    """How messages carry the inputs of a landing with this interface."""
    if not interface.in_space:
        return InputTable(
            interface.inputs_by_name,
            (*WRENCH[:2], None),
            (None, (WRENCH[2], 1.0), None),
            JOINTS,
        )
    moments = (
        ("external.moment_x", 1.0),
        ("external.moment_z", -1.0),
        ("external.moment_y", 1.0),
    )
    forces = tuple(f"external.force_{axis}" for axis in "xyz")
    return InputTable(interface.inputs_by_name, forces, moments, JOINTS_IN_SPACE)


PLANAR = input_table_of(IN_A_PLANE)


def read_wrench(message: Any, table: InputTable = PLANAR) -> dict[str, float]:
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
    values = dict(zip(table.forces, from_ros(force.x, force.y, force.z)))
    found = {name: value for name, value in values.items() if name}
    for moment, value in zip(table.moments, (torque.x, torque.y, torque.z)):
        if moment:
            found[moment[0]] = moment[1] * value
    return _checked(found, table)


def out_of_plane(message: Any, table: InputTable = PLANAR) -> bool:
    """Whether a WrenchStamped has parts that the body cannot follow.

    `read_wrench` leaves them out. Of a planar body these are force y and torques x and z.
    """
    force, torque = message.wrench.force, message.wrench.torque
    across = zip(table.forces, from_ros(force.x, force.y, force.z))
    turning = zip(table.moments, (torque.x, torque.y, torque.z))
    return any(bool(value) and not name for name, value in (*across, *turning))


def read_ground(message: Any, table: InputTable = PLANAR) -> dict[str, float]:
    """The inputs that a JointState of `ground` asks for.

    A joint that it does not name stays as it is. Without velocities they are positions alone.

    Raises:
        LandingError: an unknown joint, one named twice, positions or velocities that do not fit
            the names, not finite, out of bounds.
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
            f"{' and '.join(table.joints)}"
        )
    values: dict[str, float] = {}
    for i, name in enumerate(names):
        if name not in table.joints:
            raise LandingError(
                f"ground has no joint {name!r}; its joints are {' and '.join(table.joints)}"
            )
        joint = table.joints[name]
        if joint.position in values:
            raise LandingError(f"ground names the joint {name!r} twice; name each once")
        values[joint.position] = joint.sign * positions[i]
        if velocities:
            values[joint.rate] = joint.sign * velocities[i]
    return _checked(values, table)


def merged(
    ground: Mapping[str, float],
    later: Mapping[str, float],
    table: InputTable = PLANAR,
) -> dict[str, float]:
    """The inputs that two messages of `ground` ask for together.

    For a joint that both name, those of the later one count.
    """
    named = {
        own
        for joint in table.joints.values()
        if joint.position in later
        for own in (joint.position, joint.rate)
    }
    return {**{name: value for name, value in ground.items() if name not in named}, **later}


def _checked(values: Mapping[str, float], table: InputTable) -> dict[str, float]:
    return {n: float(check_value(table.quantities[n], value)) for n, value in values.items()}


# What a log holds of them: topic, relative to the namespace -> the inputs that act from the
# message's stamp on.
READINGS: dict[str, Callable[..., dict[str, float]]] = {
    APPLIED_WRENCH.name: read_wrench,
    APPLIED_GROUND.name: read_ground,
}


def wrench_vectors(
    values: Mapping[str, float], table: InputTable = PLANAR
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Force and torque in ROS axes: the inverse of `read_wrench`, digit for digit."""
    x, y, z = (values[name] if name else IN_PLANE for name in table.forces)
    about_x, about_y, about_z = (
        moment[1] * values[moment[0]] if moment else 0.0 for moment in table.moments
    )
    return to_ros(x, y, z), (about_x, about_y, about_z)


def ground_joints(
    values: Mapping[str, float], table: InputTable = PLANAR
) -> tuple[list[str], list[float], list[float]]:
    """Names, positions and velocities of `ground`: the inverse of `read_ground`."""
    joints = table.joints.values()
    positions = [joint.sign * values[joint.position] for joint in joints]
    return list(table.joints), positions, [joint.sign * values[joint.rate] for joint in joints]
