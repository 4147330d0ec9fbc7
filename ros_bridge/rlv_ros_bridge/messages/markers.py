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

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS

from .axes import from_ros, to_ros
from .fields import indices
from .legs import leg_points
from .samples import set_stamp, set_vector
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
        vehicle, main, auxiliary = (
            parameters.vehicle,
            parameters.main_strut,
            parameters.auxiliary_strut,
        )
        self._top = (0.0, vehicle.top_height, 0.0)
        self._bottom = (0.0, -max(main.joint_depth, auxiliary.joint_depth), 0.0)
        # The paper's axes, as the sample's.
        self._main = [
            from_ros(*j)
            for j in leg_points(parameters.drop.mode, main.joint_radius, -main.joint_depth)
        ]
        self._auxiliary = [
            from_ros(*j)
            for j in leg_points(
                parameters.drop.mode, auxiliary.joint_radius, -auxiliary.joint_depth
            )
        ]
        self._body = indices("body.x", "body.y", "body.pitch")
        self._feet = [indices(*(f"leg[{leg}].footpad.{axis}" for axis in "xyz")) for leg in LEGS]
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
        count = 2 if name == "body" else len(LEGS) if kind == Marker.SPHERE_LIST else 2 * len(LEGS)
        points = [Point() for _ in range(count)]
        marker.points = points
        self._points.append(points)
        return marker

    def numbers(self, values: Sequence[float]) -> list[float]:
        """The points of a sample in the frame `map`.

        Args:
            values: all outputs in the order of `OUTPUT_NAMES`, SI, the paper's axes.

        Returns:
            x, y, z [m], ROS axes, one point after the other: the body's lower and upper end, the
            main struts' joints, the auxiliary struts' joints, the footpads; each by leg.
        """
        x, y, pitch = (values[i] for i in self._body)
        s, c = sin(pitch), cos(pitch)
        found: list[float] = []
        for bx, by, bz in (self._bottom, self._top, *self._main, *self._auxiliary):
            found += to_ros(x + c * bx + s * by, y - s * bx + c * by, bz)
        for foot in self._feet:
            found += to_ros(*(values[i] for i in foot))
        return found

    def fill(self, nanoseconds: int, values: Sequence[float]) -> MarkerArray:
        """The markers of a sample.

        Args:
            nanoseconds: simulation time of the sample [ns].
            values: all outputs in the order of `OUTPUT_NAMES`, SI, the paper's axes.
        """
        return self._put(nanoseconds, self.numbers(values))

    def _put(self, nanoseconds: int, numbers: Sequence[float]) -> MarkerArray:
        set_stamp(self._stamp, nanoseconds)
        points = list(zip(numbers[::3], numbers[1::3], numbers[2::3]))
        legs = len(LEGS)
        body, main, auxiliary, feet = self._points
        joints, footpads = points[len(body) :], points[-legs:]
        for point, end in zip(body, points):
            set_vector(point, end)
        for leg, foot in enumerate(footpads):
            set_vector(main[2 * leg], joints[leg])
            set_vector(auxiliary[2 * leg], joints[legs + leg])
            for point in (main[2 * leg + 1], auxiliary[2 * leg + 1], feet[leg]):
                set_vector(point, foot)
        return self.message

    def pack(self, nanoseconds: int, values: Sequence[float]) -> bytes:
        """The message of `fill`, serialised: the same bytes, at a fraction of the cost."""
        numbers = self.numbers(values)
        if self._layout is None:
            sentinels = sentinel_numbers(len(numbers))
            message = self._put(SENTINEL_STAMP, sentinels)
            self._layout = MessageLayout([serialize_message(message)], sentinels)
        return self._layout.pack(nanoseconds, numbers)
