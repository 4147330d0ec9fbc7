"""The vehicle's wireframe as markers: body line, struts, footpads, in the frame `map`."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from rclpy.serialization import serialize_message
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from rlv_landing.core.records import Vector
from rlv_landing.core.vectors import rotation, to_inertial
from rlv_landing.parameters import Parameters

from .axes import from_ros, to_ros
from .fields import PLACE, QUATERNION
from .robot_description import auxiliary_joints, axis_point, leg_points, main_joint
from .samples import set_stamp, set_vector
from .tables import table_of
from .topics import WORLD_FRAME
from .wire import SENTINEL_STAMP, MessageLayout, sentinel_numbers

# name, marker type, width [m], colour
STYLES = (
    ("body", Marker.LINE_LIST, 0.08, (0.75, 0.75, 0.80)),
    ("main_struts", Marker.LINE_LIST, 0.05, (0.95, 0.55, 0.15)),
    ("auxiliary_struts", Marker.LINE_LIST, 0.03, (0.25, 0.55, 0.90)),
    ("footpads", Marker.SPHERE_LIST, 0.12, (0.30, 0.75, 0.35)),
)


class Wireframe:
    """The vehicle's lines and footpads, made once and moved with each sample."""

    def __init__(self, parameters: Parameters) -> None:
        vehicle = parameters.vehicle
        depth = max(parameters.main_strut.joint_depth, parameters.auxiliary_strut.joint_depth)
        joints = auxiliary_joints(parameters).values()
        auxiliary = list(zip(*(leg_points(parameters, joint).values() for joint in joints)))
        self._auxiliary_of_a_leg = len(joints)
        # The paper's axes, as the sample's: the body's ends, the struts' joints.
        own: list[tuple[float, float, float]] = [
            axis_point(parameters, -depth),
            axis_point(parameters, vehicle.top_height),
            *leg_points(parameters, main_joint).values(),
            *(joint for places in auxiliary for joint in places),
        ]
        self._own = [from_ros(*point) for point in own]
        interface = parameters.interface
        self._legs, self._in_space = len(interface.legs), interface.in_space
        table = table_of(interface)
        names = (*PLACE, *QUATERNION) if self._in_space else ("body.x", "body.y", "body.pitch")
        self._body = table.indices(*names)
        self._feet = [
            table.indices(*(f"leg[{leg}].footpad.{axis}" for axis in "xyz"))
            for leg in interface.legs
        ]
        self._stamp = Time()
        self._points: list[list[Point]] = []
        self._layout: MessageLayout | None = None
        self.message = MarkerArray()
        for i, (name, kind, width, colour) in enumerate(STYLES):
            self.message.markers.append(self._marker(i, name, kind, width, colour))

    def _marker(
        self, i: int, name: str, kind: int, width: float, colour: tuple[float, float, float]
    ) -> Any:
        marker = Marker(
            ns=name,
            id=i,
            type=kind,
            action=Marker.ADD,
            color=ColorRGBA(r=colour[0], g=colour[1], b=colour[2], a=1.0),
        )
        marker.header.frame_id = WORLD_FRAME
        marker.header.stamp = self._stamp
        set_vector(
            marker.scale, (width, width, width) if kind == Marker.SPHERE_LIST else (width, 0.0, 0.0)
        )
        of_a_leg = {
            "main_struts": 2,
            "auxiliary_struts": 2 * self._auxiliary_of_a_leg,
            "footpads": 1,
        }
        count = 2 if name == "body" else of_a_leg[name] * self._legs
        points = [Point() for _ in range(count)]
        marker.points = points
        self._points.append(points)
        return marker

    def numbers(self, values: Sequence[float]) -> list[float]:
        """The points of a sample in the frame `map`.

        Args:
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.

        Returns:
            x, y, z [m], ROS axes, one point after the other: the body's lower and upper end, the
            main struts' joints, the auxiliary struts' joints, all of one leg side by side, the
            footpads; each by leg.
        """
        found: list[float] = []
        if self._in_space:
            x, y, z, *quaternion = (values[i] for i in self._body)
            turn = rotation(*quaternion)
            for own in self._own:
                at = to_inertial(turn, Vector(*own))
                found += to_ros(x + at.x, y + at.y, z + at.z)
        else:
            x, y, pitch = (values[i] for i in self._body)
            s, c = sin(pitch), cos(pitch)
            for bx, by, bz in self._own:
                found += to_ros(x + c * bx + s * by, y - s * bx + c * by, bz)
        for foot in self._feet:
            found += to_ros(*(values[i] for i in foot))
        return found

    def fill(self, nanoseconds: int, values: Sequence[float]) -> MarkerArray:
        """The markers of a sample.

        Args:
            nanoseconds: simulation time of the sample [ns].
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.
        """
        return self._put(nanoseconds, self.numbers(values))

    def _put(self, nanoseconds: int, numbers: Sequence[float]) -> MarkerArray:
        set_stamp(self._stamp, nanoseconds)
        points = list(zip(numbers[::3], numbers[1::3], numbers[2::3]))
        legs, struts = self._legs, self._auxiliary_of_a_leg
        body, main, auxiliary, feet = self._points
        joints, footpads = points[len(body) :], points[-legs:]
        for point, end in zip(body, points):
            set_vector(point, end)
        for leg, foot in enumerate(footpads):
            set_vector(main[2 * leg], joints[leg])
            for point in (main[2 * leg + 1], feet[leg]):
                set_vector(point, foot)
        for k in range(struts * legs):
            set_vector(auxiliary[2 * k], joints[legs + k])
            set_vector(auxiliary[2 * k + 1], footpads[k // struts])
        return self.message

    def pack(self, nanoseconds: int, values: Sequence[float]) -> bytes:
        """The message of `fill`, serialised: the same bytes, at a fraction of the cost."""
        numbers = self.numbers(values)
        if self._layout is None:
            sentinels = sentinel_numbers(len(numbers))
            message = self._put(SENTINEL_STAMP, sentinels)
            self._layout = MessageLayout([serialize_message(message)], sentinels)
        return self._layout.pack(nanoseconds, numbers)
