"""Loads at the interfaces of a leg: both joints of the body, and the footpad on the ground.

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
from ...quantities import azimuth, groups_of

Array = NDArray[np.float64]
# components of a load, in this order [N, N.m]
COMPONENTS = ("F radial", "F axial", "F tangential", "M radial", "M axial", "M tangential")
MAIN, AUXILIARY, FOOTPAD = "main strut's body joint", "auxiliary strut's body joint", "footpad"
# loads below this part of the largest are rounding
NOTHING = 1e-9


@dataclass(frozen=True)
class Interface:
    """The load at one interface over time.

    Axes are the leg's, fixed in the body: radial outward, axial towards the body's top, and
    tangential = radial x axial.

    Attributes:
        name: The interface.
        leg: The leg's number.
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
    """The loads at the three interfaces of each leg of a symmetric landing, legs by number.

    The main strut pushes along itself. The auxiliary strut does so too, and it holds the footpad
    in the leg's plane, across itself. With `vehicle.transverse_load_at = footpad` that is a force
    at the footpad, so at the joint a force and a moment. (derived: docs/model.md, body and
    footpads)

    Raises:
        LandingError: The history does not know its parameters, or is of a landing in space.
    """
    p = history.parameters
    if p is None:
        raise LandingError("this history does not know its parameters, which its loads need")
    legs = {
        leg: (side * azimuth(g.azimuth)[0], azimuth(g.azimuth)[1])
        for g in groups_of(p.drop.mode)
        for leg, side in g.legs
    }
    return [found for leg in sorted(legs) for found in _leg(history, p, leg, *legs[leg])]


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


def _leg(history: History, p: Parameters, leg: int, sine: float, cosine: float) -> list[Interface]:
    turn = _Turn(history, sine, cosine)
    name = f"leg[{leg}]."
    foot = turn.to_leg(
        history[f"{name}footpad.x"] - history["body.x"],
        history[f"{name}footpad.y"] - history["body.y"],
        history[f"{name}footpad.z"],
    )
    contact = turn.to_leg(*(history[f"{name}contact.force_{axis}"] for axis in "xyz"))
    joints, along, lengths, rates = [], [], [], []
    for strut, parameters in (("main_strut", p.main_strut), ("auxiliary_strut", p.auxiliary_strut)):
        joint = np.zeros_like(foot)
        joint[:, 0], joint[:, 1] = parameters.joint_radius, -parameters.joint_depth
        lengths.append(np.hypot(*(foot - joint)[:, :2].T))
        along.append((foot - joint) / lengths[-1][:, None])
        joints.append(joint)
        rates.append(-history[f"{name}{strut}.stroke_rate"])
    speed = _speed(along, rates)
    inertia = p.vehicle.footpad_mass * turn.tangential(foot, speed)
    weight = turn.to_leg(0.0, -p.vehicle.footpad_mass * p.ground.gravity, 0.0)
    across = inertia - contact[:, 2] - weight[:, 2]
    loads = [np.zeros((len(history), 6)) for _ in range(3)]
    for load, unit, strut in zip(loads, along, ("main_strut", "auxiliary_strut")):
        load[:, :3] = history[f"{name}{strut}.force"][:, None] * unit
    push = np.zeros_like(foot)
    push[:, 2] = -across
    loads[1][:, :3] += push
    if p.vehicle.transverse_load_at == "footpad":
        loads[1][:, 3:] = np.cross(foot - joints[1], push)
    loads[2][:, :3] = contact
    points = (*joints, foot)
    return [
        Interface(what, leg, point, load)
        for what, point, load in zip((MAIN, AUXILIARY, FOOTPAD), points, loads)
    ]


def _speed(along: list[Array], rates: list[Array]) -> Array:
    """The footpad's speed in the leg's plane, (n, 2) [m/s], by the struts' rates."""
    (r1, h1), (r2, h2) = (unit[:, :2].T for unit in along)
    determinant = r1 * h2 - r2 * h1
    radial = (rates[0] * h2 - rates[1] * h1) / determinant
    axial = (r1 * rates[1] - r2 * rates[0]) / determinant
    return np.stack([radial, axial], axis=-1)


class _Turn:
    """From inertial axes to those of a leg, and the acceleration in them."""

    def __init__(self, history: History, sine: float, cosine: float) -> None:
        self.sine, self.cosine = sine, cosine
        pitch = history["body.pitch"]
        self.pitch_sine, self.pitch_cosine = np.sin(pitch), np.cos(pitch)
        self.rate, self.turning = history["body.pitch_rate"], history["body.pitch_acceleration"]
        self.forward = self._in_body(history["body.ax"], history["body.ay"])[0]

    def _in_body(self, x: Array | float, y: Array | float) -> tuple[Array, Array]:
        s, c = self.pitch_sine, self.pitch_cosine
        return x * c - y * s, x * s + y * c

    def to_leg(self, x: Array | float, y: Array | float, z: Array | float) -> Array:
        """A vector's components radial, axial and tangential, (n, 3)."""
        forward, up = self._in_body(x, y)
        radial = self.cosine * forward + self.sine * z
        return np.stack([radial, up, self.cosine * z - self.sine * forward], axis=-1)

    def tangential(self, foot: Array, speed: Array) -> Array:
        """The footpad's acceleration along the tangential axis [m/s2]."""
        forward = (
            self.forward
            + self.turning * foot[:, 1]
            - self.rate**2 * foot[:, 0] * self.cosine
            + 2.0 * self.rate * speed[:, 1]
        )
        result: Array = -self.sine * forward
        return result
