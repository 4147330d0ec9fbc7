"""The axes of a leg, fixed in the body, in a symmetric landing and in space.

Radial outward, axial towards the body's top, tangential = radial x axial.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...history import History
from ...parameters import Parameters
from ...quantities import SPACE
from ...touchdown import leg_directions

Array = NDArray[np.float64]


class LegAxes(Protocol):
    """One leg's axes over the time of a landing."""

    foot: Array
    """The footpad from the legs' axis at the height of the CG, (n, 3) [m]."""
    contact: Array
    """The ground's force on the footpad, (n, 3) [N]."""
    offset: Array
    """The CG from the legs' axis, (3,) [m]."""

    def across(self, along: list[Array], rates: list[Array]) -> Array:
        """The force of the leg on its footpad along the tangential axis, (n,) [N].

        Args:
            along: Of both struts, the unit vector from joint to footpad, (n, 3).
            rates: The rates of both struts' lengths, (n,) [m/s].
        """
        ...


def leg_axes(history: History, parameters: Parameters, leg: int) -> LegAxes:
    """The axes of a leg."""
    kind = _InSpace if parameters.drop.mode == SPACE else _Symmetric
    return kind(history, parameters, leg, leg_directions(parameters)[leg])


def in_leg(vector: Array, direction: tuple[float, float]) -> Array:
    """The radial, axial and tangential components of a vector.

    Args:
        vector: Its components along body x, y and z, (3,) or (n, 3).
        direction: Sine and cosine of the leg's azimuth.
    """
    x, y, z = vector.T
    sine, cosine = direction
    return np.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=-1)


def in_body(history: History, name: str) -> Array:
    """The vector whose inertial components' columns begin with `name`, in body axes, (n, 3)."""
    turn = Rotation.from_quat(np.column_stack([history[f"body.q_{part}"] for part in "xyzw"]))
    vector: Array = turn.inv().apply(np.column_stack([history[f"{name}{axis}"] for axis in "xyz"]))
    return vector


class _InSpace:
    def __init__(
        self, history: History, parameters: Parameters, leg: int, direction: tuple[float, float]
    ) -> None:
        v = parameters.vehicle
        place, foot, force = (
            in_body(history, name)
            for name in ("body.", f"leg[{leg}].footpad.", f"leg[{leg}].contact.force_")
        )
        self.offset = in_leg(np.array([v.cg_offset_x, 0.0, v.cg_offset_z]), direction)
        self.foot = in_leg(foot - place, direction) + self.offset
        self.contact = in_leg(force, direction)
        self._history, self._leg = history, leg

    def across(self, along: list[Array], rates: list[Array]) -> Array:
        """The landing's own output."""
        return self._history[f"leg[{self._leg}].auxiliary_strut.transverse_force"]


class _Symmetric:
    def __init__(
        self, history: History, parameters: Parameters, leg: int, direction: tuple[float, float]
    ) -> None:
        self._sine, self._cosine = direction
        pitch = history["body.pitch"]
        self._turn = np.sin(pitch), np.cos(pitch)
        self._rate, self._turning = history["body.pitch_rate"], history["body.pitch_acceleration"]
        nothing = np.zeros(len(history))
        self._forward = self._in_body(history["body.ax"], history["body.ay"], nothing)[:, 0]
        self._mass, self._gravity = parameters.vehicle.footpad_mass, parameters.ground.gravity
        name = f"leg[{leg}]."
        x, y = (history[f"{name}footpad.{a}"] - history[f"body.{a}"] for a in "xy")
        force_x, force_y, force_z = (history[f"{name}contact.force_{axis}"] for axis in "xyz")
        self.offset = np.zeros(3)
        self.foot = in_leg(self._in_body(x, y, history[f"{name}footpad.z"]), direction)
        self.contact = in_leg(self._in_body(force_x, force_y, force_z), direction)

    def _in_body(self, x: Array, y: Array, z: Array) -> Array:
        sine, cosine = self._turn
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, z], axis=-1)

    def across(self, along: list[Array], rates: list[Array]) -> Array:
        """By Newton's law for the footpad, which stays in the leg's plane."""
        forward = (
            self._forward
            + self._turning * self.foot[:, 1]
            - self._rate**2 * self.foot[:, 0] * self._cosine
            + 2.0 * self._rate * _axial_speed(along, rates)
        )
        weight = self._mass * self._gravity * self._sine * -self._turn[0]
        result: Array = -self._mass * self._sine * forward - self.contact[:, 2] - weight
        return result


def _axial_speed(along: list[Array], rates: list[Array]) -> Array:
    """The footpad's speed in the leg's plane along the body's axis, by the struts' rates."""
    (r1, h1), (r2, h2) = (unit[:, :2].T for unit in along)
    speed: Array = (r1 * rates[1] - r2 * rates[0]) / (r1 * h2 - r2 * h1)
    return speed
