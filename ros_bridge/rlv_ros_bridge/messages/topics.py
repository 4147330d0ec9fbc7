"""The topics of a landing: their names, types and periods.

The table in `fields.py` says which field of a message carries which output.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

from rlv_landing.errors import LandingError
from rlv_landing.quantities import LEGS, RADIAL, TRIPOD

WORLD_FRAME = "map"
# Of REP-105, in which the vehicle moves without jumps; here it is the map.
ODOM_FRAME = "odom"
BODY_FRAME = "base_link"
TOP_FRAME = "top_sensor"


@dataclass(frozen=True)
class Topic:
    """A topic.

    Args:
        name: relative to the node's namespace, unless it starts with a slash.
        type_name: message type `pkg/msg/Type`.
        period: between two messages [s of simulation time]; 0: every step.
    """

    name: str
    type_name: str
    period: float = 0.0

    def __hash__(self) -> int:
        """That of the name, which Python keeps."""
        return hash(self.name)


STRUTS = Topic("struts", "sensor_msgs/msg/JointState")
POSE = Topic("pose", "geometry_msgs/msg/PoseStamped")
RPY = Topic("rpy", "geometry_msgs/msg/Vector3Stamped")
TWIST = Topic("twist", "geometry_msgs/msg/TwistStamped")
ACCEL = Topic("accel", "geometry_msgs/msg/AccelStamped")
IMU = Topic("imu", "sensor_msgs/msg/Imu")
TOP_IMU = Topic("top/imu", "sensor_msgs/msg/Imu")
TOP_ACCEL = Topic("top/accel", "geometry_msgs/msg/AccelStamped")
ODOM = Topic("odom", "nav_msgs/msg/Odometry")
MARKERS = Topic("markers", "visualization_msgs/msg/MarkerArray", 0.033)
# Made by ourselves: there is no wheel of tf2_msgs, so it is published only where ROS 2 has it.
TF = Topic("/tf", "tf2_msgs/msg/TFMessage", 0.01)
DIAGNOSTICS = Topic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", 0.1)
CLOCK = Topic("/clock", "rosgraph_msgs/msg/Clock")

# The inputs as they were applied: stamped with the simulation time from which on they act.
APPLIED_WRENCH = Topic("applied/external_wrench", "geometry_msgs/msg/WrenchStamped")
APPLIED_GROUND = Topic("applied/ground", "sensor_msgs/msg/JointState")
ROBOT_DESCRIPTION = Topic("robot_description", "std_msgs/msg/String")
VARIABLES = Topic("variables", "std_msgs/msg/String")

OCCASIONAL: tuple[Topic, ...] = (MARKERS, TF, DIAGNOSTICS)
APPLIED: tuple[Topic, ...] = (APPLIED_WRENCH, APPLIED_GROUND)
# Published once, and kept for subscribers that come later.
LATCHED: tuple[Topic, ...] = (ROBOT_DESCRIPTION, VARIABLES)


# of each kind of leg
STRUTS_OF: dict[str, tuple[str, ...]] = {
    RADIAL: ("main_strut", "auxiliary_strut"),
    TRIPOD: ("main_strut", "auxiliary_strut", "auxiliary_strut_2"),
}


@dataclass(frozen=True)
class LegTopics:
    """What depends on a vehicle's legs.

    Attributes:
        footpad_frames: the frames at the footpads, with the axes of the map.
        joints: the names of the struts in `struts`.
        contacts: the topics of the contact forces.
        sampled: the topics that are published at every step.
        recorded: what is recorded, in the order in which it is published at one instant. The clock
            is not: a replay makes its own.
    """

    footpad_frames: tuple[str, ...]
    joints: tuple[str, ...]
    contacts: tuple[Topic, ...]
    sampled: tuple[Topic, ...]
    recorded: tuple[Topic, ...]


@cache
def topics_of(legs: tuple[int, ...], kind: str = RADIAL) -> LegTopics:
    """What depends on the `legs`, given by their numbers, and their kind.

    The kind has its own struts; the topics are the same.
    """
    contacts = tuple(Topic(f"leg_{leg}/contact", "geometry_msgs/msg/WrenchStamped") for leg in legs)
    sampled = (STRUTS, POSE, RPY, TWIST, ACCEL, TOP_ACCEL, *contacts, ODOM, IMU, TOP_IMU)
    return LegTopics(
        footpad_frames=tuple(f"leg_{leg}_footpad" for leg in legs),
        joints=tuple(f"leg_{leg}_{strut}" for leg in legs for strut in STRUTS_OF[kind]),
        contacts=contacts,
        sampled=sampled,
        recorded=(*sampled, *OCCASIONAL, *APPLIED, ROBOT_DESCRIPTION),
    )


# Those of symmetric landings, which have four legs.
JOINTS: tuple[str, ...] = topics_of(LEGS).joints
CONTACTS: tuple[Topic, ...] = topics_of(LEGS).contacts
SAMPLED: tuple[Topic, ...] = topics_of(LEGS).sampled
RECORDED: tuple[Topic, ...] = topics_of(LEGS).recorded


# ROS 2 takes 245 characters, and the name of a topic below them
LONGEST_NAMESPACE = 200
_TOKEN = "[A-Za-z_][A-Za-z0-9_]*"
_FRAME_PREFIX = re.compile(f"(?:[A-Za-z0-9_.-][A-Za-z0-9_./-]{{0,{LONGEST_NAMESPACE - 1}}})?")
_NAMESPACE = re.compile(f"/?(?:{_TOKEN}(?:/{_TOKEN})*)?")


def check_namespace(namespace: str) -> None:
    """Checks that ROS 2 takes the namespace.

    Raises:
        LandingError: it does not.
    """
    if len(namespace) > LONGEST_NAMESPACE or not _NAMESPACE.fullmatch(namespace):
        raise LandingError(
            f"namespace {namespace!r} is none of ROS 2's; write at most {LONGEST_NAMESPACE} "
            "letters, digits and underscores, with '/' between parts, each of which starts with a "
            "letter or an underscore"
        )


def check_frame_prefix(prefix: str) -> None:
    """Checks that frames may begin with `prefix`.

    Raises:
        LandingError: they may not.
    """
    if not _FRAME_PREFIX.fullmatch(prefix):
        raise LandingError(
            f"frame_prefix = {prefix!r} cannot begin the name of a frame; write at most "
            f"{LONGEST_NAMESPACE} letters, digits, '_', '-', '.' and '/', the first no '/'"
        )


def framed(prefix: str, frame: str) -> str:
    """The name of `frame` of a vehicle whose frames have `prefix`; the map is everybody's."""
    return frame if frame == WORLD_FRAME else prefix + frame


def resolve(namespace: str, name: str) -> str:
    """The full name of a topic under `namespace`."""
    return name if name.startswith("/") else f"/{namespace.strip('/')}/{name}".replace("//", "/")
