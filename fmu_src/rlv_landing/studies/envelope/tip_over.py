"""The tip-over of a rigid block on two feet: the closed form beside which envelopes are set.

The contacts stick and do not rebound. Plane motion: x horizontal, y up, pitch and rates clockwise
positive, as everywhere. [derived; after Housner's rocking block]
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, hypot, sin, sqrt

from ...parameters import Parameters
from ...presets import load_preset
from ...quantities import azimuth, groups_of
from ...touchdown import footpad_at_rest

# the model in that limit: struts locked by their orifices and damped by their seals, feet that
# stick, and an overdamped ground
LOCKED: dict[str, float | str] = {
    "vehicle.transverse_load_at": "footpad",
    "main_strut.area_upper": 1e-3,
    "main_strut.area_lower": 1e-3,
    "main_strut.volume_upper": 2e-6,
    "main_strut.volume_lower": 2e-6,
    "main_strut.charge_pressure": 1e8,
    "main_strut.bulk_modulus": 2e9,
    "main_strut.air_fraction": 1e-7,
    "main_strut.stroke_max": 1e-3,
    "main_strut.orifice_area_compression": 1e-9,
    "main_strut.orifice_area_rebound": 1e-9,
    "main_strut.seal_coulomb": 5e4,
    "main_strut.seal_smoothing_speed": 1.0,
    "main_strut.seal_pressure": 0.0,
    "main_strut.seal_stribeck": 0.0,
    "auxiliary_strut.stiffness": 2e8,
    "auxiliary_strut.exponent": 1.0,
    "auxiliary_strut.damping": 5e4,
    "auxiliary_strut.play_tension": 0.0,
    "auxiliary_strut.play_compression": 0.0,
    "ground.stiffness": 1e6,
    "ground.exponent": 1.0,
    "ground.damping": 5e4,
    "ground.damping_depth": 1e-6,
    "ground.friction": 3.0,
    "ground.tangential_stiffness": 1e9,
    "ground.stick_displacement": 1e-4,
    "ground.stribeck_gain": 0.0,
    "ground.stick_damping": 1e4,
}
# upright, sinking at 0.5 m/s, at the contact
START = {
    "drop.contact_time": 0.0,
    "drop.pitch_rate": 0.0,
    "drop.tilt": 0.0,
    "drop.vertical_velocity": -0.5,
    "drop.horizontal_velocity": 0.0,
}
AT_REST = 1e-6


def locked_vehicle(mode: str = "2-2", **values: float) -> Parameters:
    """The vehicle of the preset yue2022-figures with locked legs, upright and at 0.5 m/s downward.

    Args:
        mode: The landing mode.
        values: Other parameters by name [SI], with `__` for the dot: `drop__tilt`.
    """
    given = {name.replace("__", "."): value for name, value in values.items()}
    return load_preset("yue2022-figures", mode).with_values({**LOCKED, **START, **given})


@dataclass(frozen=True)
class RigidBlock:
    """A rigid block on two feet, or three with one in the middle.

    Attributes:
        mass: Mass [kg].
        inertia: Inertia about the CG [kg m2].
        half_track: Distance of the outer feet from the middle [m].
        height: Height of the CG above the plane of the feet [m].
        gravity: Gravitational acceleration [m/s2].
        middle: Whether a foot is below the CG as well.
    """

    mass: float
    inertia: float
    half_track: float
    height: float
    gravity: float
    middle: bool = False

    @classmethod
    def of(cls, parameters: Parameters) -> RigidBlock:
        """The vehicle with its legs rigid at full length, footpads included.

        Its outermost feet are the block's.
        """
        vehicle, groups = parameters.vehicle, groups_of(parameters.drop.mode)
        radius, foot = footpad_at_rest(parameters)
        along = [radius * azimuth(g.azimuth)[1] for g in groups for _ in g.legs]
        mass = vehicle.mass + len(along) * vehicle.footpad_mass
        cg = len(along) * vehicle.footpad_mass * foot / mass
        inertia = (
            vehicle.inertia
            + vehicle.mass * cg**2
            + vehicle.footpad_mass * sum(x**2 + (foot - cg) ** 2 for x in along)
        )
        return cls(
            mass,
            inertia,
            max(along),
            cg - foot,
            parameters.ground.gravity,
            min(map(abs, along)) == 0.0,
        )

    @property
    def radius(self) -> float:
        """The distance [m] from a foot to the CG."""
        return hypot(self.half_track, self.height)

    @property
    def pivot_inertia(self) -> float:
        """The inertia [kg m2] about a foot."""
        return self.inertia + self.mass * self.radius**2

    @property
    def tipping_slope(self) -> float:
        """The slope [rad] on which a block at rest topples.

        Its tangent is half track over height of the CG.
        """
        return atan2(self.half_track, self.height)

    @property
    def rate_kept(self) -> float:
        """The part of the pitch rate left when the block swings from one foot to the other.

        It is (I + M (h2 - b2)) over the pivot's inertia, and 0 where the block stops on both feet.
        With a foot in the middle the block rolls over that one, which takes nothing, and keeps (I +
        M h2) over the pivot's inertia.
        """
        arms = self.height**2 - (0.0 if self.middle else self.half_track**2)
        return max(0.0, self.inertia + self.mass * arms) / self.pivot_inertia

    def lean(self, pitch: float) -> float:
        """Angle [rad] from the vertical of the line from the foot at +x to the CG.

        Above 0 the CG is beyond that foot.
        """
        return pitch - self.tipping_slope

    def rate_after_contact(self, pitch: float, vx: float, vy: float, rate: float = 0.0) -> float:
        """Pitch rate [rad/s] once the foot at +x has struck and sticks.

        The angular momentum about that foot is conserved.

        Args:
            pitch: Pitch at contact [rad].
            vx: Velocity of the CG along x at contact [m/s].
            vy: Velocity of the CG upward at contact [m/s].
            rate: Pitch rate before contact [rad/s].
        """
        lean = self.lean(pitch)
        moment = self.mass * self.radius * (cos(lean) * vx - sin(lean) * vy)
        return (self.inertia * rate + moment) / self.pivot_inertia

    def tipping_rate(self, pitch: float) -> float:
        """Pitch rate [rad/s] about the foot at +x above which the block goes over it.

        I w2/2 = m g R (1 - cos lean). It is negative where the CG is beyond the foot already: a
        block that swings back faster than that does not go over.
        """
        lean = self.lean(pitch)
        rate = sqrt(
            2.0 * self.mass * self.gravity * self.radius * (1.0 - cos(lean)) / self.pivot_inertia
        )
        return rate if lean < 0.0 else -rate

    def critical_speed(self, pitch: float, vy: float, rate: float = 0.0) -> float:
        """Horizontal speed [m/s] along +x beyond which the block topples over the feet at +x.

        These feet strike first, or all together. A slower block may swing back and topple the other
        way: see `topples`.

        Args:
            pitch: Pitch at contact [rad].
            vy: Velocity of the CG upward at contact [m/s].
            rate: Pitch rate before contact [rad/s].
        """
        lean = self.lean(pitch)
        needed = self.pivot_inertia * self.tipping_rate(pitch) - self.inertia * rate
        return (needed / (self.mass * self.radius) + sin(lean) * vy) / cos(lean)

    def topples(self, pitch: float, slope: float, vx: float, vy: float, rate: float = 0.0) -> str:
        """The side over which the block topples, `+x` or `-x`; empty where it comes to rest.

        It turns about the foot that struck until it goes over it or the other foot strikes; then
        about that one, and so on. At each strike the angular momentum about the striking foot is
        conserved and the other foot is free to lift. Where both strike together, the block turns
        about the one from which the other lifts, and rests where there is none.

        Args:
            pitch: Pitch at contact [rad].
            slope: Slope of the ground [rad].
            vx: Velocity of the CG along x at contact [m/s].
            vy: Velocity of the CG upward at contact [m/s].
            rate: Pitch rate before contact [rad/s].
        """
        struck = {
            side: self.rate_after_contact(side * pitch, side * vx, vy, side * rate)
            for side in (1, -1)
        }
        if pitch == slope:
            side = 1 if struck[1] > 0.0 else -1
            w = max(0.0, struck[side])
        else:
            side = 1 if pitch > slope else -1
            w = struck[side]
        # as seen from the side of the pivot, w > 0 is over it, and the other foot strikes at the
        # pitch side * slope
        seen = side * pitch
        while abs(w) > AT_REST:
            if w > self.tipping_rate(seen):
                return "+x" if side == 1 else "-x"
            flush = side * slope
            gained = (
                2.0
                * self.mass
                * self.gravity
                * self.radius
                * (cos(self.lean(seen)) - cos(self.lean(flush)))
                / self.pivot_inertia
            )
            w = self.rate_kept * sqrt(max(0.0, w * w + gained))
            side = -side
            seen = side * slope
        return ""
