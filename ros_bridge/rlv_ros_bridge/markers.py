"""The vehicle's wireframe as markers: body line, struts, footpads, in the frame `map`."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from rlv_landing.parameters import Parameters, azimuth
from rlv_landing.quantities import LEGS, MODES

from .axes import to_ros
from .messages import columns, set_stamp, set_vector
from .topics import WORLD_FRAME

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
        vehicle, main, auxiliary = parameters.vehicle, parameters.main_strut, parameters.auxiliary_strut
        turns = {leg: (*azimuth(g.azimuth), side) for g in MODES[parameters.drop.mode] for leg, side in g.legs}
        self._top = (0.0, vehicle.top_height, 0.0)
        self._bottom = (0.0, -max(main.joint_depth, auxiliary.joint_depth), 0.0)
        self._main = [_joint(main.joint_radius, main.joint_depth, *turns[leg]) for leg in LEGS]
        self._auxiliary = [_joint(auxiliary.joint_radius, auxiliary.joint_depth, *turns[leg]) for leg in LEGS]
        self._body = columns("body.x", "body.y", "body.pitch")
        self._feet = [columns(*(f"leg[{leg}].footpad.{axis}" for axis in "xyz")) for leg in LEGS]
        self._stamp = Time()
        self._points: list[list[Point]] = []
        self.message = MarkerArray()
        for i, (name, kind, width, colour) in enumerate(STYLES):
            self.message.markers.append(self._marker(i, name, kind, width, colour))

    def _marker(self, i: int, name: str, kind: int, width: float, colour: tuple[float, float, float]) -> Any:
        marker = Marker(ns=name, id=i, type=kind, action=Marker.ADD, color=ColorRGBA(r=colour[0], g=colour[1], b=colour[2], a=1.0))
        marker.header.frame_id = WORLD_FRAME
        marker.header.stamp = self._stamp
        set_vector(marker.scale, (width, width, width) if kind == Marker.SPHERE_LIST else (width, 0.0, 0.0))
        count = 2 if name == "body" else len(LEGS) if kind == Marker.SPHERE_LIST else 2 * len(LEGS)
        points = [Point() for _ in range(count)]
        marker.points = points
        self._points.append(points)
        return marker

    def fill(self, nanoseconds: int, values: Sequence[float]) -> MarkerArray:
        """The markers of the sample `values` at the simulation time `nanoseconds`."""
        set_stamp(self._stamp, nanoseconds)
        x, y, pitch = (values[i] for i in self._body)
        s, c = sin(pitch), cos(pitch)

        def place(point: Point, body: tuple[float, float, float]) -> None:
            bx, by, bz = body
            set_vector(point, to_ros(x + c * bx + s * by, y - s * bx + c * by, bz))

        body, main, auxiliary, feet = self._points
        place(body[0], self._bottom)
        place(body[1], self._top)
        for leg, where in enumerate(self._feet):
            foot = to_ros(*(values[i] for i in where))
            place(main[2 * leg], self._main[leg])
            place(auxiliary[2 * leg], self._auxiliary[leg])
            for point in (main[2 * leg + 1], auxiliary[2 * leg + 1], feet[leg]):
                set_vector(point, foot)
        return self.message


def _joint(radius: float, depth: float, sine: float, cosine: float, side: int) -> tuple[float, float, float]:
    """A joint from the CG in body axes, the paper's: x forward, y up, z right."""
    return radius * cosine, -depth, side * radius * sine
