"""The vehicle as URDF, and the model's variables as JSON. Needs no ROS 2."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import acos, atan2, dist
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from rlv_landing.parameters import Parameters, parameters_of
from rlv_landing.quantities import STATISTIC_QUANTITIES
from rlv_landing.touchdown import footpad_at_rest, leg_directions

from .axes import to_ros
from .topics import BODY_FRAME, STRUTS_OF, TOP_FRAME

Point = tuple[float, float, float]

BODY_RADIUS, MAIN_RADIUS, AUXILIARY_RADIUS, FOOTPAD_RADIUS = 0.2, 0.03, 0.02, 0.06
# URDF wants a limit of force [N] and speed [m/s] of every joint; the model has none.
NO_LIMIT = {"effort": "1e7", "velocity": "100"}
ORIGIN: Point = (0.0, 0.0, 0.0)


def variables(parameters: Parameters) -> str:
    """The variables of the FMU that lands `parameters`: name, causality, unit and meaning."""
    interface = parameters.interface
    groups = (
        ("parameter", parameters_of(parameters.drop.mode).values()),
        ("input", interface.inputs),
        ("output", interface.outputs),
        ("local", (*STATISTIC_QUANTITIES, *interface.peak_quantities)),
    )
    return json.dumps(
        [
            {"name": q.name, "causality": kind, "unit": q.unit, "meaning": q.meaning}
            for kind, group in groups
            for q in group
        ]
    )


def footpad(leg: Parameters) -> Point:
    """Radius, height, and place across the leg's plane [m] of a footpad at rest."""
    return (*footpad_at_rest(leg), 0.0)


def main_joint(leg: Parameters) -> Point:
    """Radius, height and place across [m] of a main strut's joint on the body."""
    return leg.main_strut.joint_radius, -leg.main_strut.joint_depth, 0.0


def auxiliary_joints(parameters: Parameters) -> dict[str, Callable[[Parameters], Point]]:
    """Each auxiliary strut of a leg, and what gives its joint on the body as `main_joint`."""

    def on(side: float) -> Callable[[Parameters], Point]:
        def joint(leg: Parameters) -> Point:
            a = leg.auxiliary_strut
            return a.joint_radius, -a.joint_depth, side * a.joint_spread

        return joint

    _, *struts = STRUTS_OF[parameters.leg.kind]
    return dict(zip(struts, (on(1.0), on(-1.0)) if len(struts) > 1 else (on(0.0),)))


def leg_points(parameters: Parameters, point: Callable[[Parameters], Point]) -> dict[int, Point]:
    """A point of each leg in the body's frame, whose origin is the CG, by the leg's number.

    Args:
        parameters: the vehicle.
        point: gives radius, height and place across [m] of the point of a leg's parameters.

    Returns:
        x forward, y left, z up [m] for each leg.
    """
    own = parameters.vehicle
    found = {}
    for leg, (sine, cosine) in leg_directions(parameters).items():
        radius, height, across = point(parameters.of_leg(leg))
        x = radius * cosine - across * sine - own.cg_offset_x
        z = radius * sine + across * cosine - own.cg_offset_z
        found[leg] = to_ros(x, height, z)
    return found


def axis_point(parameters: Parameters, height: float) -> Point:
    """The point of the legs' axis at a height above the CG [m], in the body's frame."""
    return to_ros(-parameters.vehicle.cg_offset_x, height, -parameters.vehicle.cg_offset_z)


def robot_description(parameters: Parameters) -> str:
    """The vehicle as URDF: body, top sensor, and the struts of each leg.

    Its root is `base_link`, at the CG. A strut is a prismatic joint of the name that it has in
    `struts`, at 0 fully extended (auxiliary: unloaded), positive in compression. Struts keep the
    direction that they have with all of them extended. Only the markers turn them with the strokes.
    """
    p = parameters
    robot = Element("robot", name="rlv_landing")
    bottom, top = (
        -max(p.main_strut.joint_depth, p.auxiliary_strut.joint_depth),
        p.vehicle.top_height,
    )
    body = SubElement(robot, "link", name=BODY_FRAME)
    _cylinder(body, axis_point(p, 0.5 * (top + bottom)), BODY_RADIUS, top - bottom)
    SubElement(robot, "link", name=TOP_FRAME)
    mount = _joint(robot, f"{TOP_FRAME}_mount", "fixed", BODY_FRAME, TOP_FRAME)
    _origin(mount, (0.0, 0.0, top))
    feet = leg_points(p, footpad)
    for leg, joint in leg_points(p, main_joint).items():
        travel = (0.0, p.of_leg(leg).main_strut.stroke_max)
        _strut(robot, f"leg_{leg}_main_strut", joint, feet[leg], MAIN_RADIUS, travel)
    for strut, place in auxiliary_joints(p).items():
        for leg, joint in leg_points(p, place).items():
            half = 0.5 * p.of_leg(leg).auxiliary_strut.length
            name = f"leg_{leg}_{strut}"
            _strut(robot, name, joint, feet[leg], AUXILIARY_RADIUS, (-half, half))
    indent(robot)
    return '<?xml version="1.0"?>\n' + tostring(robot, encoding="unicode") + "\n"


def _strut(
    robot: Element, name: str, joint: Point, foot: Point, radius: float, travel: tuple[float, float]
) -> None:
    """Adds a cylinder at the body and a rod that goes into it.

    z of both runs along the strut, down to the foot.
    """
    length = dist(joint, foot)
    x, y, z = ((b - a) / length for a, b in zip(joint, foot))
    cylinder = SubElement(robot, "link", name=f"{name}_cylinder")
    _cylinder(cylinder, (0.0, 0.0, 0.25 * length), 1.5 * radius, 0.5 * length)
    rod = SubElement(robot, "link", name=f"{name}_rod")
    _cylinder(rod, (0.0, 0.0, -0.3 * length), radius, 0.6 * length)
    foot_visual = SubElement(rod, "visual")
    SubElement(SubElement(foot_visual, "geometry"), "sphere", radius=repr(FOOTPAD_RADIUS))
    mount = _joint(robot, f"{name}_mount", "fixed", BODY_FRAME, f"{name}_cylinder")
    _origin(mount, joint, (0.0, acos(z), atan2(y, x)))
    moving = _joint(robot, name, "prismatic", f"{name}_cylinder", f"{name}_rod")
    _origin(moving, (0.0, 0.0, length))
    SubElement(moving, "axis", xyz="0 0 -1")
    SubElement(moving, "limit", {"lower": repr(travel[0]), "upper": repr(travel[1]), **NO_LIMIT})


def _joint(robot: Element, name: str, kind: str, parent: str, child: str) -> Element:
    joint = SubElement(robot, "joint", name=name, type=kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


def _cylinder(link: Element, centre: Point, radius: float, length: float) -> None:
    visual = SubElement(link, "visual")
    _origin(visual, centre)
    SubElement(SubElement(visual, "geometry"), "cylinder", radius=repr(radius), length=repr(length))


def _origin(element: Element, xyz: Point, rpy: Point = ORIGIN) -> None:
    SubElement(element, "origin", xyz=" ".join(map(repr, xyz)), rpy=" ".join(map(repr, rpy)))
