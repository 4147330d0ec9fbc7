"""Values that one leg has for itself: `leg[2].main_strut.stiffness`, and their text in one line.

The text `vehicle.leg_overrides` holds them, so that all that carries parameters carries them too:
files, an FMU, a node, a log.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from ..errors import LandingError
from ..quantities import MOST_LEGS

OVERRIDES = "vehicle.leg_overrides"
LEG_NAME = re.compile(r"leg\[([1-9][0-9]*)\]\.([a-z_]+\.[a-z_0-9]+)")
# groups that belong to a leg with all their parameters
STRUTS = ("main_strut", "auxiliary_strut")
# of the others, the parameters that do not: of the whole ground, and the legs' share of the vehicle
OF_ALL = (
    *("ground.slope", "ground.slope_direction", "ground.gravity", "ground.terrain"),
    *("ground.roughness", "ground.roughness_length", "ground.terrain_seed"),
)
OF_EACH = ("vehicle.footpad_mass",)


def groups_of_a_leg() -> tuple[str, ...]:
    """The groups of which a leg may have values for itself."""
    return (*STRUTS, "ground", "vehicle")


def split_leg(name: str) -> tuple[int, str] | None:
    """The leg's number and the parameter of a name such as `leg[2].ground.friction`.

    None where a leg cannot have it for itself.
    """
    found = LEG_NAME.fullmatch(name)
    if found is None or not 1 <= int(found[1]) <= MOST_LEGS:
        return None
    group = found[2].split(".")[0]
    own = group in STRUTS or (group == "ground" and found[2] not in OF_ALL) or found[2] in OF_EACH
    return (int(found[1]), found[2]) if own else None


def leg_of(name: str) -> int:
    """The number of the leg that has the parameter of this name for itself; 0: none has."""
    found = split_leg(name)
    return found[0] if found else 0


def read_overrides(text: str) -> dict[str, str]:
    """The values that a text of overrides has, as texts by name.

    Raises:
        LandingError: It is no list of `name = value`, separated by semicolons, or names one twice.
    """
    found: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in text.split(";"))):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or not value:
            raise LandingError(
                f"{OVERRIDES}: {part!r} is no value of a leg; write name = value, for example "
                "leg[2].ground.friction = 0.1, and a semicolon between two"
            )
        if name in found:
            raise LandingError(f"{OVERRIDES} has {name} twice; leave one")
        found[name] = value
    return found


def written_overrides(values: Mapping[str, float | str]) -> str:
    """The text of values by name, in the order of legs and names; numbers keep all digits."""
    ordered = sorted(values, key=lambda name: (int(name[4 : name.index("]")]), name))
    texts = (v if isinstance(v := values[n], str) else repr(float(v)) for n in ordered)
    return "; ".join(f"{name} = {text}" for name, text in zip(ordered, texts))
