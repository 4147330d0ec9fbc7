"""The table of parameters by name, made from the groups' declarations, and the check of values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from functools import lru_cache
from math import isfinite, isinf
from typing import Any, Literal, get_args, get_type_hints

from ..errors import LandingError
from ..quantities import MODES, SPACE, Quantity
from .drop import Drop, Integration
from .ground import Ground
from .leg import Leg
from .one_leg import OVERRIDES, read_overrides, split_leg, written_overrides
from .operators import OPERATORS, canonical_operators
from .sea import Sea
from .space import NO_EFFECT_IN_A_PLANE, ONLY_IN_SPACE
from .surroundings import (
    AZIMUTHS,
    POINTS,
    TERRAIN,
    canonical_terrain,
    read_azimuths,
    read_points,
    written_points,
)
from .vehicle import AuxiliaryStrut, MainStrut, Vehicle

GROUPS: dict[str, type] = {
    "vehicle": Vehicle,
    "leg": Leg,
    "main_strut": MainStrut,
    "auxiliary_strut": AuxiliaryStrut,
    "ground": Ground,
    "sea": Sea,
    "drop": Drop,
    "solver": Integration,
}


class ParameterTable(dict[str, Quantity]):
    """The parameters by name.

    It finds those that one leg may have for itself, too, which it does not list:
    `leg[2].ground.friction`.
    """

    def __missing__(self, name: str) -> Quantity:
        own = split_leg(name)
        if own is None or own[1] not in self:
            raise KeyError(name)
        leg, whole = own
        q = self[whole]
        return replace(q, name=name, meaning=f"leg {leg}: {q.meaning}", symbol="")

    def __contains__(self, name: object) -> bool:
        if super().__contains__(name):
            return True
        own = split_leg(name) if isinstance(name, str) else None
        return own is not None and super().__contains__(own[1])


def _table() -> ParameterTable:
    table = ParameterTable()
    for group, owner in GROUPS.items():
        hints = get_type_hints(owner, include_extras=True)
        for f in fields(owner):
            type_, meaning, q = get_args(hints[f.name])
            name = f"{group}.{f.name}"
            default: Any = f.default
            kind: Literal["string", "real"] = "string" if type_ is str else "real"
            table[name] = replace(q, meaning=meaning, name=name, default=default, kind=kind)
    return table


PARAMETER_QUANTITIES: ParameterTable = _table()
# name -> (group, field of the group)
FIELDS: dict[str, tuple[str, str]] = {
    name: (name.split(".")[0], name.split(".")[1]) for name in PARAMETER_QUANTITIES
}
MODE = "drop.mode"


def _with_modes(table: dict[str, Quantity], modes: tuple[str, ...]) -> dict[str, Quantity]:
    """A table of parameters in which these are the modes to choose from."""
    default = modes[0] if table[MODE].default not in modes else table[MODE].default
    return {**table, MODE: replace(table[MODE], choices=modes, default=default)}


IN_SPACE: dict[str, Quantity] = _with_modes(PARAMETER_QUANTITIES, (SPACE,))
IN_A_PLANE: dict[str, Quantity] = _with_modes(
    {
        name: q
        for name, q in PARAMETER_QUANTITIES.items()
        if name not in NO_EFFECT_IN_A_PLANE
        and FIELDS[name][1] not in ONLY_IN_SPACE.get(GROUPS[FIELDS[name][0]], ())
    },
    tuple(MODES),
)


def parameters_of(mode: str) -> dict[str, Quantity]:
    """The parameters that a landing in space, or a symmetric one, depends on, by name.

    `drop.mode` has the modes that have these parameters for choices.
    """
    return IN_SPACE if mode == SPACE else IN_A_PLANE


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
    if q.kind == "string":
        if not isinstance(value, str):
            raise LandingError(f"{q.name} = {value!r} is no text")
        return FORMS[q.name](value)
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


def overrides_of(text: str) -> dict[str, float | str]:
    """The values that legs have for themselves, by name, from `vehicle.leg_overrides`.

    Raises:
        LandingError: A name is none that a leg can have for itself, or a value is bad.
    """
    return dict(_parsed_overrides(text))


@lru_cache(maxsize=64)
def _parsed_overrides(text: str) -> tuple[tuple[str, float | str], ...]:
    return tuple((name, _override(name, value)) for name, value in read_overrides(text).items())


def _override(name: str, text: str) -> float | str:
    if split_leg(name) is None or name not in PARAMETER_QUANTITIES:
        raise LandingError(
            f"{OVERRIDES}: {name} is nothing that a leg has for itself; write leg[i]. before a "
            "value of a strut, of the contact (ground.friction, ...), or vehicle.footpad_mass"
        )
    q = PARAMETER_QUANTITIES[name]
    if q.kind == "string":
        return check_value(q, text)
    try:
        return check_value(q, float(text))
    except ValueError as e:
        if isinstance(e, LandingError):
            raise
        raise LandingError(
            f"{OVERRIDES}: {name} = {text!r} is not a number; "
            f"give it in {q.unit or 'plain numbers'}"
        ) from None


# the texts that are no choices, as they are kept: always the same one for the same meaning
FORMS: dict[str, Callable[[str], str]] = {
    OVERRIDES: lambda text: written_overrides(overrides_of(text)),
    POINTS: lambda text: written_points(read_points(text)),
    AZIMUTHS: lambda text: " ".join(map(repr, read_azimuths(text))),
    TERRAIN: canonical_terrain,
    OPERATORS: canonical_operators,
}
