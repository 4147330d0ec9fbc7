"""The vehicle, its ground and its drop: annotated values, checked on construction.

The defaults are the preset `yue2022-figures`; `source` separates the paper's own values from
identified ones. Lengths down from the CG are given as positive depths, as in the paper's Table 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from math import cos, isfinite, isinf, radians, sin
from typing import Annotated, Any, Literal, get_args, get_type_hints

from .errors import LandingError, unknown
from .quantities import MODES, Quantity

Q = Quantity

# fmt: off


@dataclass(frozen=True)
class Vehicle:
    """The body and its footpads."""

    mass: Annotated[float, Q("kg", "upper (elastic) mass", 1.0, 1e6, "m_u", "paper")] = 178.0
    inertia: Annotated[float, Q("kg.m2", "rotational inertia of the upper mass about z through its CG", 0.1, 1e9, "I_u", "identified")] = 116.2
    footpad_mass: Annotated[float, Q("kg", "lower (inelastic) mass of one leg, at its footpad", 0.01, 1e4, "m_d", "paper")] = 4.2
    top_height: Annotated[float, Q("m", "height of the top acceleration sensor above the CG", 0.0, 100.0, "H", "identified")] = 0.4582
    transverse_load_at: Annotated[str, Q("", "where the body feels the auxiliary struts' transverse force: footpad (consistent) or joint (the paper's assumption C; creates energy)", source="derived", choices=("footpad", "joint"))] = "footpad"


@dataclass(frozen=True)
class MainStrut:
    """The main strut with its liquid-spring damper. Eq. (12)."""

    joint_radius: Annotated[float, Q("m", "CG to body joint, radially", 0.0, 50.0, "La", "paper")] = 0.445
    joint_depth: Annotated[float, Q("m", "CG to body joint, downward", -50.0, 50.0, "Lb", "paper")] = 1.103
    length: Annotated[float, Q("m", "length, fully extended", 0.05, 100.0, "Lm0", "paper")] = 1.426
    area_upper: Annotated[float, Q("m2", "piston area in the upper chamber (annulus)", 1e-6, 1.0, "A1", "identified", "mm2")] = 0.0009243
    area_lower: Annotated[float, Q("m2", "piston area in the lower chamber (bore)", 1e-6, 1.0, "A2", "identified", "mm2")] = 0.001145
    volume_upper: Annotated[float, Q("m3", "upper chamber's volume, fully extended", 1e-7, 1.0, "V10", "identified", "cm3")] = 0.0001858
    volume_lower: Annotated[float, Q("m3", "lower chamber's volume, fully extended", 1e-7, 1.0, "V20", "identified", "cm3")] = 0.0001629
    charge_pressure: Annotated[float, Q("Pa", "absolute pressure in both chambers before touchdown", 1e3, 1e8, "P0", "identified", "MPa")] = 390084.4
    ambient_pressure: Annotated[float, Q("Pa", "absolute pressure outside", 1e2, 1e7, "Pa", "closure", "MPa")] = 101300.0
    fluid_density: Annotated[float, Q("kg/m3", "density of the liquid with its air at ambient pressure", 100.0, 3000.0, "rho0", "closure")] = 960.0
    air_fraction: Annotated[float, Q("", "volume fraction of entrapped air at ambient pressure", 1e-7, 0.2, "x_air", "identified")] = 2.613e-05
    air_exponent: Annotated[float, Q("", "polytropic exponent of the air (1.01: nearly isothermal)", 1.01, 1.67, "n_air", "identified")] = 1.33
    bulk_modulus: Annotated[float, Q("Pa", "bulk modulus of the liquid at ambient pressure", 1e7, 1e10, "B0", "identified", "MPa")] = 1244000000.0
    bulk_modulus_slope: Annotated[float, Q("", "growth of the bulk modulus with pressure", 1.5, 30.0, "kB", "identified")] = 12.73
    orifice_area_compression: Annotated[float, Q("m2", "effective orifice area Cd Ao in compression", 1e-9, 1e-2, "CdAo_c", "identified", "mm2")] = 5.552e-06
    orifice_area_rebound: Annotated[float, Q("m2", "effective orifice area Cd Ao in rebound", 1e-9, 1e-2, "CdAo_r", "identified", "mm2")] = 6.054e-06
    laminar_pressure: Annotated[float, Q("Pa", "pressure drop below which the orifice flow turns laminar", 1e3, 1e7, "dP_lam", "identified", "MPa")] = 50602.75
    seal_coulomb: Annotated[float, Q("N", "Coulomb part of the seal friction", 0.0, 1e6, "Fc", "identified")] = 35.31
    seal_pressure: Annotated[float, Q("N/Pa", "seal friction per mean gauge pressure of the chambers", 0.0, 1e-2, "kp", "identified")] = 2.157e-07
    seal_stribeck: Annotated[float, Q("N", "Stribeck part of the seal friction, at low speed", 0.0, 1e6, "Fs", "identified")] = 162.0
    seal_stribeck_speed: Annotated[float, Q("m/s", "speed at which the Stribeck part fades", 1e-4, 10.0, "v_str", "identified")] = 0.3791511
    seal_smoothing_speed: Annotated[float, Q("m/s", "speed below which the seal friction is smoothed", 1e-5, 1.0, "v_sm", "identified")] = 0.03693
    stroke_max: Annotated[float, Q("m", "stroke at which the damper meets its compression stop", 1e-3, 10.0, "s_max", "closure", "mm")] = 0.05
    stop_stiffness: Annotated[float, Q("N/m", "stiffness of both end stops", 1e3, 1e11, "K_stop", "identified")] = 48880000.0
    stop_damping: Annotated[float, Q("s/m", "damping of both end stops: force is K e (1 + c e')", 0.0, 100.0, "c_stop", "identified")] = 0.01048


@dataclass(frozen=True)
class AuxiliaryStrut:
    """The auxiliary strut: nonlinear spring and damper along its axis, and play in its joints. Eq. (13)."""

    joint_radius: Annotated[float, Q("m", "CG to body joint, radially", 0.0, 50.0, "Lc", "paper")] = 0.463
    joint_depth: Annotated[float, Q("m", "CG to body joint, downward", -50.0, 50.0, "Ld", "paper")] = 1.513
    length: Annotated[float, Q("m", "length, unloaded", 0.05, 100.0, "Ls0", "paper")] = 1.145
    stiffness: Annotated[float, Q("N/m", "axial stiffness Ka (N/m^ek)", 1e3, 1e11, "Ka", "identified")] = 4000000.0
    exponent: Annotated[float, Q("", "hardening exponent ek", 1.0, 3.0, "ek", "identified")] = 1.074
    damping: Annotated[float, Q("N.s/m", "axial damping Ca", 0.0, 1e7, "Ca", "identified")] = 8200.0
    play_tension: Annotated[float, Q("m", "play of the joints in tension, before the strut bears; 0 on both sides: no play", 0.0, 0.1, "g_t", "identified", "mm")] = 0.0008819
    play_compression: Annotated[float, Q("m", "play of the joints in compression, before the strut bears", 0.0, 0.1, "g_c", "identified", "mm")] = 0.001
    play_stiffness: Annotated[float, Q("N/m", "axial stiffness within the play, and beside Ka beyond it", 0.0, 1e9, "k_play", "identified")] = 182200.0
    play_damping: Annotated[float, Q("", "part of the axial damping that acts within the play", 0.0, 1.0, "c_play", "identified")] = 1.0


@dataclass(frozen=True)
class Ground:
    """The ground and its contact with a footpad. Eqs. (14)-(17)."""

    slope: Annotated[float, Q("rad", "slope of the ground at rest, clockwise positive (falling towards +x)", -0.7, 0.7, "alpha", "paper", "deg")] = 0.0
    gravity: Annotated[float, Q("m/s2", "gravitational acceleration", 0.0, 50.0, "g", "closure")] = 9.81
    stiffness: Annotated[float, Q("N/m", "normal stiffness Kg (N/m^en)", 1e3, 1e13, "Kg", "identified")] = 42000000.0
    exponent: Annotated[float, Q("", "exponent en of the normal stiffness", 1.0, 3.0, "en", "identified")] = 1.419
    damping: Annotated[float, Q("N.s/m", "normal damping Cgmax at full depth", 0.0, 1e8, "Cgmax", "identified")] = 3168.0
    damping_depth: Annotated[float, Q("m", "penetration at which the normal damping is full", 1e-7, 0.1, "d_ramp", "identified", "mm")] = 2.165829e-05
    friction: Annotated[float, Q("", "friction coefficient mu; below 1e-7 it counts as 0", 0.0, 3.0, "mu", "identified")] = 0.2801
    friction_law: Annotated[str, Q("", "passive: an elastic displacement of constant stiffness and a slider, which never supplies energy; paper: Eqs. (16), (17), which may", choices=("passive", "paper"))] = "passive"
    stick_displacement: Annotated[float, Q("m", "displacement s_r0 of a sticking footpad: where friction_law = paper starts to slip; of which tangential_stiffness = 0 and slip_zone are made", 1e-6, 0.1, "s_r0", "identified", "mm")] = 0.0009128
    tangential_stiffness: Annotated[float, Q("N/m", "stiffness K of a sticking footpad along the ground, friction_law = passive; 0: the whole vehicle's mass times 9.80665 m/s2 over stick_displacement", 0.0, 1e12, "K_t", "closure")] = 0.0
    slip_zone: Annotated[float, Q("", "part of stick_displacement over which a footpad passes from sticking to slipping, friction_law = passive", 1e-3, 1.0, source="closure")] = 0.07
    stribeck_gain: Annotated[float, Q("", "excess ar of the sticking over the sliding friction", 0.0, 2.0, "ar", "identified")] = 0.005419
    stribeck_speed: Annotated[float, Q("m/s", "slip speed b_strib at which that excess fades", 1e-4, 10.0, "b_strib", "identified")] = 0.02604
    stick_damping: Annotated[float, Q("N.s/m", "damping Cr of a sticking footpad", 0.0, 1e6, "Cr", "identified")] = 19.19
    direction_speed: Annotated[float, Q("m/s", "slip speed below which friction is shared evenly between x and z, friction_law = paper", 1e-5, 0.1, "v_dir", "closure")] = 0.005
    release_time: Annotated[float, Q("s", "time constant at which the friction displacement returns to 0 out of contact", 1e-5, 1.0, "tau_sr", "closure")] = 0.002


@dataclass(frozen=True)
class Drop:
    """The vehicle's state at the first contact, and the duration of the free flight before it."""

    mode: Annotated[str, Q("", "landing mode: legs that touch first - second - third", source="paper", choices=tuple(MODES))] = "2-2"
    contact_time: Annotated[float, Q("s", "time of the first contact; the flight before it is free", 0.0, 60.0, source="identified")] = 0.089502
    tilt: Annotated[float, Q("rad", "pitch at first contact, clockwise positive", -1.5, 1.5, source="identified", display_unit="deg")] = -0.1378
    pitch_rate: Annotated[float, Q("rad/s", "pitch rate at first contact, clockwise positive", -10.0, 10.0, source="identified", display_unit="deg/s")] = 0.4
    horizontal_velocity: Annotated[float, Q("m/s", "velocity of the CG along inertial x at first contact", -50.0, 50.0, source="identified")] = 0.3492
    vertical_velocity: Annotated[float, Q("m/s", "velocity of the CG along inertial y (up) at first contact", -50.0, 50.0, source="identified")] = -1.359


@dataclass(frozen=True)
class Integration:
    """What the integrator may spend."""

    max_steps_per_second: Annotated[float, Q("1/s", "integrator steps, rejected ones included, that a simulated second may take on average; a landing that needs more is an error", 100.0, 1e9)] = 5e5

# fmt: on

GROUPS: dict[str, type] = {
    "vehicle": Vehicle,
    "main_strut": MainStrut,
    "auxiliary_strut": AuxiliaryStrut,
    "ground": Ground,
    "drop": Drop,
    "solver": Integration,
}


def _table() -> dict[str, Quantity]:
    table: dict[str, Quantity] = {}
    for group, owner in GROUPS.items():
        hints = get_type_hints(owner, include_extras=True)
        for f in fields(owner):
            q: Quantity = get_args(hints[f.name])[1]
            name = f"{group}.{f.name}"
            default: Any = f.default
            kind: Literal["string", "real"] = "string" if q.choices else "real"
            table[name] = replace(q, name=name, default=default, kind=kind)
    return table


PARAMETER_QUANTITIES: dict[str, Quantity] = _table()
# name -> (group, field of the group)
_FIELDS: dict[str, tuple[str, str]] = {
    name: (name.split(".")[0], name.split(".")[1]) for name in PARAMETER_QUANTITIES
}


# sources of values by name; of values that belong to one mode by (mode, name)
Sources = Mapping[str | tuple[str, str], str]


def check_value(q: Quantity, value: Any) -> float | str:
    """The value as the quantity `q` takes it.

    Raises:
        LandingError: The type is wrong, or the value is not finite or out of bounds; the message
            names quantity, value, unit and limit.
    """
    if q.choices:
        if not isinstance(value, str) or value not in q.choices:
            raise LandingError(f"{q.name} = {value!r} is not one of {', '.join(q.choices)}")
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise LandingError(
            f"{q.name} = {value!r} is not a number; give it in {q.unit or 'plain numbers'}"
        )
    number = _to_float(q, value)
    if not (q.lo <= number <= q.hi and isfinite(number)):
        bounds = f"is outside [{q.lo:g}, {q.hi:g}] {q.unit}".rstrip()
        unbounded = isinf(q.lo) and isinf(q.hi)
        raise LandingError(
            f"{q.name} = {number:g} {q.unit}".rstrip()
            + (" must be finite" if unbounded else f" {bounds}")
        )
    return number


def _to_float(q: Quantity, value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        raise LandingError(
            f"{q.name} is beyond the largest number, 1.8e308; it is outside "
            + f"[{q.lo:g}, {q.hi:g}] {q.unit}".rstrip()
        ) from None


@dataclass(frozen=True)
class Parameters:
    """All parameters of a landing.

    Attributes:
        vehicle: The body and its footpads.
        main_strut: The main strut.
        auxiliary_strut: The auxiliary strut.
        ground: The ground and its contact.
        drop: The state at first contact.
        by_mode: Values that belong to one landing mode only: mode -> name -> value.
        sources: Sources of values that are not the table's defaults, by name; of values that belong
            to one mode by (mode, name).
    """

    vehicle: Vehicle = field(default_factory=Vehicle)
    main_strut: MainStrut = field(default_factory=MainStrut)
    auxiliary_strut: AuxiliaryStrut = field(default_factory=AuxiliaryStrut)
    ground: Ground = field(default_factory=Ground)
    drop: Drop = field(default_factory=Drop)
    solver: Integration = field(default_factory=Integration)
    by_mode: Mapping[str, Mapping[str, float | str]] = field(default_factory=dict)
    sources: Sources = field(default_factory=dict)

    def __post_init__(self) -> None:
        groups = {group: vars(getattr(self, group)) for group in GROUPS}
        for name, (group, what) in _FIELDS.items():
            check_value(PARAMETER_QUANTITIES[name], groups[group][what])
        self._check_together()

    def items(self) -> Iterator[tuple[str, float | str]]:
        """Every (name, value), in the table's order."""
        for name in PARAMETER_QUANTITIES:
            yield name, self[name]

    def __getitem__(self, name: str) -> float | str:
        if name not in _FIELDS:
            raise unknown("parameter", name, PARAMETER_QUANTITIES)
        group, what = _FIELDS[name]
        value: float | str = getattr(getattr(self, group), what)
        return value

    def source(self, name: str, mode: str | None = None) -> str:
        """The source of the value of `name`; with a mode, of its value in `by_mode` where one is."""
        own = self.sources.get(name, PARAMETER_QUANTITIES[name].source)
        return own if mode is None else self.sources.get((mode, name), own)

    def with_values(
        self, values: Mapping[str, Any], source: str | Mapping[str, str] = "user"
    ) -> Parameters:
        """A copy with `values` by name, each checked; they are valid in every mode.

        Args:
            values: Values in SI by name.
            source: Their source: one for all, or by name (default `user`).

        Raises:
            LandingError: An unknown name or a bad value.
        """
        changed = self._replaced(values, {name: _source(name, source) for name in values})
        by_mode = {
            mode: {n: v for n, v in own.items() if n not in values}
            for mode, own in self.by_mode.items()
        }
        sources = {
            key: s
            for key, s in changed.sources.items()
            if isinstance(key, str) or key[1] not in values
        }
        return replace(changed, by_mode=by_mode, sources=sources)

    def with_mode_values(
        self, values: Mapping[str, Mapping[str, Any]], source: str | Mapping[str, str] = "user"
    ) -> Parameters:
        """A copy with `values` that belong to one mode each; `for_mode` applies them.

        Args:
            values: Values in SI: mode -> name -> value.
            source: Their source: one for all, or by name (default `user`).

        Raises:
            LandingError: An unknown mode or name, or a bad value.
        """
        by_mode = {mode: dict(own) for mode, own in self.by_mode.items()}
        sources = dict(self.sources)
        for mode, own in values.items():
            self.for_mode(mode)._replaced(own, {})
            by_mode.setdefault(mode, {}).update(own)
            sources.update({(mode, name): _source(name, source) for name in own})
        return replace(self, by_mode=by_mode, sources=sources)

    def for_mode(self, mode: str) -> Parameters:
        """A copy for the landing `mode`, with the values that belong to that mode.

        Raises:
            LandingError: The mode is unknown.
        """
        if mode not in MODES:
            raise unknown("landing mode", mode, MODES)
        own = self.by_mode.get(mode, {})
        sources: Sources = {name: self.source(name, mode) for name in own}
        return self._replaced({**own, "drop.mode": mode}, sources)

    def _replaced(self, values: Mapping[str, Any], sources: Sources) -> Parameters:
        grouped: dict[str, dict[str, float | str]] = {}
        for name, value in values.items():
            if name not in _FIELDS:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
            group, what = _FIELDS[name]
            grouped.setdefault(group, {})[what] = check_value(PARAMETER_QUANTITIES[name], value)
        parts: dict[str, Any] = {
            group: replace(getattr(self, group), **changed) for group, changed in grouped.items()
        }
        return replace(self, **parts, sources={**self.sources, **sources})

    def _check_together(self) -> None:
        m, a = self.main_strut, self.auxiliary_strut
        swept = m.area_lower * m.stroke_max
        if swept >= 0.95 * m.volume_lower:
            raise LandingError(
                f"main_strut.stroke_max = {m.stroke_max:g} m sweeps {swept:g} m3 of main_strut.volume_lower = {m.volume_lower:g} m3; "
                "at most 95 % may be swept: shorten the stroke or enlarge the volume"
            )
        softest = m.bulk_modulus / m.bulk_modulus_slope
        if m.ambient_pressure >= 0.9 * softest:
            raise LandingError(
                f"main_strut.ambient_pressure = {m.ambient_pressure:g} Pa leaves a liquid of main_strut.bulk_modulus = {m.bulk_modulus:g} Pa no "
                f"stiffness at 0 Pa; stay below 0.9 bulk_modulus/bulk_modulus_slope = {0.9 * softest:g} Pa"
            )
        if m.area_upper > m.area_lower:
            raise LandingError(
                f"main_strut.area_upper = {m.area_upper:g} m2 (annulus) is above main_strut.area_lower = {m.area_lower:g} m2 (bore)"
            )
        apart = (
            (m.joint_radius - a.joint_radius) ** 2 + (m.joint_depth - a.joint_depth) ** 2
        ) ** 0.5
        if not abs(m.length - a.length) < apart < m.length + a.length:
            raise LandingError(
                f"main_strut.length = {m.length:g} m and auxiliary_strut.length = {a.length:g} m do not meet at a footpad: "
                f"their joints are {apart:g} m apart; check lengths, joint radii and depths"
            )


def _source(name: str, source: str | Mapping[str, str]) -> str:
    return source if isinstance(source, str) else source.get(name, "user")


@cache
def azimuth(degrees: int) -> tuple[float, float]:
    """Sine and cosine of an azimuth [deg], exactly 0 at multiples of 90 degrees."""
    s, c = sin(radians(degrees)), cos(radians(degrees))
    return (0.0 if abs(s) < 1e-15 else s), (0.0 if abs(c) < 1e-15 else c)
