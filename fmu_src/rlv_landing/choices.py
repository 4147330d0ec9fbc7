"""The parameters that a user chooses by preset, TOML file, mode and `name=value` pairs.

Of these the later one wins.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .errors import LandingError, unknown
from .parameters import Parameters
from .presets import DEFAULT_PRESET, load_preset, read_toml
from .quantities import Quantity
from .text.listed import parse_parameter


def split_pair(pair: str, what: str) -> tuple[str, str]:
    """Name and value of a `name=value` text, both without spaces around them.

    Args:
        pair: The text.
        what: The word for it in the error.

    Raises:
        LandingError: The text has no `=`.
    """
    name, equals, value = pair.partition("=")
    if not equals:
        raise LandingError(
            f"{what} {pair!r} has no '='; write name=value, for example ground.friction=0.3"
        )
    return name.strip(), value.strip()


def parse_pairs(
    pairs: Iterable[str], table: Mapping[str, Quantity], what: str
) -> dict[str, float | str]:
    """Values in SI by name, from `name=value` texts; a value may carry a unit.

    Args:
        pairs: The texts.
        table: The quantities that may be named.
        what: The word for such a quantity in errors.

    Raises:
        LandingError: A text has no `=`, an unknown name or a bad value.
    """
    values: dict[str, float | str] = {}
    for pair in pairs:
        name, value = split_pair(pair, what)
        if name not in table:
            raise unknown(what, name, table)
        values[name] = parse_parameter(table[name], value)
    return values


def choose_parameters(
    preset: str | None = None,
    file: str | Path | None = None,
    mode: str | None = None,
    values: Mapping[str, Any] | None = None,
) -> Parameters:
    """The parameters of a preset or TOML file, for one landing mode, with single values changed.

    Args:
        preset: A preset's name [default: yue2022-figures].
        file: A TOML file, instead of a preset.
        mode: The landing mode [default: `drop.mode` of `values`, else the parameters' own].
        values: Values in SI by name.

    Raises:
        LandingError: Both a preset and a file, a file that is missing or wrong, an unknown preset,
            mode or name, or a bad value.
    """
    if preset is not None and file is not None:
        raise LandingError(
            "give a preset or a parameter file, not both; a file names its preset itself: "
            'preset = "..."'
        )
    parameters = read_toml(file) if file is not None else load_preset(preset or DEFAULT_PRESET)
    changes = dict(values or {})
    given = changes.pop("drop.mode", None)
    wanted = mode if mode is not None else given if given is not None else parameters.drop.mode
    return parameters.for_mode(wanted).with_values(changes)
