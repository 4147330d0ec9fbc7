"""The linearised vehicle as URDF."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from ..parameters import Parameters
from .mechanism import LegMechanism, Vector, mechanism
from .rods import POINT, ROD_MASS, Rod, rods
from .xml_text import child, document, written

RADIUS = 0.03
# URDF wants a limit of force [N] and speed [m/s] of every joint; the model has none
NO_LIMIT = {"effort": "1e9", "velocity": "1e3"}
NOTES = (
    "URDF: a tree, so the main strut's rod ends at the footpad without a joint: close it there by",
    "legN_main_end and legN_footpad, which coincide. A tripod's struts have two hinges each on the",
    "body, and legN_auxiliary2_end is left open, too. Struts are prismatic joints, 0 at full",
    "length and positive in compression. URDF has no springs: stiffness and free stroke stand in",
    "the gazebo elements, as springStiffness and springReference.",
)


def urdf(parameters: Parameters) -> str:
    """The text of the URDF file of a landing's vehicle; `base_link` is its root.

    Raises:
        LandingError: As `mechanism`.
    """
    made = mechanism(parameters)
    root = Element("robot", name="rlv_landing")
    _link(root, "base_link", made.mass, made.inertia)
    child(root, "link", name="top_sensor")
    _joint(root, "top_sensor_mount", "fixed", "base_link", "top_sensor", made.top)
    for leg in made.legs:
        _leg(root, leg)
    return document(root, made, NOTES)


def _link(root: Element, name: str, mass: float, inertia: Vector) -> Element:
    link = child(root, "link", name=name)
    inertial = child(link, "inertial")
    child(inertial, "origin", xyz="0 0 0", rpy="0 0 0")
    child(inertial, "mass", value=mass)
    pairs = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    tensor = child(inertial, "inertia")
    for i, j in pairs:
        tensor.set(f"i{'xyz'[i]}{'xyz'[j]}", written(float(inertia[i, j])))
    return link


def _leg(root: Element, leg: LegMechanism) -> None:
    foot = _link(root, f"leg{leg.number}_footpad", leg.mass, POINT)
    for part in ("visual", "collision"):
        child(child(child(foot, part), "geometry"), "sphere", radius=RADIUS)
    main, carrier, *others = rods(leg)
    for rod in (main, *others):
        _link(root, f"{rod.name}_end", ROD_MASS, POINT)
    for rod in (main, carrier, *others):
        _hinge(root, rod)
        _slide(root, rod, f"leg{leg.number}_footpad" if rod is carrier else f"{rod.name}_end")


def _hinge(root: Element, rod: Rod) -> None:
    """The joint on the body: a revolute one, of a tripod two with a cross between."""
    upper = f"{rod.name}_upper"
    parent, place = "base_link", rod.joint
    names = (f"{rod.name}_cross", upper)[-len(rod.axes) :]
    for k, (to, axis) in enumerate(zip(names, rod.axes), 1):
        _link(root, to, ROD_MASS, POINT)
        name = f"{rod.name}_hinge" if k == 1 else f"{rod.name}_hinge{k}"
        hinge = _joint(root, name, "revolute", parent, to, place)
        child(hinge, "axis", xyz=axis)
        child(hinge, "limit", lower=-np.pi, upper=np.pi, **NO_LIMIT)
        parent, place = to, np.zeros(3)


def _joint(root: Element, name: str, kind: str, parent: str, to: str, place: Vector) -> Element:
    joint = child(root, "joint", name=name, type=kind)
    child(joint, "origin", xyz=place, rpy="0 0 0")
    child(joint, "parent", link=parent)
    child(joint, "child", link=to)
    return joint


def _slide(root: Element, rod: Rod, end: str) -> None:
    slide = _joint(root, rod.name, "prismatic", f"{rod.name}_upper", end, rod.foot - rod.joint)
    child(slide, "axis", xyz=rod.along)
    child(slide, "limit", lower=rod.least, upper=rod.most, **NO_LIMIT)
    child(slide, "dynamics", damping=rod.linear.damping, friction="0.0")
    gazebo = child(root, "gazebo", reference=rod.name)
    child(gazebo, "springStiffness", written(rod.linear.stiffness))
    child(gazebo, "springReference", written(rod.free_stroke))
