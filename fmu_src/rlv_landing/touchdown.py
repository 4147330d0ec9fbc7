"""The state at first contact, and the free flight before it with the legs fully extended."""

from __future__ import annotations

from math import cos, sin

from .parameters import Parameters, azimuth
from .quantities import MODES

# parts of the free flight's duration at which the footpads are checked to be above the ground
FLIGHT_CHECKS = tuple(i / 64.0 for i in range(65))


def footpad_at_rest(parameters: Parameters) -> tuple[float, float]:
    """Radius and height [m] of a footpad whose struts are both at full length.

    Body axes, from the CG; of the two points the outer one.
    """
    return footpad_between(
        parameters, parameters.main_strut.length, parameters.auxiliary_strut.length
    )


def footpad_between(parameters: Parameters, main: float, auxiliary: float) -> tuple[float, float]:
    """Radius and height [m] of a footpad whose struts have the given lengths.

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

    The whole vehicle's CG flies a parabola and the pitch rate is constant. At contact the body's CG
    is above the ground's origin. [derived]
    """

    def __init__(self, parameters: Parameters) -> None:
        drop = parameters.drop
        groups = MODES[drop.mode]
        self.footpad = footpad_at_rest(parameters)
        radius, self._height = self.footpad
        self._along = [radius * azimuth(g.azimuth)[1] for g in groups]
        self._normal = sin(parameters.ground.slope), cos(parameters.ground.slope)
        feet = sum(len(g.legs) for g in groups) * parameters.vehicle.footpad_mass
        self._arm = arm = self._height * feet / (feet + parameters.vehicle.mass)
        self._end, self._rate, self._gravity = drop.tilt, drop.pitch_rate, parameters.ground.gravity
        self._contact_y = -self.clearance(0.0, 0.0, self._end) / self._normal[1]
        self._vx = drop.horizontal_velocity + self._rate * arm * cos(self._end)
        self._vy = drop.vertical_velocity - self._rate * arm * sin(self._end)

    def clearance(self, x: float, y: float, pitch: float) -> float:
        """Height [m] of the lowest footpad above the ground at rest, along its normal.

        Args:
            x: The body's CG along inertial x [m].
            y: The body's CG along inertial y (up) [m].
            pitch: Pitch, clockwise positive [rad].
        """
        s, c = sin(pitch), cos(pitch)
        across, up = self._normal
        height = self._height
        return min(
            [
                (x + along * c + height * s) * across + (y + height * c - along * s) * up
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

    def lowest(self, duration: float) -> float:
        """The smallest clearance [m] during the last `duration` [s] of the flight, at 65 times."""
        parts = FLIGHT_CHECKS if duration > 0.0 else FLIGHT_CHECKS[:1]
        return min([self.clearance(*self.before_contact(part * duration)[:3]) for part in parts])
