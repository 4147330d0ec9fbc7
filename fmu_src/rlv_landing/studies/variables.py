"""The quantities that a study may vary or set, and which of them a landing mode has."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from math import atan2, cos, hypot, pi, sin
from typing import Any

from ..errors import LandingError, unknown
from ..parameters import PARAMETER_QUANTITIES, Parameters, ParameterTable, leg_of, parameters_of
from ..parameters.space import NO_EFFECT_IN_A_PLANE
from ..quantities import INPUTS_BY_NAME, MODES, SPACE, SPACE_INPUTS, Quantity

ALONG, ACROSS = "drop.horizontal_velocity", "drop.lateral_velocity"
# the horizontal velocity in space by size and direction, in place of its components
SPEED = Quantity(
    "m/s",
    "horizontal speed of the CG at first contact, towards drop.direction; mode = space",
    0.0,
    50.0,
    name="drop.speed",
)
DIRECTION = Quantity(
    "rad",
    "direction of the horizontal velocity at first contact, from inertial x towards z; "
    "mode = space",
    -2.0 * pi,
    2.0 * pi,
    name="drop.direction",
    display_unit="deg",
)
POLAR = (SPEED.name, DIRECTION.name)
_IN_SPACE = {q.name: q for q in SPACE_INPUTS}
# every parameter, that of one leg as well, every input as a constant, and the polar velocity
VARIABLES = ParameterTable(
    {
        **PARAMETER_QUANTITIES,
        **_IN_SPACE,
        **INPUTS_BY_NAME,
        SPEED.name: SPEED,
        DIRECTION.name: DIRECTION,
    }
)
_ONLY_IN_SPACE = {
    *(parameters_of(SPACE).keys() - parameters_of(min(MODES)).keys()),
    *POLAR,
    *(_IN_SPACE.keys() - INPUTS_BY_NAME.keys()),
}.difference(NO_EFFECT_IN_A_PLANE)
_ONLY_IN_A_PLANE = INPUTS_BY_NAME.keys() - _IN_SPACE.keys()


def variable(name: Any, what: str) -> Quantity:
    """The quantity of this name.

    Args:
        name: The name.
        what: The word for it in the error.

    Raises:
        LandingError: There is no such quantity that can be varied; the message names the nearest.
    """
    if not isinstance(name, str) or name not in VARIABLES:
        raise unknown(what, name, VARIABLES)
    return VARIABLES[name]


def check_variables(names: Collection[str], modes: Iterable[str]) -> None:
    """Check that every landing of the `modes` has the quantities that are varied or set.

    Raises:
        LandingError: A mode lacks one, or a velocity is given by components and by direction.
    """
    for mode in modes:
        lacking = _ONLY_IN_A_PLANE if mode == SPACE else _ONLY_IN_SPACE
        for name in names:
            if name in lacking or (mode != SPACE and leg_of(name)):
                needed = " or ".join(MODES) if mode == SPACE else SPACE
                raise LandingError(
                    f"{name} needs drop.mode = {needed}, and the study lands with {mode}; "
                    f"leave {name} out, or change the mode"
                )
    given = [name for name in (ALONG, ACROSS) if name in names]
    polar = [name for name in POLAR if name in names]
    if given and polar:
        raise LandingError(
            f"{polar[0]} and {given[0]} both give the horizontal velocity; take {ALONG} and "
            f"{ACROSS}, or {' and '.join(POLAR)}"
        )


def check_legs(names: Iterable[str], legs: int) -> None:
    """Check that no name is of a leg beyond the vehicle's `legs`.

    Raises:
        LandingError: One is.
    """
    for name in names:
        if leg_of(name) > legs:
            raise LandingError(f"{name} is of a leg that is not there: vehicle.legs = {legs}")


def resolved(values: Mapping[str, Any], parameters: Parameters) -> dict[str, Any]:
    """The values with a velocity by speed and direction as its components.

    Args:
        values: Parameters and inputs by name [SI].
        parameters: What a speed or direction that is not among them is taken from.
    """
    if not any(name in values for name in POLAR):
        return dict(values)
    along, across = parameters[ALONG], parameters[ACROSS]
    assert isinstance(along, float)
    assert isinstance(across, float)
    speed = values.get(SPEED.name, hypot(along, across))
    direction = values.get(DIRECTION.name, atan2(across, along))
    rest = {name: value for name, value in values.items() if name not in POLAR}
    return {**rest, ALONG: speed * cos(direction), ACROSS: speed * sin(direction)}


def is_parameter(name: str) -> bool:
    """Whether the quantity of this name is one of the parameters, or makes some; else an input."""
    return name in PARAMETER_QUANTITIES or name in POLAR
