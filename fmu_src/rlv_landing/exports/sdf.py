"""The linearised vehicle as SDF, Gazebo's format."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from ..parameters import Parameters
from .mechanism import LegMechanism, Mechanism, Vector, mechanism
from .rods import POINT, ROD_MASS, Rod, rods
from .xml_text import child, document, written

RADIUS = 1e-3


def sdf(parameters: Parameters) -> str:
    """The text of the SDF file, version 1.9: a world with the ground, and the vehicle at its start.

    Raises:
        LandingError: As `mechanism`.
    """
    made = mechanism(parameters)
    root = Element("sdf", version="1.9")
    world = child(root, "world", name="landing")
    child(world, "gravity", written((0.0, 0.0, -made.gravity)))
    _ground(world, made)
    model = child(world, "model", name="rlv_landing")
    x, y, z = made.quaternion[1:]
    child(model, "pose", written((*made.place, x, y, z, made.quaternion[0])),
          rotation_format="quat_xyzw")  # fmt: skip
    _link(model, "base_link", np.zeros(3), made.mass, made.inertia)
    child(child(model, "frame", name="top_sensor", attached_to="base_link"), "pose",
          written((*made.top, 0.0, 0.0, 0.0)))  # fmt: skip
    for leg in made.legs:
        _leg(model, leg)
    notes = (
        "SDF: each strut is a revolute joint, of a tripod a universal one, a rod of 1 g, and a",
        "prismatic joint with spring and damper, 0 at full length and positive in compression; the",
        "main strut closes a loop at the footpad, of a tripod legN_auxiliary2 another, by balls.",
        "The start's velocity, which SDF does not carry, is",
        f"{written(made.velocity)} m/s, inertial axes, and {written(made.spin)} rad/s, body axes.",
    )
    return document(root, made, notes)


def _ground(world: Element, made: Mechanism) -> None:
    model = child(world, "model", name="ground")
    child(model, "static", "true")
    collision = child(child(model, "link", name="ground"), "collision", name="ground")
    child(collision, "pose", written((*(-RADIUS * made.normal), 0.0, 0.0, 0.0)))
    plane = child(child(collision, "geometry"), "plane")
    child(plane, "normal", written(made.normal))
    child(plane, "size", "100 100")


def _link(model: Element, name: str, place: Vector, mass: float, inertia: Vector) -> Element:
    link = child(model, "link", name=name)
    child(link, "pose", written((*place, 0.0, 0.0, 0.0)))
    inertial = child(link, "inertial")
    child(inertial, "mass", written(mass))
    tensor = child(inertial, "inertia")
    for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
        child(tensor, f"i{'xyz'[i]}{'xyz'[j]}", written(float(inertia[i, j])))
    return link


def _leg(model: Element, leg: LegMechanism) -> None:
    foot = f"leg{leg.number}_footpad"
    _contact(_link(model, foot, leg.foot, leg.mass, POINT), leg)
    main, carrier, *others = rods(leg)
    for rod in (main, carrier, *others):
        _link(model, f"{rod.name}_upper", rod.joint, ROD_MASS, POINT)
        _joint(model, f"{rod.name}_hinge", "base_link", f"{rod.name}_upper", rod.axes)
    _slide(model, carrier, foot)
    for rod in (main, *others):
        end = f"{rod.name}_rod"
        _link(model, end, leg.foot, ROD_MASS, POINT)
        _slide(model, rod, end)
        # the footpad of a tripod turns with the strut that carries it
        _joint(model, f"{rod.name}_end", end, foot, rod.axes if len(rod.axes) == 1 else ())


def _contact(link: Element, leg: LegMechanism) -> None:
    collision = child(link, "collision", name=f"leg{leg.number}_footpad")
    child(child(child(collision, "geometry"), "sphere"), "radius", written(RADIUS))
    surface = child(collision, "surface")
    friction = child(child(surface, "friction"), "ode")
    child(friction, "mu", written(leg.friction))
    child(friction, "mu2", written(leg.friction))
    contact = child(child(surface, "contact"), "ode")
    child(contact, "kp", written(leg.ground.stiffness))
    child(contact, "kd", written(leg.ground.damping))


# by the number of axes about which a joint turns
TURNING = ("ball", "revolute", "universal")


def _joint(
    model: Element, name: str, parent: str, to: str, axes: Sequence[Vector], kind: str = ""
) -> list[Element]:
    """A joint that turns about its axes, about all where there are none; its axes."""
    joint = child(model, "joint", name=name, type=kind or TURNING[len(axes)])
    child(joint, "parent", parent)
    child(joint, "child", to)
    made = [child(joint, tag) for tag, _ in zip(("axis", "axis2"), axes)]
    for axis, direction in zip(made, axes):
        child(axis, "xyz", written(direction), expressed_in="__model__")
    return made


def _slide(model: Element, rod: Rod, end: str) -> None:
    (axis,) = _joint(model, rod.name, f"{rod.name}_upper", end, [rod.along], "prismatic")
    dynamics = child(axis, "dynamics")
    child(dynamics, "damping", written(rod.linear.damping))
    child(dynamics, "spring_reference", written(rod.free_stroke))
    child(dynamics, "spring_stiffness", written(rod.linear.stiffness))
    limit = child(axis, "limit")
    child(limit, "lower", written(rod.least))
    child(limit, "upper", written(rod.most))
