"""From what a user types to parameters: preset, TOML file, mode and `name=value` pairs, in that
order of strength.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .errors import LandingError, unknown
from .parameters import Parameters
from .presets import DEFAULT_PRESET, load_preset, parse_value, read_toml
from .quantities import Quantity


def parse_pairs(
    pairs: Iterable[str], table: Mapping[str, Quantity], what: str
) -> dict[str, float | str]:
    """`name=value` texts as values in SI by name; a value may carry a unit.

    Raises LandingError: no `=`, unknown name, bad value.
    """
    values: dict[str, float | str] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not equals:
            raise LandingError(
                f"{what} {pair!r} has no '='; write name=value, for example ground.friction=0.3"
            )
        if name.strip() not in table:
            raise unknown(what, name.strip(), table)
        values[name.strip()] = parse_value(table[name.strip()], text.strip())
    return values


def choose_parameters(
    preset: str | None = None,
    file: str | Path | None = None,
    mode: str | None = None,
    values: Mapping[str, Any] | None = None,
) -> Parameters:
    """The parameters that a user asks for: a TOML file or a preset, for a mode, with single
    `values` by name on top.

    Raises LandingError: both a preset and a file, a file that is missing or wrong, unknown preset,
        mode or name, bad values.
    """
    if preset is not None and file is not None:
        raise LandingError(
            'give a preset or a parameter file, not both; a file names its preset itself: preset = "..."'
        )
    parameters = read_toml(file) if file is not None else load_preset(preset or DEFAULT_PRESET)
    changes = dict(values or {})
    given = changes.pop("drop.mode", None)
    wanted = mode if mode is not None else given if given is not None else parameters.drop.mode
    return parameters.for_mode(wanted).with_values(changes)
