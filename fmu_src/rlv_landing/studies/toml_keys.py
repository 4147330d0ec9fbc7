"""Keys of a study's TOML file, each checked as it is read.

Every function raises LandingError, which names key, value, unit, limit and remedy.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

from ..errors import LandingError, unknown
from ..parameters import check_value
from ..quantities import Quantity
from ..text.files import parse_document, read_text, toml_table
from ..text.values import parse_value


def read(path: Path) -> tuple[dict[str, Any], str]:
    """A study's document, and its text.

    Raises:
        LandingError: The file is missing or cannot be read, or its TOML syntax is wrong.
    """
    text = read_text(path, "study")
    return parse_document(text, str(path)), text


def table(document: Mapping[str, Any], key: str) -> dict[str, Any]:
    """The table [key], empty where it is missing."""
    return toml_table(document.get(key, {}), key)


def tables(document: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    """The tables [[key]], in order."""
    value = document.get(key, [])
    if not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
        raise LandingError(f"{key} must be written [[{key}]], once for each, its values below")
    return value


def refuse_unknown(given: Iterable[str], known: Collection[str], what: str) -> None:
    """Refuse a key that is not known; the error names the nearest."""
    for key in given:
        if key not in known:
            raise unknown(what, key, known)


def by_dotted_name(nested: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Values by dotted name: `drop.tilt = 1` and `[drop] tilt = 1` are the same."""
    found: dict[str, Any] = {}
    for key, value in nested.items():
        if isinstance(value, dict):
            found.update(by_dotted_name(value, f"{prefix}{key}."))
        else:
            found[f"{prefix}{key}"] = value
    return found


def values(
    nested: Mapping[str, Any], known: Mapping[str, Quantity], what: str
) -> dict[str, float | str]:
    """Values in SI by name, each a number in SI or a text with a unit."""
    given = by_dotted_name(nested)
    refuse_unknown(given, known, what)
    return {name: parse_value(known[name], value) for name, value in given.items()}


def text(keys: Mapping[str, Any], key: str, default: str) -> str:
    """A text, not empty."""
    value = keys.get(key, default)
    if not isinstance(value, str) or not value:
        raise LandingError(f"{key} = {value!r} must be a text")
    return value


def folder_name(keys: Mapping[str, Any], default: str) -> str:
    """The key `name`, which names the results folder.

    Raises:
        LandingError: It is no name of a folder beside others.
    """
    name = text(keys, "name", default)
    if name in (".", "..") or Path(name).name != name or not name.isprintable():
        raise LandingError(
            f"name = {name!r} names no folder of its own; take one without '/' and control "
            "characters"
        )
    return name


def texts(keys: Mapping[str, Any], key: str) -> list[str] | None:
    """A list of texts, not empty and without repetition; None where it is missing."""
    value = keys.get(key)
    if value is None:
        return None
    if not isinstance(value, list) or not value or not all(isinstance(v, str) for v in value):
        raise LandingError(f"{key} = {value!r} must be a list of texts, not empty")
    if len(set(value)) < len(value):
        raise LandingError(f"{key} = {value!r} names one twice")
    return value


def integer(keys: Mapping[str, Any], key: str, default: int, lowest: int, highest: int) -> int:
    """A whole number within bounds, both included."""
    value = keys.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
        raise LandingError(f"{key} = {value!r} must be a whole number from {lowest} to {highest}")
    return value


def number(keys: Mapping[str, Any], q: Quantity) -> float:
    """The number of the quantity `q`, in SI or a text with a unit.

    Its default is returned where it is missing.
    """
    return float(parse_value(q, keys[q.name]) if q.name in keys else check_value(q, q.default))
