"""Linear springs and dampers in place of a leg's laws (closure)."""

from __future__ import annotations

from math import exp, sqrt, tanh
from typing import NamedTuple

from ..assembly.legs import leg_model
from ..core.records import LegModel
from ..core.struts.liquid_spring import mixture
from ..parameters import Parameters
from ..touchdown import footpad_at_rest

RULES = (
    "Main strut, liquid spring: the stiffness is the tangent at full extension, both chambers at",
    "the charge pressure and the liquid's mass kept, dA^2/(V_upper/B + V_lower/B) for the areas'",
    "difference dA. The preload is the charge's force there, which the stop at full extension",
    "holds. The damping is the force of orifice and seal at the stroke rate of touchdown, over it:",
    "that of a footpad which stops, and turns about its auxiliary joint while the body sinks on.",
    "Main strut, spring-damper: its own stiffness and damping; no preload.",
    "Auxiliary strut and ground: the secant at the stroke or depth at which the spring holds the",
    "footpad's kinetic energy at the vertical speed of touchdown, which is their own stiffness",
    "where the exponent is 1; their own damping. Play in the auxiliary strut is left out.",
)
# of touchdown, for what is divided by it [m/s]
LEAST_SPEED = 1e-3


class Linear(NamedTuple):
    """A spring and damper: F = preload + stiffness s + damping v, s and v in compression."""

    stiffness: float  # [N/m]
    damping: float  # [N s/m]
    preload: float = 0.0  # [N]


def main_strut(parameters: Parameters) -> Linear:
    """The main strut of a leg, whose `parameters` are its own. `RULES` says how."""
    m = parameters.main_strut
    if m.kind == "spring-damper":
        return Linear(m.stiffness, m.damping)
    p = leg_model(parameters)
    charged = mixture(m.charge_pressure, p)
    bulk = -charged.v / charged.dv
    upper, lower = p.V10 / bulk, p.V20 / bulk
    preload = (p.A2 - p.A1) * (m.charge_pressure - p.Pa)
    rate = stroke_rate(parameters)
    # the area through which the stroke drives the orifice, and by which its pressure bears
    area = (upper * p.A2 + lower * p.A1) / (upper + lower)
    damping = orifice_pressure(area * rate, 1.0 / charged.v, p) * area / rate
    return Linear(
        (p.A2 - p.A1) ** 2 / (upper + lower),
        damping + _seal(rate, m.charge_pressure, p) / rate,
        preload,
    )


def auxiliary_strut(parameters: Parameters) -> Linear:
    """The auxiliary strut of a leg, as `main_strut`."""
    a = parameters.auxiliary_strut
    return Linear(_secant(a.stiffness, a.exponent, parameters), a.damping)


def ground(parameters: Parameters) -> Linear:
    """The ground below a footpad along its normal, as `main_strut`."""
    g = parameters.ground
    return Linear(_secant(g.stiffness, g.exponent, parameters), g.damping)


def stroke_rate(parameters: Parameters) -> float:
    """The main strut's stroke rate at touchdown [m/s]: see `RULES`.

    A tripod's footpad turns about the line through both auxiliary joints.
    """
    m, a = parameters.main_strut, parameters.auxiliary_strut
    r, h = footpad_at_rest(parameters)
    arm_r, arm_h = r - a.joint_radius, h + a.joint_depth
    # the footpad goes across the auxiliary strut, with the body's sink speed upwards
    sink = _sink_speed(parameters)
    outward = -arm_h / arm_r * sink
    rate = (outward * (r - m.joint_radius) + sink * (h + m.joint_depth)) / m.length
    return max(abs(rate), LEAST_SPEED)


def orifice_pressure(flow: float, density_ratio: float, p: LegModel) -> float:
    """The pressure [Pa] that drives `flow` [m3/s] in compression: the inverse of `orifice_flow`."""
    part = (flow / (p.CdAo_c * sqrt(2.0 / (p.rho0 * density_ratio)))) ** 4
    return sqrt(0.5 * (part + sqrt(part * part + 4.0 * part * p.dP_lam**2)))


def _seal(rate: float, pressure: float, p: LegModel) -> float:
    level = p.Fc + p.kp * abs(pressure - p.Pa) + p.Fs * exp(-((rate / p.v_str) ** 2))
    return level * tanh(rate / p.v_sm)


def _secant(stiffness: float, exponent: float, parameters: Parameters) -> float:
    """The secant [N/m] of K s^exponent at the touchdown's energy of a footpad."""
    energy = 0.5 * parameters.vehicle.footpad_mass * _sink_speed(parameters) ** 2
    stroke = (energy * (exponent + 1.0) / stiffness) ** (1.0 / (exponent + 1.0))
    return stiffness * float(stroke ** (exponent - 1.0))


def _sink_speed(parameters: Parameters) -> float:
    return max(abs(parameters.drop.vertical_velocity), LEAST_SPEED)
