"""The linearised vehicle as MJCF, MuJoCo's format."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ..parameters import Parameters
from .mechanism import LegMechanism, Mechanism, mechanism
from .rods import FAR
from .xml_text import child, document

# radius of a footpad's sphere [m]; the plane lies as much lower
RADIUS = 1e-4
TINY = "1e-9 1e-9 1e-9"
# part of the constraint's force that answers accelerations: next to nothing without friction, so
# that the ground is a spring and damper; with friction MuJoCo's usual one, for it makes feet stick
SPRING_PART, USUAL_PART = 1e-4, 0.95
NOTES = (
    "MuJoCo: main struts are tendons between the sites legN_main_joint and legN_footpad, auxiliary",
    "struts slides. Without friction the ground is a spring and damper. With friction it is",
    "MuJoCo's soft contact with the same two numbers, which also answers accelerations. The start",
    "of the landing is the keyframe touchdown: mj_resetDataKeyframe(model, data, 0).",
)
TRIPOD_NOTES = (
    "Legs are tripods: the footpads are free in the body, slides along its axes, and the auxiliary",
    "struts are tendons, too, from legN_auxiliary1_joint and legN_auxiliary2_joint.",
)


def mjcf(parameters: Parameters) -> str:
    """The text of the MJCF file of a landing's vehicle, ground and start.

    Raises:
        LandingError: As `mechanism`.
    """
    made = mechanism(parameters)
    root = Element("mujoco", model="rlv_landing")
    child(root, "compiler", angle="radian")
    child(root, "option", timestep=1e-4, integrator="RK4", gravity=(0.0, 0.0, -made.gravity),
          cone="elliptic", impratio=20.0, tolerance=1e-12)  # fmt: skip
    world = child(root, "worldbody")
    child(world, "geom", name="ground", type="plane", size="0 0 1", zaxis=made.normal,
          pos=-RADIUS * made.normal, contype="0", conaffinity="1", friction="0 0 0")  # fmt: skip
    body = child(world, "body", name="base_link", pos=made.place, quat=made.quaternion)
    child(body, "freejoint", name="base_link")
    i = made.inertia
    child(body, "inertial", pos="0 0 0", mass=made.mass,
          fullinertia=(i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]))  # fmt: skip
    child(body, "site", name="top_sensor", pos=made.top)
    tendons = child(root, "tendon")
    sensors = child(root, "sensor")
    for leg in made.legs:
        _leg(body, tendons, leg)
        child(
            sensors,
            "tendonpos",
            name=f"leg{leg.number}_main_length",
            tendon=f"leg{leg.number}_main",
        )
        _sense_auxiliary(sensors, leg)
    tripod = any(len(leg.auxiliary_joints) > 1 for leg in made.legs)
    _start(root, made, 3 if tripod else 2)
    return document(root, made, (*NOTES, *TRIPOD_NOTES) if tripod else NOTES)


def _sense_auxiliary(sensors: Element, leg: LegMechanism) -> None:
    name = f"leg{leg.number}_auxiliary"
    if len(leg.auxiliary_joints) == 1:
        child(sensors, "jointpos", name=f"{name}_stroke", joint=name)
        return
    for k, _ in enumerate(leg.auxiliary_joints, 1):
        child(sensors, "tendonpos", name=f"{name}{k}_length", tendon=f"{name}{k}")


def _leg(body: Element, tendons: Element, leg: LegMechanism) -> None:
    name = f"leg{leg.number}"
    child(body, "site", name=f"{name}_main_joint", pos=leg.main_joint)
    foot = child(body, "body", name=f"{name}_footpad", pos=leg.foot)
    child(foot, "inertial", pos="0 0 0", mass=leg.mass, diaginertia=TINY)
    if len(leg.auxiliary_joints) == 1:
        to_joint = leg.auxiliary_joints[0] - leg.foot
        length = float((to_joint @ to_joint) ** 0.5)
        child(foot, "joint", name=f"{name}_hinge", type="hinge", axis=leg.axis, pos=to_joint)
        child(foot, "joint", name=f"{name}_auxiliary", type="slide", axis=to_joint / length,
              stiffness=leg.auxiliary.stiffness, damping=leg.auxiliary.damping)  # fmt: skip
    else:
        for axis, along in zip("xyz", ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
            child(foot, "joint", name=f"{name}_{axis}", type="slide", axis=along)
        for k, joint in enumerate(leg.auxiliary_joints, 1):
            child(body, "site", name=f"{name}_auxiliary{k}_joint", pos=joint)
    child(foot, "site", name=f"{name}_footpad")
    _contact(foot, leg)
    if len(leg.auxiliary_joints) > 1:
        for k, _ in enumerate(leg.auxiliary_joints, 1):
            strut = child(tendons, "spatial", name=f"{name}_auxiliary{k}",
                          stiffness=leg.auxiliary.stiffness, damping=leg.auxiliary.damping,
                          springlength=leg.auxiliary_length)  # fmt: skip
            child(strut, "site", site=f"{name}_auxiliary{k}_joint")
            child(strut, "site", site=f"{name}_footpad")
    strut = child(tendons, "spatial", name=f"{name}_main", stiffness=leg.main.stiffness,
                  damping=leg.main.damping, limited="true",
                  springlength=leg.main_length + leg.main.preload / leg.main.stiffness,
                  range=(leg.main_length - leg.stroke_max,
                         leg.main_length + (0.0 if leg.main.preload > 0.0 else FAR)))  # fmt: skip
    child(strut, "site", site=f"{name}_main_joint")
    child(strut, "site", site=f"{name}_footpad")


def _contact(foot: Element, leg: LegMechanism) -> None:
    """The footpad's sphere: `solref` is the ground's spring and damper by MuJoCo's mass of it."""
    part = USUAL_PART if leg.friction > 0.0 else SPRING_PART
    child(
        foot, "geom", name=f"leg{leg.number}_footpad", type="sphere", size=RADIUS,
        contype="1", conaffinity="0", priority="1",
        condim="3" if leg.friction > 0.0 else "1",
        friction=(leg.friction, 0.0, 0.0),
        solref=(-leg.ground.stiffness * leg.inverse_mass, -leg.ground.damping * leg.inverse_mass),
        solimp=(part, part, 0.001),
    )  # fmt: skip


def _start(root: Element, made: Mechanism, coordinates: int) -> None:
    """The start as a keyframe; a leg has so many coordinates in the body."""
    feet = [0.0] * (coordinates * len(made.legs))
    child(
        child(root, "keyframe"),
        "key",
        name="touchdown",
        qpos=(*made.place, *made.quaternion, *feet),
        qvel=(*made.velocity, *made.spin, *feet),
    )
