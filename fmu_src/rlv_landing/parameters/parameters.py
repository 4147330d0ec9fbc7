"""`Parameters`: all values of a landing, checked on construction."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ..errors import LandingError, unknown
from ..quantities import MODES, SPACE, TRIPOD, Interface, interface_of
from .drop import Drop, Integration
from .ground import Ground
from .leg import Leg, check_triangle, check_tripod
from .one_leg import LEG_NAME, OVERRIDES, split_leg, written_overrides
from .sea import Sea, check_sea
from .space import check_space
from .table import FIELDS, GROUPS, PARAMETER_QUANTITIES, check_value, overrides_of
from .vehicle import AuxiliaryStrut, MainStrut, Vehicle

# sources of values by name; of values that belong to one mode by (mode, name)
Sources = Mapping[str | tuple[str, str], str]


@dataclass(frozen=True)
class Parameters:
    """All parameters of a landing.

    Attributes:
        vehicle: The body and its footpads.
        leg: What all legs have alike.
        main_strut: The main strut.
        auxiliary_strut: The auxiliary strut.
        ground: The ground and its contact.
        sea: The sea below a deck.
        drop: The state at first contact.
        solver: What the integrator may spend.
        by_mode: Values that belong to one landing mode only: mode -> name -> value.
        sources: Sources of values that are not the table's defaults, by name; of values that belong
            to one mode by (mode, name).
    """

    vehicle: Vehicle = field(default_factory=Vehicle)
    leg: Leg = field(default_factory=Leg)
    main_strut: MainStrut = field(default_factory=MainStrut)
    auxiliary_strut: AuxiliaryStrut = field(default_factory=AuxiliaryStrut)
    ground: Ground = field(default_factory=Ground)
    sea: Sea = field(default_factory=Sea)
    drop: Drop = field(default_factory=Drop)
    solver: Integration = field(default_factory=Integration)
    by_mode: Mapping[str, Mapping[str, float | str]] = field(default_factory=dict)
    sources: Sources = field(default_factory=dict)

    def __post_init__(self) -> None:
        groups = {group: vars(getattr(self, group)) for group in GROUPS}
        for name, (group, what) in FIELDS.items():
            check_value(PARAMETER_QUANTITIES[name], groups[group][what])
        self._check_together()

    def items(self) -> Iterator[tuple[str, float | str]]:
        """Every (name, value), in the table's order."""
        for name in PARAMETER_QUANTITIES:
            yield name, self[name]

    def __getitem__(self, name: str) -> float | str:
        if name not in FIELDS:
            own = split_leg(name)
            if own is None or own[1] not in FIELDS:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
            return self.overrides.get(name, self[own[1]])
        group, what = FIELDS[name]
        value: float | str = getattr(getattr(self, group), what)
        return value

    @property
    def overrides(self) -> dict[str, float | str]:
        """The values that single legs have for themselves, by name: `leg[2].ground.friction`."""
        return overrides_of(self.vehicle.leg_overrides) if self.vehicle.leg_overrides else {}

    @property
    def interface(self) -> Interface:
        """The inputs and outputs of a landing with them."""
        return interface_of(self.drop.mode, int(self.vehicle.legs), self.leg.kind)

    @property
    def whole_mass(self) -> float:
        """Mass of the vehicle with its footpads [kg]."""
        v = self.vehicle
        more = (
            float(value) - v.footpad_mass
            for name, value in self.overrides.items()
            if name.endswith("vehicle.footpad_mass")
        )
        return v.mass + v.footpad_mass * v.legs + sum(more)

    def of_leg(self, leg: int) -> Parameters:
        """The parameters as the leg with this number has them, without those of other legs."""
        if not self.vehicle.leg_overrides:
            return self
        own = {
            whole: value
            for name, value in self.overrides.items()
            for number, whole in [split_leg(name) or (0, "")]
            if number == leg
        }
        return self._replaced({**own, OVERRIDES: ""}, self.sources, self.by_mode)

    def _repr_html_(self) -> str:
        """The table that notebooks show: every value with its unit, source and meaning."""
        from html import escape

        rows = []
        for name, value in self.items():
            q = PARAMETER_QUANTITIES[name]
            text = value if isinstance(value, str) else f"{value:.6g}"
            cells = map(escape, (name, text, q.unit, self.source(name), q.meaning))
            rows.append("".join(f"<td>{cell}</td>" for cell in cells))
        head = "".join(f"<th>{h}</th>" for h in ("parameter", "value", "unit", "source", "meaning"))
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        return (
            f"<details><summary>{len(rows)} parameters, {escape(self.drop.mode)} landing</summary>"
            f"<table><tr>{head}</tr>{body}</table></details>"
        )

    def source(self, name: str, mode: str | None = None) -> str:
        """The source of the value of `name`; with a `mode`, of its value for that mode."""
        own = self.sources.get(name, PARAMETER_QUANTITIES[name].source)
        return own if mode is None else self.sources.get((mode, name), own)

    def with_values(
        self, values: Mapping[str, Any], source: str | Mapping[str, str] = "user"
    ) -> Parameters:
        """A copy with `values` by name, each checked; they are valid in every mode.

        Args:
            values: Values in SI by name; a leg's own, `leg[2].ground.friction`, add to those that
                legs have.
            source: Their source: one for all, or by name (default `user`).

        Raises:
            LandingError: An unknown name or a bad value.
        """
        by_mode = {
            mode: {n: v for n, v in own.items() if n not in values}
            for mode, own in self.by_mode.items()
        }
        sources = {
            key: s
            for key, s in self.sources.items()
            if isinstance(key, str) or key[1] not in values
        }
        new: dict[str | tuple[str, str], str] = {n: _source(n, source) for n in values}
        if any(LEG_NAME.fullmatch(name) for name in values):
            new[OVERRIDES] = "user"
        return self._replaced(values, {**sources, **new}, by_mode)

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
            # a vehicle of landings in space may have what no symmetric landing has
            whole = self if mode in MODES and self.drop.mode == SPACE else self.for_mode(mode)
            whole._replaced(own, whole.sources, whole.by_mode)
            by_mode.setdefault(mode, {}).update(own)
            sources.update({(mode, name): _source(name, source) for name in own})
        return replace(self, by_mode=by_mode, sources=sources)

    def for_mode(self, mode: str) -> Parameters:
        """A copy for the landing `mode`, with the values that belong to that mode.

        Raises:
            LandingError: The mode is unknown.
        """
        if mode not in (*MODES, SPACE):
            raise unknown("landing mode", mode, (*MODES, SPACE))
        own = self.by_mode.get(mode, {})
        if mode == self.drop.mode and not own:
            return self
        sources: Sources = {name: self.source(name, mode) for name in own}
        return self._replaced({**own, "drop.mode": mode}, {**self.sources, **sources}, self.by_mode)

    def _replaced(
        self,
        values: Mapping[str, Any],
        sources: Sources,
        by_mode: Mapping[str, Mapping[str, float | str]],
    ) -> Parameters:
        """A copy with `values` by name, each checked, and with these sources and modes' values."""
        grouped: dict[str, dict[str, float | str]] = {}
        own = {name: value for name, value in values.items() if LEG_NAME.fullmatch(name)}
        for name, value in self._with_overrides(values, own).items():
            if name not in FIELDS:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
            group, what = FIELDS[name]
            grouped.setdefault(group, {})[what] = check_value(PARAMETER_QUANTITIES[name], value)
        parts: dict[str, Any] = {
            group: replace(getattr(self, group), **changed) for group, changed in grouped.items()
        }
        return replace(self, **parts, by_mode=by_mode, sources=sources)

    def _with_overrides(
        self, values: Mapping[str, Any], own: Mapping[str, Any]
    ) -> Mapping[str, Any]:
        """The `values`, with the values of single legs among them, `own`, as one text."""
        if not own:
            return values
        for name in own:
            if name not in PARAMETER_QUANTITIES:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
        text = check_value(
            PARAMETER_QUANTITIES[OVERRIDES], values.get(OVERRIDES, self.vehicle.leg_overrides)
        )
        checked = {name: check_value(PARAMETER_QUANTITIES[name], v) for name, v in own.items()}
        written = written_overrides({**overrides_of(str(text)), **checked})
        return {**{n: v for n, v in values.items() if n not in own}, OVERRIDES: written}

    def _check_legs(self) -> None:
        """Check the values that single legs have for themselves."""
        legs = int(self.vehicle.legs)
        first: dict[int, str] = {}
        for name in self.overrides:
            first.setdefault((split_leg(name) or (0, ""))[0], name)
        for leg, name in first.items():
            if leg > legs:
                raise LandingError(f"{name} is of a leg that is not there: vehicle.legs = {legs}")
            try:
                self.of_leg(leg)
            except LandingError as e:
                raise LandingError(f"leg[{leg}]: {e}") from None

    def _check_together(self) -> None:
        check_space(self.vehicle, self.leg, self.drop, self.ground, self.sea)
        check_sea(self.sea)
        self._check_legs()
        m, a = self.main_strut, self.auxiliary_strut
        swept = m.area_lower * m.stroke_max
        if swept >= 0.95 * m.volume_lower:
            raise LandingError(
                f"main_strut.stroke_max = {m.stroke_max:g} m sweeps {swept:g} m3 of "
                f"main_strut.volume_lower = {m.volume_lower:g} m3; "
                "at most 95 % may be swept: shorten the stroke or enlarge the volume"
            )
        softest = m.bulk_modulus / m.bulk_modulus_slope
        if m.ambient_pressure >= 0.9 * softest:
            raise LandingError(
                f"main_strut.ambient_pressure = {m.ambient_pressure:g} Pa leaves a liquid of "
                f"main_strut.bulk_modulus = {m.bulk_modulus:g} Pa no stiffness at 0 Pa; "
                f"stay below 0.9 bulk_modulus/bulk_modulus_slope = {0.9 * softest:g} Pa"
            )
        if m.area_upper > m.area_lower:
            raise LandingError(
                f"main_strut.area_upper = {m.area_upper:g} m2 (annulus) is above "
                f"main_strut.area_lower = {m.area_lower:g} m2 (bore)"
            )
        if self.leg.kind == TRIPOD:
            check_tripod(self.vehicle, m, a)
        check_triangle(m, a, self.leg.kind)


def _source(name: str, source: str | Mapping[str, str]) -> str:
    return source if isinstance(source, str) else source.get(name, "user")
