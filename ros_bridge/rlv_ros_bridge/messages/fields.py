"""What the fields of a landing's messages must hold, by their names: what `messages.py` publishes,
told without ROS 2.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from rlv_landing.quantities import LEGS

from .axes import IN_PLANE, pitch_quaternion, to_ros, world_to_body
from .topics import (
    ACCEL,
    BODY_FRAME,
    CONTACTS,
    JOINTS,
    ODOM,
    POSE,
    RPY,
    STRUTS,
    TOP_ACCEL,
    TOP_FRAME,
    TWIST,
    WORLD_FRAME,
)

Values = Mapping[str, float]
Fields = dict[str, Any]
QUANTITIES = {"position": "stroke", "velocity": "stroke_rate", "effort": "force"}


def _vector(at: str, vector: tuple[float, float, float]) -> Fields:
    return dict(zip((f"{at}.x", f"{at}.y", f"{at}.z"), vector))


def _struts(v: Values) -> Fields:
    columns = [f"leg[{leg}].{strut}" for leg in LEGS for strut in ("main_strut", "auxiliary_strut")]
    values = {
        f"{field}[{i}]": v[f"{c}.{what}"]
        for field, what in QUANTITIES.items()
        for i, c in enumerate(columns)
    }
    return {
        **values,
        **{f"name[{i}]": joint for i, joint in enumerate(JOINTS)},
        "header.frame_id": BODY_FRAME,
    }


def _pose(v: Values, at: str = "pose") -> Fields:
    turn = dict(zip((f"{at}.orientation.{c}" for c in "xyzw"), pitch_quaternion(v["body.pitch"])))
    return {
        **_vector(f"{at}.position", to_ros(v["body.x"], v["body.y"], IN_PLANE)),
        **turn,
        "header.frame_id": WORLD_FRAME,
    }


def _twist(v: Values) -> Fields:
    linear = _vector("twist.linear", to_ros(v["body.vx"], v["body.vy"], IN_PLANE))
    return {**linear, "twist.angular.y": v["body.pitch_rate"], "header.frame_id": WORLD_FRAME}


def _accel(v: Values) -> Fields:
    linear = _vector("accel.linear", to_ros(v["body.ax"], v["body.ay"], IN_PLANE))
    return {
        **linear,
        "accel.angular.y": v["body.pitch_acceleration"],
        "header.frame_id": WORLD_FRAME,
    }


def _odom(v: Values) -> Fields:
    x, _, z = to_ros(v["body.vx"], v["body.vy"], IN_PLANE)
    forward, up = world_to_body(x, z, v["body.pitch"])
    twist = {
        "twist.twist.linear.x": forward,
        "twist.twist.linear.z": up,
        "twist.twist.angular.y": v["body.pitch_rate"],
    }
    return {**_pose(v, "pose.pose"), **twist, "child_frame_id": BODY_FRAME}


def _contact(leg: int) -> Callable[[Values], Fields]:
    names = [f"leg[{leg}].contact.force_{axis}" for axis in "xyz"]

    def contact(v: Values) -> Fields:
        x, y, z = (v[name] for name in names)
        return {**_vector("wrench.force", to_ros(x, y, z)), "header.frame_id": WORLD_FRAME}

    return contact


# relative topic -> what its fields must hold at a sample; a field that is not named is 0, or empty
FIELDS: dict[str, Callable[[Values], Fields]] = {
    STRUTS.name: _struts,
    POSE.name: _pose,
    RPY.name: lambda v: {"vector.y": v["body.pitch"], "header.frame_id": WORLD_FRAME},
    TWIST.name: _twist,
    ACCEL.name: _accel,
    TOP_ACCEL.name: lambda v: {
        "accel.linear.z": v["body.top_axial_acceleration"],
        "header.frame_id": TOP_FRAME,
    },
    **{topic.name: _contact(leg) for leg, topic in zip(LEGS, CONTACTS)},
    ODOM.name: _odom,
}


def expected_fields(topic: str, values: Values, nanoseconds: int) -> Fields:
    """The fields of the message of `topic` (relative) at the sample `values` (outputs by name) and
    the time `nanoseconds`.
    """
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return {**FIELDS[topic](values), "header.stamp.sec": seconds, "header.stamp.nanosec": rest}


def leaves(message: Any, at: str = "") -> Iterator[tuple[str, Any]]:
    """Every number and text in a decoded message, by the path to it."""
    if isinstance(message, (list, tuple, array)):
        for i, element in enumerate(message):
            yield from leaves(element, f"{at}[{i}]")
    elif hasattr(message, "__slots__"):
        for name in message.__slots__:
            yield from leaves(getattr(message, name), f"{at}.{name}" if at else name)
    else:
        yield at, message
