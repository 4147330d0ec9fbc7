"""Loads at the interfaces of a leg: its joints on the body, and the footpad on the ground.

They follow from a landing's outputs by Newton's law for the footpad. With what the body weighs they
are the body's acceleration, which a test holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import LandingError
from ...history import History
from ...parameters import Parameters
from ...quantities import TRIPOD
from .leg_axes import in_body, leg_axes

Array = NDArray[np.float64]
# components of a load, in this order [N, N.m]
COMPONENTS = ("F radial", "F axial", "F tangential", "M radial", "M axial", "M tangential")
MAIN, AUXILIARY, FOOTPAD = "main strut's body joint", "auxiliary strut's body joint", "footpad"
SECOND = "second auxiliary strut's body joint"
# where the ground strikes the body itself: the axes are those of a leg at azimuth 0
STRIKE = "points of the body (radial, axial, tangential: body x, y, z; about the CG)"
# loads below this part of the largest are rounding
NOTHING = 1e-9


@dataclass(frozen=True)
class Interface:
    """The load at one interface over time.

    Axes are the leg's, fixed in the body: radial outward, axial towards the body's top, and
    tangential = radial x axial.

    Attributes:
        name: The interface.
        leg: The leg's number; 0 for the body itself.
        point: The interface in the leg's axes, from the CG, (n, 3) [m].
        load: What acts on the body, at the footpad what the ground does to it, (n, 6): force [N]
            and moment about the interface [N.m].
    """

    name: str
    leg: int
    point: Array
    load: Array


class Peak(NamedTuple):
    """A component's largest amount, with the whole load at that time.

    Attributes:
        component: The component's number in COMPONENTS.
        time: The time of the sample [s].
        load: All six components at that time [N, N.m].
    """

    component: int
    time: float
    load: tuple[float, ...]


def interface_loads(history: History) -> list[Interface]:
    """The loads at the interfaces of each leg, legs by number: three, of a tripod four.

    The main strut pushes along itself. The auxiliary strut does so too, and it holds the footpad
    in the leg's plane, across itself. With `vehicle.transverse_load_at = footpad` that is a force
    at the footpad, so at the joint a force and a moment. A tripod's struts push along themselves
    alone. (derived: docs/model.md, body and footpads; docs/space.md, what a leg does)

    Raises:
        LandingError: The history does not know its parameters.
    """
    p = history.parameters
    if p is None:
        raise LandingError("this history does not know its parameters, which its loads need")
    struck = [_strike(history)] if p.vehicle.body_points else []
    of_leg = _tripod if p.leg.kind == TRIPOD else _leg
    return [*(found for leg in history.legs for found in of_leg(history, p, leg)), *struck]


def peaks(interface: Interface, time: Array) -> list[Peak]:
    """The peak of each component that is not zero throughout."""
    amounts = np.abs(interface.load)
    force, moment = amounts[:, :3].max(), amounts[:, 3:].max()
    scales = (*(force,) * 3, *(max(moment, NOTHING * force),) * 3)
    found = []
    for i, scale in enumerate(scales):
        row = int(amounts[:, i].argmax())
        if amounts[row, i] > NOTHING * scale > 0.0:
            found.append(Peak(i, float(time[row]), tuple(map(float, interface.load[row]))))
    return found


def _strike(history: History) -> Interface:
    """The ground's loads on the points of the body, all together, about the CG."""
    force, moment = (in_body(history, f"body.strike_{kind}_") for kind in ("force", "moment"))
    return Interface(STRIKE, 0, np.zeros_like(force), np.concatenate([force, moment], axis=1))


def _tripod(history: History, p: Parameters, leg: int) -> list[Interface]:
    axes, own = leg_axes(history, p, leg), p.of_leg(leg)
    m, a = own.main_strut, own.auxiliary_strut
    joints = {
        MAIN: ("main_strut", (m.joint_radius, -m.joint_depth, 0.0)),
        AUXILIARY: ("auxiliary_strut", (a.joint_radius, -a.joint_depth, a.joint_spread)),
        SECOND: ("auxiliary_strut_2", (a.joint_radius, -a.joint_depth, -a.joint_spread)),
    }
    found = []
    for what, (strut, joint) in joints.items():
        point = np.tile(joint, (len(history), 1))
        reach = axes.foot - point
        along = reach / np.linalg.norm(reach, axis=1)[:, None]
        force = history[f"leg[{leg}].{strut}.force"][:, None] * along
        load = np.concatenate([force, np.zeros_like(force)], axis=1)
        found.append(Interface(what, leg, point - axes.offset, load))
    ground = np.concatenate([axes.contact, np.zeros_like(axes.contact)], axis=1)
    return [*found, Interface(FOOTPAD, leg, axes.foot - axes.offset, ground)]


def _leg(history: History, p: Parameters, leg: int) -> list[Interface]:
    axes = leg_axes(history, p, leg)
    joints, along, rates = [], [], []
    own = p.of_leg(leg)
    struts = (("main_strut", own.main_strut), ("auxiliary_strut", own.auxiliary_strut))
    for strut, parameters in struts:
        joint = np.array([parameters.joint_radius, -parameters.joint_depth, 0.0])
        reach = axes.foot - joint
        along.append(reach / np.linalg.norm(reach, axis=1)[:, None])
        joints.append(joint)
        rates.append(-history[f"leg[{leg}].{strut}.stroke_rate"])
    loads = [np.zeros((len(history), 6)) for _ in range(3)]
    for load, unit, strut in zip(loads, along, ("main_strut", "auxiliary_strut")):
        load[:, :3] = history[f"leg[{leg}].{strut}.force"][:, None] * unit
    push = np.zeros_like(axes.foot)
    push[:, 2] = -axes.across(along, rates)
    loads[1][:, :3] += push
    if p.vehicle.transverse_load_at == "footpad":
        loads[1][:, 3:] = np.cross(axes.foot - joints[1], push)
    loads[2][:, :3] = axes.contact
    points = (*(np.tile(joint, (len(history), 1)) for joint in joints), axes.foot)
    return [
        Interface(what, leg, point - axes.offset, load)
        for what, point, load in zip((MAIN, AUXILIARY, FOOTPAD), points, loads)
    ]
