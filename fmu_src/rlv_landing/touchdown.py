"""The state at first contact, and the free flight before it above the ground as it moves."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, radians, sin
from typing import NamedTuple

from .errors import LandingError
from .parameters import Parameters
from .parameters.leg import in_plane_length
from .parameters.surroundings import read_azimuths
from .quantities import SPACE, azimuth, groups_of

# parts of the free flight's duration at which the footpads are checked to be above the ground
FLIGHT_CHECKS = tuple(i / 64.0 for i in range(65))
# largest depth of a footpad below the ground in the free flight, for rounding [m]
DEPTH_LIMIT = 1e-6
# largest slope and tilt of the ground together [rad]
STEEPEST = 1.5


class GroundMotion(NamedTuple):
    """The motion of the ground from some time on, at constant accelerations.

    Heave [m], its rate [m/s] and acceleration [m/s2]; tilt [rad], its rate [rad/s] and acceleration
    [rad/s2].
    """

    heave: float = 0.0
    heave_rate: float = 0.0
    heave_acceleration: float = 0.0
    tilt: float = 0.0
    tilt_rate: float = 0.0
    tilt_acceleration: float = 0.0

    def at(self, t: float) -> tuple[float, float]:
        """Heave [m] and tilt [rad] `t` [s] later, by the same expressions as in the kernels."""
        return (
            self.heave + (self.heave_rate + 0.5 * self.heave_acceleration * t) * t,
            self.tilt + (self.tilt_rate + 0.5 * self.tilt_acceleration * t) * t,
        )


AT_REST = GroundMotion()


def leg_directions(parameters: Parameters) -> dict[int, tuple[float, float]]:
    """Sine and cosine of each leg's azimuth, from body x towards z, by the leg's number.

    In space the legs stand at azimuths of their own, or evenly round the body, with growing
    azimuths. At heading 0 and with the default azimuth, four stand as in the mode 1-2-1.
    """
    if parameters.drop.mode == SPACE:
        legs = int(parameters.vehicle.legs)
        own = read_azimuths(parameters.vehicle.leg_azimuths)
        if own:
            return {i: azimuth(angle / radians(1.0)) for i, angle in enumerate(own, 1)}
        first = parameters.vehicle.leg_azimuth / radians(1.0)
        return {i + 1: azimuth(first + 360.0 * i / legs) for i in range(legs)}
    found = {}
    for group in groups_of(parameters.drop.mode):
        sine, cosine = azimuth(group.azimuth)
        found.update({leg: (side * sine, cosine) for leg, side in group.legs})
    return dict(sorted(found.items()))


def each_leg(parameters: Parameters) -> list[Parameters]:
    """The parameters as each leg of a landing in space has them."""
    return [parameters.of_leg(leg) for leg in range(1, int(parameters.vehicle.legs) + 1)]


def footpad_at_rest(parameters: Parameters) -> tuple[float, float]:
    """Radius and height [m] of a footpad whose struts are both at full length.

    Body axes, from the CG; of the two points the outer one.
    """
    length = in_plane_length(parameters.auxiliary_strut, parameters.leg.kind)
    return footpad_between(parameters, parameters.main_strut.length, length)


def tripod_footpad(
    parameters: Parameters, main: float, first: float, second: float
) -> tuple[float, float, float]:
    """Radius, height, and place across the leg's plane [m] of a footpad on three struts.

    As `footpad_between`; the place is along e_t, towards the first auxiliary strut.

    Args:
        parameters: The vehicle.
        main: Length of the main strut [m].
        first: Length of the first auxiliary strut [m].
        second: Length of the second auxiliary strut [m].
    """
    spread = parameters.auxiliary_strut.joint_spread
    t = (second**2 - first**2) / (4.0 * spread)
    seen = ((main**2 - t**2) ** 0.5, (first**2 - (spread - t) ** 2) ** 0.5)
    return (*footpad_between(parameters, *seen), t)


def footpad_between(parameters: Parameters, main: float, auxiliary: float) -> tuple[float, float]:
    """Radius and height [m] of a footpad whose struts have the given lengths in the leg's plane.

    Body axes, from the CG; of the two points the outer one.

    Args:
        parameters: The vehicle.
        main: Length of the main strut [m].
        auxiliary: Length of the auxiliary strut [m].
    """
    m, a = parameters.main_strut, parameters.auxiliary_strut
    x1, y1, x2, y2 = m.joint_radius, -m.joint_depth, a.joint_radius, -a.joint_depth
    dx, dy = x2 - x1, y2 - y1
    apart = (dx * dx + dy * dy) ** 0.5
    along = (main**2 - auxiliary**2 + apart**2) / (2.0 * apart)
    off = (main**2 - along**2) ** 0.5
    mid_x, mid_y = x1 + along * dx / apart, y1 + along * dy / apart
    return max(
        (mid_x - off * dy / apart, mid_y + off * dx / apart),
        (mid_x + off * dy / apart, mid_y - off * dx / apart),
    )


class FreeFlight:
    """The free flight with the legs fully extended, up to the first contact.

    The whole vehicle's CG flies a parabola and the pitch rate is constant, both in the inertial
    frame. The first contact is `drop.contact_time` after time 0: the lowest footpad touches the
    ground as it is then, and the body's CG is above the ground's origin. [derived]

    Args:
        parameters: The vehicle, its drop and its ground.
        ground: Motion of the ground from time 0 on.

    Raises:
        LandingError: The ground is too steep at the contact.
    """

    def __init__(self, parameters: Parameters, ground: GroundMotion = AT_REST) -> None:
        drop = parameters.drop
        groups = groups_of(drop.mode)
        self.footpad = footpad_at_rest(parameters)
        radius, self._height = self.footpad
        self._along = [radius * azimuth(g.azimuth)[1] for g in groups]
        self._duration = drop.contact_time
        self._plane = _planes(parameters.ground.slope, ground)
        feet = sum(len(g.legs) for g in groups) * parameters.vehicle.footpad_mass
        self._arm = arm = self._height * feet / (feet + parameters.vehicle.mass)
        self._end, self._rate, self._gravity = drop.tilt, drop.pitch_rate, parameters.ground.gravity
        up = self._plane(self._duration)[2]
        self._contact_y = -self.clearance(0.0, 0.0, self._end, self._duration) / up
        self._vx = drop.horizontal_velocity + self._rate * arm * cos(self._end)
        self._vy = drop.vertical_velocity - self._rate * arm * sin(self._end)

    def clearance(self, x: float, y: float, pitch: float, t: float) -> float:
        """Height [m] of the lowest footpad above the ground at time `t`, along its normal.

        Args:
            x: The body's CG along inertial x [m].
            y: The body's CG along inertial y (up) [m].
            pitch: Pitch, clockwise positive [rad].
            t: Time after the start [s].
        """
        s, c = sin(pitch), cos(pitch)
        heave, across, up = self._plane(t)
        height = self._height
        return min(
            [
                (x + along * c + height * s) * across + (y - heave + height * c - along * s) * up
                for along in self._along
            ]
        )

    def before_contact(self, t: float) -> tuple[float, float, float, float, float, float]:
        """Body state (x, y, pitch, vx, vy, pitch rate) `t` [s] before the first contact."""
        arm, rate, end = self._arm, self._rate, self._end
        g, vx, vy = self._gravity, self._vx, self._vy
        pitch = end - rate * t
        x = arm * sin(end) - vx * t - arm * sin(pitch)
        y = self._contact_y + arm * cos(end) - vy * t - 0.5 * g * t * t - arm * cos(pitch)
        return x, y, pitch, vx - rate * arm * cos(pitch), vy + g * t + rate * arm * sin(pitch), rate

    def start(self) -> tuple[float, float, float, float, float, float]:
        """Body state at time 0.

        Raises:
            LandingError: Before the contact a footpad would pass below the ground, or the ground
                would be too steep. 65 times are checked.
        """
        end = self._duration
        parts = FLIGHT_CHECKS if end > 0.0 else FLIGHT_CHECKS[:1]
        lowest = min(
            [
                self.clearance(*self.before_contact(part * end)[:3], end - part * end)
                for part in parts
            ]
        )
        if lowest < -DEPTH_LIMIT:
            raise LandingError(
                f"drop.contact_time = {end:g} s of free flight would pass {-lowest:.3g} m "
                f"below the ground, the limit is {DEPTH_LIMIT:g} m; shorten it, or touch down with "
                "less pitch rate or a faster descent onto the ground"
            )
        return self.before_contact(end)


def _planes(slope: float, ground: GroundMotion) -> Callable[[float], tuple[float, float, float]]:
    """Heave [m] of the ground and sine and cosine of its whole slope, as functions of time [s]."""

    def plane(t: float) -> tuple[float, float, float]:
        heave, tilt = ground.at(t)
        steep = slope + tilt
        if not -STEEPEST <= steep <= STEEPEST:
            raise LandingError(
                f"ground.slope + ground.tilt = {steep:g} rad at {t:g} s, up to the first contact, "
                f"is outside [-{STEEPEST:g}, {STEEPEST:g}] rad; "
                "tilt the ground less, or more slowly"
            )
        return heave, sin(steep), cos(steep)

    if ground == AT_REST._replace(heave=ground.heave, tilt=ground.tilt):
        still = plane(0.0)
        return lambda t: still
    return plane
