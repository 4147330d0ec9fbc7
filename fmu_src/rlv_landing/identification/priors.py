"""The numbers that are identified, with their physical bounds and the reasons.

A prior is uniform between its bounds, in the value or in its logarithm. Names are those of the
parameters, except `main_strut.rod_area`: the rod's cross section, by which the bore exceeds the
annulus, so that no search can propose a bore below the annulus.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log

from ..errors import LandingError, unknown
from ..parameters import PARAMETER_QUANTITIES
from ..quantities import Quantity

ROD_AREA = "main_strut.rod_area"
BORE, ANNULUS = "main_strut.area_lower", "main_strut.area_upper"


@dataclass(frozen=True)
class Prior:
    """The bounds of one free number, with the reason for them.

    Attributes:
        name: The parameter, or `ROD_AREA`.
        lo: The lower bound, SI.
        hi: The upper bound, SI.
        reason: The reason for the bounds.
        logarithmic: Whether the prior is uniform in the logarithm.
        by_mode: Whether each landing mode has its own number.
    """

    name: str
    lo: float
    hi: float
    reason: str
    logarithmic: bool = True
    by_mode: bool = False

    def value(self, z: float) -> float:
        """The number, SI, at `z` in [0, 1]."""
        if self.logarithmic:
            return exp(log(self.lo) + (log(self.hi) - log(self.lo)) * z)
        return self.lo + (self.hi - self.lo) * z

    def place(self, value: float) -> float:
        """The place in [0, 1] of `value`, SI, clipped to the bounds."""
        value = min(max(value, self.lo), self.hi)
        if self.logarithmic:
            return (log(value) - log(self.lo)) / (log(self.hi) - log(self.lo))
        return (value - self.lo) / (self.hi - self.lo)


# fmt: off
PRIORS: tuple[Prior, ...] = (
    Prior("vehicle.inertia", 80.0, 320.0,
          "178 kg between the auxiliary joints 1.5 m below and a block up to 2 m above the CG: "
          "radius of gyration 0.67 to 1.34 m"),
    Prior("vehicle.top_height", 0.4, 2.0,
          "the block near which the accelerometer sits, below the hinge about 2 m above the CG",
          logarithmic=False),
    Prior(ANNULUS, 6e-4, 2.6e-3, "bores of 32 to 65 mm, as struts of a 178 kg prototype have"),
    Prior(ROD_AREA, 1.8e-4, 7.1e-4, "rods of 15 to 30 mm"),
    Prior("main_strut.volume_upper", 2e-5, 3e-4, "annulus over a few to some 25 cm of length"),
    Prior("main_strut.volume_lower", 1.2e-4, 8e-4,
          "bore over 10 to 40 cm of length; more than the stroke sweeps"),
    Prior("main_strut.charge_pressure", 1.013e5, 3e6,
          "not charged, up to the static pressure of a light seal preload"),
    Prior("main_strut.air_fraction", 1e-6, 2e-2, "deaerated to badly bled oil"),
    Prior("main_strut.air_exponent", 1.05, 1.4,
          "between isothermal and adiabatic", logarithmic=False),
    Prior("main_strut.bulk_modulus", 7e8, 1.5e9, "dimethyl silicone oils: about 1 GPa"),
    Prior("main_strut.bulk_modulus_slope", 5.0, 13.0, "silicone oils: 5 to 13", logarithmic=False),
    Prior("main_strut.orifice_area_compression", 2e-6, 5e-5,
          "holes of 2 to 10 mm at a discharge coefficient of 0.6 to 0.8"),
    Prior("main_strut.orifice_area_rebound", 2e-6, 5e-5, "as in compression"),
    Prior("main_strut.laminar_pressure", 5e4, 1e6,
          "a small part of the working pressure of some MPa"),
    Prior("main_strut.seal_coulomb", 5.0, 500.0, "up to a tenth of the peak force"),
    Prior("main_strut.seal_pressure", 1e-7, 5e-5, "up to some 10 % of the rod's force"),
    Prior("main_strut.seal_stribeck", 2.0, 500.0, "up to a tenth of the peak force"),
    Prior("main_strut.seal_stribeck_speed", 5e-3, 0.5,
          "elastomer seals: millimetres to decimetres per second"),
    Prior("main_strut.seal_smoothing_speed", 2e-3, 5e-2,
          "far below the stroke rates of 0.5 m/s that matter"),
    Prior("main_strut.stop_stiffness", 5e5, 5e7,
          "stops that yield less than half a millimetre on rebound, up to metal on metal"),
    Prior("main_strut.stop_damping", 0.01, 20.0, "little to strong"),
    Prior("auxiliary_strut.stiffness", 4e6, 1.1e8,
          "E A/L of 5.91e-4 m2 over 1.145 m: 3.6e7 (aluminium) to 1.1e8 (steel); end fittings "
          "soften it up to ninefold"),
    Prior("auxiliary_strut.exponent", 1.0, 1.2, "the paper's hardening, mild", logarithmic=False),
    Prior("auxiliary_strut.damping", 50.0, 8.2e3,
          "structure and joints: at most critical, 2 sqrt(4.2 kg 4e6 N/m), for the footpad on "
          "its strut at its softest"),
    Prior("auxiliary_strut.play_tension", 1e-4, 1e-3,
          "spherical bearings at both ends: 0.1 to 1 mm a side", logarithmic=False),
    Prior("auxiliary_strut.play_compression", 1e-4, 1e-3, "as in tension", logarithmic=False),
    Prior("auxiliary_strut.play_stiffness", 1e4, 5e5,
          "bearing liners and dust boots: an eighth of the strut's stiffness at most"),
    Prior("auxiliary_strut.play_damping", 0.0, 1.0,
          "none to all of the strut's damping acts within the play", logarithmic=False),
    Prior("ground.stiffness", 3e6, 1e11,
          "rubber-soled to bare metal on concrete; penetration is bounded below"),
    Prior("ground.exponent", 1.0, 2.2,
          "flat punch to rough or rounded contact; Hertz is 1.5", logarithmic=False),
    Prior("ground.damping", 200.0, 5e4, "light to about critical for a footpad"),
    Prior("ground.damping_depth", 1e-5, 2e-3, "within the penetration"),
    Prior("ground.friction", 0.08, 0.6, "greased to dry metal"),
    Prior("ground.stick_displacement", 5e-5, 3e-3, "asperities to joint play"),
    Prior("ground.stribeck_gain", 5e-3, 0.5, "none to half"),
    Prior("ground.stribeck_speed", 5e-3, 1.0, "millimetres to a metre per second"),
    Prior("ground.stick_damping", 1.0, 5e3, "light to about critical for a sticking footpad"),
    Prior("drop.tilt", -0.17, -0.03,
          "Table 2 says -0.035 rad, the figures' contact intervals demand about -0.13 rad",
          logarithmic=False, by_mode=True),
    Prior("drop.pitch_rate", -0.3, 0.4,
          "the pendulum's swing of 0.18 rad/s either way, and twice that",
          logarithmic=False, by_mode=True),
    Prior("drop.contact_time", 0.086, 0.0905,
          "the figures' first contact near 0.088 s", logarithmic=False, by_mode=True),
    Prior("drop.horizontal_velocity", 0.34, 0.37,
          "Table 2: 0.354 m/s, within 4 %", logarithmic=False, by_mode=True),
    Prior("drop.vertical_velocity", -1.45, -1.35,
          "Table 2: 1.4 m/s, which rounds 1.35 to 1.45", logarithmic=False, by_mode=True),
)
# fmt: on


def quantity(name: str) -> Quantity:
    """The quantity that can be identified by this name: a parameter or the rod's area.

    Raises:
        LandingError: There is none.
    """
    if name != ROD_AREA and name not in PARAMETER_QUANTITIES:
        raise unknown("parameter", name, [*PARAMETER_QUANTITIES, ROD_AREA])
    q = PARAMETER_QUANTITIES[BORE if name == ROD_AREA else name]
    if q.kind == "string":
        what = f"a choice ({', '.join(q.choices)})" if q.choices else "a text"
        raise LandingError(f"{name} is {what}; only numbers can be identified")
    return replace(q, name=name)


def with_bounds(name: str, lo: float, hi: float, *, by_mode: bool) -> Prior:
    """The prior of a number whose bounds the user gives.

    It is logarithmic where both bounds are positive and their ratio is above 3.

    Args:
        name: The parameter, or `ROD_AREA`.
        lo: The lower bound, SI.
        hi: The upper bound, SI.
        by_mode: Whether each landing mode has its own number.

    Raises:
        LandingError: There is no such number, or the bounds are empty or outside the parameter's.
    """
    q = quantity(name)
    if not lo < hi:
        raise LandingError(f"bounds of {name} are empty: {lo:g} is not below {hi:g}")
    if name != ROD_AREA and not (q.lo <= lo and hi <= q.hi):
        raise LandingError(
            f"bounds of {name}, {lo:g} to {hi:g} {q.unit}, "
            f"are outside [{q.lo:g}, {q.hi:g}] {q.unit}"
        )
    return Prior(
        name,
        lo,
        hi,
        "given by the user",
        logarithmic=lo > 0.0 and hi / lo > 3.0,
        by_mode=by_mode,
    )
