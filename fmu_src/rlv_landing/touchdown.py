"""The state at first contact, and before it: the free flight of the vehicle with its legs fully extended."""

from __future__ import annotations

from math import cos, inf, sin

from .parameters import Parameters, azimuth
from .quantities import MODES


def footpad_at_rest(parameters: Parameters) -> tuple[float, float]:
    """Radius and height (body axes, from the CG) [m] of a footpad whose struts are both at full length: the outer meeting point."""
    return footpad_between(parameters, parameters.main_strut.length, parameters.auxiliary_strut.length)


def footpad_between(parameters: Parameters, main: float, auxiliary: float) -> tuple[float, float]:
    """Radius and height (body axes, from the CG) [m] of a footpad whose struts have these lengths [m]: the outer meeting point."""
    m, a = parameters.main_strut, parameters.auxiliary_strut
    x1, y1, x2, y2 = m.joint_radius, -m.joint_depth, a.joint_radius, -a.joint_depth
    dx, dy = x2 - x1, y2 - y1
    apart = (dx * dx + dy * dy) ** 0.5
    along = (main**2 - auxiliary**2 + apart**2) / (2.0 * apart)
    off = (main**2 - along**2) ** 0.5
    mid_x, mid_y = x1 + along * dx / apart, y1 + along * dy / apart
    return max((mid_x - off * dy / apart, mid_y + off * dx / apart), (mid_x + off * dy / apart, mid_y - off * dx / apart))


def clearance(parameters: Parameters, x: float, y: float, pitch: float) -> float:
    """Height [m] of the lowest footpad above the ground at rest, along its normal, with the CG at (`x`, `y`)."""
    radius, height = footpad_at_rest(parameters)
    slope = parameters.ground.slope
    lowest = inf
    for g in MODES[parameters.drop.mode]:
        along = radius * azimuth(g.azimuth)[1]
        foot_x = x + along * cos(pitch) + height * sin(pitch)
        foot_y = y + height * cos(pitch) - along * sin(pitch)
        lowest = min(lowest, foot_x * sin(slope) + foot_y * cos(slope))
    return lowest


def before_contact(parameters: Parameters, t: float) -> tuple[float, float, float, float, float, float]:
    """Body state (x, y, pitch, vx, vy, pitch rate) `t` [s] before the first contact, in free flight. [derived]

    The whole vehicle's CG flies a parabola and the pitch rate is constant. At contact the body's CG is above the ground's origin.
    """
    drop, g = parameters.drop, parameters.ground.gravity
    feet = sum(len(group.legs) for group in MODES[drop.mode]) * parameters.vehicle.footpad_mass
    arm = footpad_at_rest(parameters)[1] * feet / (feet + parameters.vehicle.mass)
    rate, end = drop.pitch_rate, drop.tilt
    pitch = end - rate * t
    contact_y = -clearance(parameters, 0.0, 0.0, end) / cos(parameters.ground.slope)
    vx = drop.horizontal_velocity + rate * arm * cos(end)
    vy = drop.vertical_velocity - rate * arm * sin(end)
    x = arm * sin(end) - vx * t - arm * sin(pitch)
    y = contact_y + arm * cos(end) - vy * t - 0.5 * g * t * t - arm * cos(pitch)
    return x, y, pitch, vx - rate * arm * cos(pitch), vy + g * t + rate * arm * sin(pitch), rate
