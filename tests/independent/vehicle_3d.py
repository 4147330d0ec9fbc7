"""The vehicle as a full 3-D Newton-Euler model that shares no code with the kernels.

A rigid body with six degrees of freedom (quaternion, full inertia tensor) carries n separate legs.
Each footpad is a point mass, held in a plane fixed in the body by a transverse constraint force N.
Nothing is eliminated by hand: Newton's law of the body (3), Euler's (3) and Newton's law of n
footpads (3 n) are 6 + 3 n linear equations, 18 with four legs. As many unknowns are the
accelerations of the body (3 + 3) and of the footpads in their planes (n + n), and N (n). They are
solved as they are, with all legs separate: no groups, no mirror images, no symmetric plane. In
space legs may stand on steps and have their own friction.

Axes: inertial x, y up, z = x cross y. Pitch is clockwise positive, so a pitch psi is a rotation
about z by -psi. SI units. Arrays of vectors are (3, n): component, leg.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rlv_landing import Parameters

Array = NDArray[Any]

# degrees from +x of legs 1 to 4, numbered round the body
AZIMUTHS = {"2-2": (135.0, 225.0, 315.0, 45.0), "1-2-1": (180.0, 270.0, 0.0, 90.0)}

POSITION, QUATERNION, VELOCITY, SPIN = slice(0, 3), slice(3, 7), slice(7, 10), slice(10, 13)
LEGS = 13
LEG_STATES = ("r", "h", "r_rate", "h_rate", "upper", "lower", "slip_x", "slip_z")
SIZE = LEGS + 4 * len(LEG_STATES)


def scale_of(legs: int) -> Array:
    """What counts as small in each state: the absolute tolerance is the relative one times this."""
    leg = [0.1, 0.1, 1.0, 1.0, 1e5, 1e5, 1e-3, 1e-3]
    return np.concatenate(([0.1] * 3, [0.1] * 4, [1.0] * 6, np.repeat(leg, legs)))


SCALE = scale_of(4)


@dataclass(frozen=True)
class Inputs:
    """Loads on the body and motion of the ground.

    `force` is inertial [N], `moment` clockwise positive [N m]. Heave and tilt change at their rates
    [m/s, rad/s].
    """

    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
    heave: float = 0.0
    heave_rate: float = 0.0
    tilt: float = 0.0
    tilt_rate: float = 0.0


def cross(a: Sequence[Any] | Array, b: Sequence[Any] | Array) -> Array:
    """Vector product along the first axis."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def rotation(q: Array) -> Array:
    """Body to inertial axes from the quaternion (w, x, y, z), which is normalised first."""
    w, x, y, z = q / np.sqrt((q * q).sum())
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def deck_turn(angles: Array, rates: Array) -> tuple[Array, Array]:
    """Rotation of a deck rolled, yawed and tilted by `angles` [rad], and its spin [rad/s]."""
    (sr, sy, st), (cr, cy, ct) = np.sin(angles), np.cos(angles)
    by_yaw = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    by_roll = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    by_tilt = np.array([[ct, st, 0], [-st, ct, 0], [0, 0, 1]])
    # each rate is about its own axis, turned by what is turned after it
    spin = by_tilt @ (rates[0] * np.array([1.0, 0.0, 0.0]) + by_roll @ [0.0, rates[1], 0.0])
    return by_tilt @ by_roll @ by_yaw, spin - rates[2] * np.array([0.0, 0.0, 1.0])


class Vehicle3D:
    """The right-hand side of the vehicle in space.

    Args:
        parameters: numbers of vehicle, ground and drop (its mode gives the legs' azimuths).
        inputs: loads and the ground's motion, from time 0 on; in space the loads alone.
        deck: in space, the deck's surge, heave, sway, roll, yaw, tilt over time, and their rates.
        roll_yaw: the body's inertia about its own x and y [kg m2]; a symmetric landing must not
            depend on them, and one in space has its own.
    """

    def __init__(
        self,
        parameters: Parameters,
        inputs: Inputs = Inputs(),
        roll_yaw: tuple[float, float] = (150.0, 40.0),
        deck: Callable[[float], tuple[Array, Array]] | None = None,
    ) -> None:
        self.inputs, self.deck = inputs, deck
        self.vehicle, self.damper, self.strut = (
            parameters.vehicle,
            parameters.main_strut,
            parameters.auxiliary_strut,
        )
        self.ground = parameters.ground
        v, g = parameters.vehicle, parameters.ground
        in_space = self.in_space = parameters.drop.mode == "space"
        self.n, self.whole_mass = 4, parameters.whole_mass
        self.cg, self.mu, self.step = np.zeros((3, 1)), g.friction, 0.0
        if in_space:
            self.n = int(v.legs)
            azimuth = v.leg_azimuth + 2.0 * np.pi * np.arange(self.n) / self.n
            if v.leg_azimuths:
                azimuth = np.array([float(word) for word in v.leg_azimuths.split()])
            self.cg = np.array([[v.cg_offset_x], [0.0], [v.cg_offset_z]])
            self.mu, self.step = (
                np.array([float(parameters[f"leg[{i + 1}].ground.{what}"]) for i in range(self.n)])
                for what in ("friction", "step")
            )
        else:
            azimuth = np.radians(AZIMUTHS[parameters.drop.mode])
        s, c, one, none = np.sin(azimuth), np.cos(azimuth), np.ones(self.n), np.zeros(self.n)
        self.e_r, self.e_y, self.e_t = (
            np.array([c, none, s]),
            np.array([none, one, none]),
            np.array([-s, none, c]),
        )
        self.main_joint = (
            self.damper.joint_radius * self.e_r - self.damper.joint_depth * self.e_y - self.cg
        )
        self.aux_joint = (
            self.strut.joint_radius * self.e_r - self.strut.joint_depth * self.e_y - self.cg
        )
        # a leg in the symmetric plane spends its whole friction coefficient along x, any other one
        # shares it evenly at rest
        self.share_x = np.where(np.abs(s) < 1e-12, 1.0, 0.5)
        self.inertia = np.array([roll_yaw[0], roll_yaw[1], self.vehicle.inertia])
        self.tensor = np.diag(self.inertia)
        if in_space:
            self.tensor = np.array(
                [
                    [v.inertia_roll, v.inertia_xy, v.inertia_xz],
                    [v.inertia_xy, v.inertia_yaw, v.inertia_yz],
                    [v.inertia_xz, v.inertia_yz, v.inertia],
                ]
            )
        self.matrix = self._constant_part()
        self.calls = 0

    def _constant_part(self) -> Array:
        """Coefficients of (a, spin', r'', h'', N) that do not depend on the state.

        The rows are the body's Newton, Euler, and the footpads' Newton equations.
        """
        n = self.n
        A = np.zeros((6 + 3 * n, 6 + 3 * n))
        A[0:3, 0:3] = self.vehicle.mass * np.eye(3)
        A[0:3, 6 + 2 * n :] = self.e_t  # the body feels -N e_t; brought to the left
        A[3:6, 3:6] = self.tensor
        m = self.vehicle.footpad_mass
        for i in range(n):
            rows = slice(6 + 3 * i, 9 + 3 * i)
            A[rows, 0:3] = m * np.eye(3)
            A[rows, 6 + i] = m * self.e_r[:, i]
            A[rows, 6 + n + i] = m * self.e_y[:, i]
            A[rows, 6 + 2 * n + i] = -self.e_t[:, i]
        return A

    def exp(self, x: Array) -> Array:
        """The exponential of each of `x`; a model that counts its operations has its own."""
        return np.exp(x)

    def pressure(self, z: Array) -> tuple[Array, Array]:
        """Absolute pressure [Pa] in a chamber of state `z` and its slope.

        The pressure is the state itself, but below 10 Pa an exponential that never reaches 0.
        """
        fallen = self.exp(np.clip(z / 10.0 - 1.0, -150.0, 0.0))
        return np.where(z < 10.0, 10.0 * fallen, z), np.where(z < 10.0, fallen, 1.0)

    def chamber(self, whole: float, area: float, travel: Array) -> tuple[Array, Array]:
        """Volume [m3] and its slope by the piston's travel.

        The last 5 % of the `whole` are never displaced altogether.
        """
        past = 1.0 + area * travel / whole - 0.05
        part = self.exp(np.minimum(past / 0.025, 0.0))
        bent = whole * 0.025 * (1.0 + part)
        return np.where(past < 0.0, bent, whole + area * travel), area * part

    def specific_volume(self, P: Array) -> tuple[Array, Array]:
        """Specific volume of liquid and air, and its slope [1/Pa].

        It is relative to that at ambient pressure.
        """
        d = self.damper
        swell = 1.0 + d.bulk_modulus_slope * (P - d.ambient_pressure) / d.bulk_modulus
        liquid = (1.0 - d.air_fraction) * swell ** (-1.0 / d.bulk_modulus_slope)
        air = d.air_fraction * (d.ambient_pressure / P) ** (1.0 / d.air_exponent)
        return liquid + air, -liquid / (swell * d.bulk_modulus) - air / (d.air_exponent * P)

    def main_strut(
        self, s: Array, v: Array, upper: Array, lower: Array
    ) -> tuple[Array, Array, Array]:
        """Axial force [N], compression positive, and rates of the two chambers' states [Pa/s].

        The rates come from the mass balance of each chamber.
        """
        d = self.damper
        (upper, lower), bend = self.pressure(np.array([upper, lower]))
        upper_volume, upper_area = self.chamber(d.volume_upper, d.area_upper, s)
        lower_volume, lower_area = self.chamber(d.volume_lower, d.area_lower, -s)
        volume, slope = self.specific_volume(np.array([upper, lower]))
        density = d.fluid_density / volume
        stiffening = -density / volume * slope * bend  # d(density)/d(state)
        mean = 0.5 * (density[0] + density[1])
        drop = lower - upper
        area = np.where(drop > 0.0, d.orifice_area_compression, d.orifice_area_rebound)
        mass_flow = (
            area * np.sqrt(2.0 * mean) * drop / (drop * drop + d.laminar_pressure**2) ** 0.25
        )
        upper_rate = (mass_flow - density[0] * upper_area * v) / (upper_volume * stiffening[0])
        lower_rate = (density[1] * lower_area * v - mass_flow) / (lower_volume * stiffening[1])
        gauge_upper, gauge_lower = upper - d.ambient_pressure, lower - d.ambient_pressure
        level = d.seal_coulomb + d.seal_pressure * 0.5 * (np.abs(gauge_upper) + np.abs(gauge_lower))
        seal = (level + d.seal_stribeck * np.exp(-((v / d.seal_stribeck_speed) ** 2))) * np.tanh(
            v / d.seal_smoothing_speed
        )
        out, into = np.maximum(-s, 0.0), np.maximum(s - d.stroke_max, 0.0)
        stop = d.stop_stiffness * (
            into * np.maximum(1.0 + d.stop_damping * v, 0.0)
            - out * np.maximum(1.0 - d.stop_damping * v, 0.0)
        )
        return (
            gauge_lower * lower_area - gauge_upper * upper_area + seal + stop,
            upper_rate,
            lower_rate,
        )

    def auxiliary(self, s: Array, v: Array) -> Array:
        """Axial force [N], compression positive: a spring and a damper.

        They bear where the play of the joints is taken up, softly within 3 % of it. What the
        faces would bear at stroke 0 is taken off.
        """
        a = self.strut
        if a.play_tension + a.play_compression == 0.0:
            return a.stiffness * np.abs(s) ** a.exponent * np.sign(s) + a.damping * v
        faces, bears = self.faces(s)
        at_rest, _ = self.faces(0.0 * s)
        part = np.minimum(bears, 1.0)
        damping = a.damping * (a.play_damping * (1.0 - part) + part)
        return faces - at_rest + a.play_stiffness * s + damping * v

    def faces(self, s: Array) -> tuple[Array, Array]:
        """Force [N] between the joints' faces, compression positive, and how far they bear."""
        a = self.strut
        past = np.array([-s - a.play_tension, s - a.play_compression])
        root = np.hypot(past, 0.03 * (a.play_tension + a.play_compression))
        pressed, bears = 0.5 * (past + root), 0.5 * (1.0 + past / root)
        out, into = a.stiffness * pressed**a.exponent * bears
        return into - out, bears.sum(axis=0)

    def ramp(self, d: Array) -> Array:
        """0 to 1 over the ground's damping depth."""
        q = np.minimum(np.maximum(d / self.ground.damping_depth, 0.0), 1.0)
        return q * q * (3.0 - 2.0 * q)

    def passive_friction(self, d: Array, Fn: Array, v: Array, s: Array) -> tuple[Array, Array]:
        """Force (2, 4) in the ground's plane, and the displacement's rate (2, 4).

        They follow by return to the cone, for `Fn` [N] on footpads that slip at `v` and are
        displaced by `s`, both (2, 4).
        """
        g = self.ground
        weight = 9.80665 * self.whole_mass
        k = g.tangential_stiffness or weight / g.stick_displacement
        zone = g.slip_zone * g.stick_displacement
        speed, length = np.sqrt((v * v).sum(axis=0)), np.sqrt((s * s).sum(axis=0))
        cone = self.mu * Fn * (1.0 + g.stribeck_gain * np.exp(-speed / g.stribeck_speed))
        elastic = np.minimum(k * length, cone)
        n = s / np.where(length > 0.0, length, 1.0)
        beyond = length - cone / k
        share = np.minimum(np.maximum(beyond / zone, 0.0), 1.0)
        share = share * share * (3.0 - 2.0 * share)
        growing = (n * v).sum(axis=0)
        used = elastic / np.where(cone > 0.0, cone, 1.0)
        damping = np.where(
            k * length < cone, g.stick_damping * self.ramp(d) * (1.0 - used * used), 0.0
        )
        # what the spring takes of a growing motion: all of it below the limit, less the slider's
        # share and the part of its length that carries no force beyond
        kept = np.where(
            beyond >= 0.0, (1.0 - share) * elastic / np.maximum(k * length, 1e-300), 1.0
        )
        rate = v - n * np.where(growing > 0.0, (1.0 - kept) * growing, 0.0)
        rate = rate - n * np.maximum(beyond - zone, 0.0) / g.release_time
        held = (d > 0.0) & ((length > 0.0) | (cone > 0.0))
        free = np.where(d > 0.0, 0.0, -s / g.release_time)
        return np.where(d > 0.0, -elastic * n - damping * v, 0.0), np.where(held, rate, free)

    def friction(self, d: Array, limit: Array, v: Array, s: Array) -> tuple[Array, Array]:
        """Force along one direction of the ground, and the displacement's rate.

        `limit` [N] is coefficient times normal force.
        """
        g = self.ground
        s0 = g.stick_displacement
        held = np.minimum(np.maximum(s, -s0), s0) / s0
        slips = (v * s > 0.0) & (np.abs(s) >= s0)
        slip = -limit * (1.0 + g.stribeck_gain * np.exp(-np.abs(v) / g.stribeck_speed)) * held
        stick = (
            -limit * (1.0 + g.stribeck_gain) * held
            - g.stick_damping * self.ramp(d) * (1.0 - held * held) * v
        )
        touches = d > 0.0
        force = np.where(touches, np.where(slips, slip, stick), 0.0)
        return force, np.where(touches, np.where(slips, 0.0, v), -s / g.release_time)

    def contact(
        self, t: float, place: Array, speed: Array, slip_x: Array, slip_z: Array
    ) -> tuple[Array, Array, Array, Array]:
        """Force of the ground on the footpads, rates of both friction displacements, penetration.

        The force is in inertial axes.
        """
        g, u = self.ground, self.inputs
        angle = g.slope + u.tilt + u.tilt_rate * t
        ahead, aside = np.cos(g.slope_direction), np.sin(g.slope_direction)
        along = np.array([np.cos(angle) * ahead, -np.sin(angle), np.cos(angle) * aside])
        normal = np.array([np.sin(angle) * ahead, np.cos(angle), np.sin(angle) * aside])
        across = np.array([-aside, 0.0, ahead])
        arm = place - np.array([[0.0], [u.heave + u.heave_rate * t], [0.0]])
        relative = (
            speed - cross((0.0, 0.0, -u.tilt_rate), arm) - np.array([[0.0], [u.heave_rate], [0.0]])
        )
        if self.deck is not None:
            places, rates = self.deck(t)
            turn, spin = deck_turn(places[3:], rates[3:])
            along, normal, across = turn @ along, turn @ normal, turn @ across
            arm = place - places[:3, None]
            relative = speed - rates[:3, None] - cross(spin[:, None], arm)
        d, sinking = self.step - normal @ arm, -(normal @ relative)
        depth = np.maximum(d, 0.0)
        Fn = np.maximum(
            g.stiffness * depth**g.exponent + g.damping * self.ramp(depth) * sinking, 0.0
        )
        vx, vz = along @ relative, across @ relative
        if g.friction_law == "passive":
            (Fx, Fz), (rate_x, rate_z) = self.passive_friction(
                d, Fn, np.array([vx, vz]), np.array([slip_x, slip_z])
            )
            force = normal[:, None] * Fn + along[:, None] * Fx + across[:, None] * Fz
            return force, rate_x, rate_z, d
        small = g.direction_speed**2
        whole = vx * vx + vz * vz + small
        Fx, rate_x = self.friction(
            d, g.friction * np.sqrt((vx * vx + self.share_x * small) / whole) * Fn, vx, slip_x
        )
        Fz, rate_z = self.friction(
            d,
            g.friction * np.sqrt((vz * vz + (1.0 - self.share_x) * small) / whole) * Fn,
            vz,
            slip_z,
        )
        force = normal[:, None] * Fn + along[:, None] * Fx + across[:, None] * Fz
        return force, rate_x, rate_z, d

    def pull(
        self, joint: Array, length: float, rho: Array, rho_rate: Array
    ) -> tuple[Array, Array, Array]:
        """Stroke, stroke rate and direction of a strut, as seen from the body.

        Stroke and rate are positive in compression; the direction points from joint to footpad.
        """
        line = rho - joint
        now = np.sqrt((line * line).sum(axis=0))
        direction = line / now
        return length - now, -(direction * rho_rate).sum(axis=0), direction

    def solve(self, A: Array, b: Array) -> Array:
        """The linear system of all equations."""
        return np.linalg.solve(A, b)

    def evaluate(self, t: float, y: Array) -> dict[str, Array]:
        """Everything at one state: accelerations, loads, rates."""
        v = self.vehicle
        n, legs = self.n, y[LEGS:].reshape(len(LEG_STATES), self.n)
        r, h, r_rate, h_rate, upper, lower, slip_x, slip_z = legs
        spin, R = y[SPIN], rotation(y[QUATERNION])
        omega = spin[:, None]
        rho_rate = r_rate * self.e_r + h_rate * self.e_y
        rho = r * self.e_r + h * self.e_y
        if self.in_space:
            rho = rho - self.cg
        swept = cross(omega, rho)
        place, speed = y[POSITION][:, None] + R @ rho, y[VELOCITY][:, None] + R @ (swept + rho_rate)

        s, s_rate, main_way = self.pull(self.main_joint, self.damper.length, rho, rho_rate)
        sa, sa_rate, aux_way = self.pull(self.aux_joint, self.strut.length, rho, rho_rate)
        Fm, upper_rate, lower_rate = self.main_strut(s, s_rate, upper, lower)
        Fa = self.auxiliary(sa, sa_rate)
        ground, rate_x, rate_z, d = self.contact(t, place, speed, slip_x, slip_z)

        down = np.array([0.0, -self.ground.gravity, 0.0])
        main, aux = Fm * main_way, Fa * aux_way
        on_feet = R.T @ (ground + v.footpad_mass * down[:, None]) + main + aux
        on_body = R.T @ (np.array([*self.inputs.force, 0.0]) + v.mass * down) - (main + aux).sum(
            axis=1
        )
        torque = R.T @ np.array([0.0, 0.0, -self.inputs.moment])  # clockwise positive
        torque = torque - (cross(self.main_joint, main) + cross(self.aux_joint, aux)).sum(axis=1)
        turning = self.tensor @ spin if self.in_space else self.inertia * spin
        gyroscopic = cross(spin, turning)
        carried = cross(omega, swept) + 2.0 * cross(
            omega, rho_rate
        )  # centripetal and Coriolis acceleration of the footpads

        A = self.matrix.astype(y.dtype)
        at = rho if v.transverse_load_at == "footpad" else self.aux_joint
        A[3:6, 6 + 2 * n :] = cross(at, self.e_t)
        m = v.footpad_mass
        for i, (x, height, z) in enumerate(rho.T):  # m spin' cross rho
            k = 6 + 3 * i
            A[k, 4], A[k, 5] = m * z, -m * height
            A[k + 1, 3], A[k + 1, 5] = -m * z, m * x
            A[k + 2, 3], A[k + 2, 4] = m * height, -m * x
        b = np.concatenate((on_body, torque - gyroscopic, (on_feet - m * carried).T.ravel()))
        x = self.solve(A, b)
        return {
            "rotation": R, "acceleration": R @ x[0:3], "spin_rate": x[3:6],
            "r_acc": x[6:6 + n], "h_acc": x[6 + n:6 + 2 * n], "transverse": x[6 + 2 * n:],
            "upper_rate": upper_rate, "lower_rate": lower_rate,
            "slip_x_rate": rate_x, "slip_z_rate": rate_z,
            "main_force": Fm, "stroke": s, "stroke_rate": s_rate,
            "aux_force": Fa, "aux_stroke": sa, "place": place,
            "ground": ground, "penetration": d,
        }  # fmt: skip

    def __call__(self, t: float, y: Array) -> Array:
        """dy/dt."""
        self.calls += 1
        e = self.evaluate(t, y)
        w, q = y[SPIN], y[QUATERNION]
        turn = 0.5 * np.array(
            [
                -q[1] * w[0] - q[2] * w[1] - q[3] * w[2],
                q[0] * w[0] + q[2] * w[2] - q[3] * w[1],
                q[0] * w[1] + q[3] * w[0] - q[1] * w[2],
                q[0] * w[2] + q[1] * w[1] - q[2] * w[0],
            ]
        )
        rates = y[LEGS + 2 * self.n : LEGS + 4 * self.n]  # r', h' of the legs
        names = ("r_acc", "h_acc", "upper_rate", "lower_rate", "slip_x_rate", "slip_z_rate")
        return np.concatenate(
            (y[VELOCITY], turn, e["acceleration"], e["spin_rate"], rates, *(e[n] for n in names))
        )

    def start(self, body: Sequence[float]) -> Array:
        """State with the legs at full length and at rest in the body.

        `body` is (x, y, pitch, vx, vy, pitch rate).
        """
        x, y, pitch, vx, vy, rate = body
        a, b = self.damper.joint_radius, -self.damper.joint_depth
        c, d = self.strut.joint_radius, -self.strut.joint_depth
        apart = np.hypot(c - a, d - b)
        # law of cosines at the main strut's joint, turned outwards from the line between the joints
        opening = np.arccos(
            (self.damper.length**2 + apart**2 - self.strut.length**2)
            / (2.0 * self.damper.length * apart)
        )
        angle = np.arctan2(d - b, c - a) + opening
        legs = np.zeros((len(LEG_STATES), self.n))
        legs[0], legs[1] = (
            a + self.damper.length * np.cos(angle),
            b + self.damper.length * np.sin(angle),
        )
        legs[4] = legs[5] = self.damper.charge_pressure
        half = -0.5 * pitch
        return np.concatenate(
            (
                [x, y, 0.0, np.cos(half), 0.0, 0.0, np.sin(half), vx, vy, 0.0, 0.0, 0.0, -rate],
                legs.ravel(),
            )
        )


def pitch_of(q: Array) -> Array:
    """Clockwise pitch [rad] of quaternions (4, n) that turn about z."""
    return -2.0 * np.arctan2(q[3], q[0])


def land(
    model: Vehicle3D, body: Sequence[float], times: Array, method: str, rtol: float
) -> dict[str, Array]:
    """Integrate from time 0 with a scipy solver.

    Returns:
        Body motion (n,) and legs (4, n) at `times`, signs as in the package's outputs.
    """
    done = solve_ivp(
        model,
        (0.0, times[-1]),
        model.start(body),
        method,
        times,
        rtol=rtol,
        atol=rtol * SCALE,
        max_step=2e-3,
    )
    assert done.success, done.message
    y = done.y
    legs = [model.evaluate(t, state) for t, state in zip(times, y.T)]
    return {
        "x": y[0], "y": y[1], "z": y[2], "pitch": pitch_of(y[QUATERNION]),
        "roll_yaw": y[QUATERNION][1:3], "spin": y[SPIN], "vz": y[VELOCITY][2],
        "main_force": -np.array([e["main_force"] for e in legs]).T,
        "stroke": np.array([e["stroke"] for e in legs]).T,
        "aux_force": -np.array([e["aux_force"] for e in legs]).T,
        "ground": np.array([e["ground"] for e in legs]).transpose(1, 2, 0),
    }  # fmt: skip
