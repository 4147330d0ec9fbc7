"""A vehicle on three struts a leg as a Newton-Euler model that shares no code with the kernels.

Each footpad is a free point mass whose state is its place and velocity in the inertial frame: there
is no leg's plane, no coordinate in the body, no Coriolis or centripetal term. Three struts between
the body's joints and the footpad act on both. The laws of struts and ground are those of
`vehicle_3d.py`.

Axes and units as there. Arrays of vectors are (3, n): component, leg.
"""

from __future__ import annotations

import numpy as np
from vehicle_3d import LEGS, POSITION, QUATERNION, SPIN, VELOCITY, Array, Vehicle3D, cross, rotation

from rlv_landing import Parameters

# of each leg: place (3), velocity (3), upper and lower chamber, friction displacements
OF_A_LEG = 10


class Tripod3D(Vehicle3D):
    """The right-hand side of the vehicle: the body's 13 states, then (10, n)."""

    def __init__(self, parameters: Parameters) -> None:
        super().__init__(parameters)
        spread = parameters.auxiliary_strut.joint_spread * self.e_t
        # main strut, then the auxiliary strut on the side of e_t, then the one on the other side
        self.joints = (self.main_joint, self.aux_joint + spread, self.aux_joint - spread)
        self.lengths = (self.damper.length, self.strut.length, self.strut.length)

    def scale(self) -> Array:
        """What counts as small in each state."""
        leg = [0.1] * 3 + [1.0] * 3 + [1e5, 1e5, 1e-3, 1e-3]
        return np.concatenate(([0.1] * 7, [1.0] * 6, np.repeat(leg, self.n)))

    def start_at(self, now: dict[str, float]) -> Array:
        """The state of outputs at which no leg moves in the body."""
        legs = np.zeros((OF_A_LEG, self.n))
        legs[:3] = [[now[f"leg[{i + 1}].footpad.{a}"] for i in range(self.n)] for a in "xyz"]
        body = [now[f"body.{name}"] for name in ("x", "y", "z", "q_w", "q_x", "q_y", "q_z")]
        speed = np.array([now[f"body.v{axis}"] for axis in "xyz"])
        spin = np.array([now[f"body.spin_{axis}"] for axis in "xyz"])
        R = rotation(np.array(body[3:]))
        arm = R.T @ (legs[:3] - np.array(body[:3])[:, None])
        legs[3:6] = speed[:, None] + R @ cross(spin[:, None], arm)
        legs[6:8] = self.damper.charge_pressure
        return np.concatenate((body, speed, spin, legs.ravel()))

    def relative(self, y: Array) -> tuple[Array, Array]:
        """Places and velocities of the footpads as seen from the body, from its CG."""
        legs = y[LEGS:].reshape(OF_A_LEG, self.n)
        R, spin = rotation(y[QUATERNION]), y[SPIN][:, None]
        rho = R.T @ (legs[:3] - y[POSITION][:, None])
        return rho, R.T @ (legs[3:6] - y[VELOCITY][:, None]) - cross(spin, rho)

    def loads(self, t: float, y: Array) -> dict[str, Array]:
        """Strokes, strut forces, forces of the ground, and the rates of the laws' states."""
        legs = y[LEGS:].reshape(OF_A_LEG, self.n)
        rho, rho_rate = self.relative(y)
        pulls = [
            self.pull(j, length, rho, rho_rate) for j, length in zip(self.joints, self.lengths)
        ]
        main, upper, lower = self.main_strut(pulls[0][0], pulls[0][1], legs[6], legs[7])
        forces = [main, *(self.auxiliary(s, v) for s, v, _ in pulls[1:])]
        ground, rate_x, rate_z, depth = self.contact(t, legs[:3], legs[3:6], legs[8], legs[9])
        return {
            "strokes": np.array([s for s, _, _ in pulls]), "forces": np.array(forces),
            "pushes": np.array([f * way for f, (_, _, way) in zip(forces, pulls)]),
            "ground": ground, "laws": np.array([upper, lower, rate_x, rate_z]), "depth": depth,
        }  # fmt: skip

    def __call__(self, t: float, y: Array) -> Array:
        """dy/dt: Newton's law of each footpad and of the body, Euler's of the body."""
        e, v = self.loads(t, y), self.vehicle
        R, spin, q = rotation(y[QUATERNION]), y[SPIN], y[QUATERNION]
        down = np.array([0.0, -self.ground.gravity, 0.0])
        pushes = e["pushes"]
        feet = (e["ground"] + R @ pushes.sum(axis=0)) / v.footpad_mass + down[:, None]
        body = down - R @ pushes.sum(axis=(0, 2)) / v.mass
        torque = -sum(cross(j, p).sum(axis=1) for j, p in zip(self.joints, pushes))
        turning = np.linalg.solve(self.tensor, torque - np.cross(spin, self.tensor @ spin))
        half = np.array([0.0, *spin]) * 0.5
        rates = np.concatenate(([-q[1:] @ half[1:]], q[0] * half[1:] + np.cross(q[1:], half[1:])))
        legs = y[LEGS:].reshape(OF_A_LEG, self.n)
        own = np.concatenate((legs[3:6], feet, e["laws"]))
        return np.concatenate((y[VELOCITY], rates, body, turning, own.ravel()))
