"""Grades of landings that were not lost: the first whose bounds a landing keeps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...errors import LandingError
from ...quantities import Quantity
from ...text.values import parse_value
from .. import toml_keys

LOST, UNGRADED = "lost", "below all grades"
KEYS = ("name", "most", "least")


@dataclass(frozen=True)
class Grade:
    """A grade: responses that must be at `most`, and others that must be at `least` so large."""

    name: str
    most: Mapping[str, float]
    least: Mapping[str, float]

    def kept(self, values: Mapping[str, Any]) -> bool:
        """Whether the responses `values` keep every bound; one that a landing lacks does not."""
        return all(
            values[name] is not None and values[name] <= v for name, v in self.most.items()
        ) and all(values[name] is not None and values[name] >= v for name, v in self.least.items())

    def record(self) -> dict[str, Any]:
        """The grade for JSON."""
        return {"name": self.name, "most": dict(self.most), "least": dict(self.least)}


def grade_of(grades: Sequence[Grade], values: Mapping[str, Any], *, lost: bool) -> str:
    """The name of the first grade that a landing keeps; LOST and UNGRADED beside them."""
    if lost:
        return LOST
    return next((g.name for g in grades if g.kept(values)), UNGRADED)


def read_grades(
    entries: Sequence[Mapping[str, Any]], known: Mapping[str, Quantity]
) -> tuple[Grade, ...]:
    """The grades of the tables [[grade]], the best first.

    Raises:
        LandingError: No name, one twice, no bounds, an unknown response, a text, or a wrong unit.
    """
    found: list[Grade] = []
    for entry in entries:
        toml_keys.refuse_unknown(entry, KEYS, "key of [[grade]]")
        name = toml_keys.text(entry, "name", "")
        if name in (LOST, UNGRADED, *(g.name for g in found)):
            raise LandingError(f"[[grade]] name = {name!r} is given twice or taken; take another")
        bounds = [_bounds(name, entry, key, known) for key in ("most", "least")]
        if not any(bounds):
            raise LandingError(
                f'grade {name} has no bounds; write for example most = {{ "margin.slid" = 0.1 }}'
            )
        found.append(Grade(name, *bounds))
    return tuple(found)


def _bounds(
    grade: str, entry: Mapping[str, Any], key: str, known: Mapping[str, Quantity]
) -> dict[str, float]:
    given = toml_keys.by_dotted_name(toml_keys.table(entry, key))
    toml_keys.refuse_unknown(given, known, f"response in {key} of grade {grade}")
    for name in given:
        if known[name].kind == "string":
            raise LandingError(f"grade {grade}: {name} is a text, and has no bound; take a number")
    return {name: float(parse_value(known[name], value)) for name, value in given.items()}
