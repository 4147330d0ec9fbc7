"""Lists that users write in other forms than the text that parameters keep."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..errors import LandingError
from ..parameters import operators_from_table, terrain_from_table
from ..parameters.operators import OPERATORS, is_operators
from ..parameters.surroundings import AZIMUTHS, POINTS, TERRAIN, is_terrain, written_points
from ..quantities import Quantity
from .files import read_text
from .values import is_number, parse_value, to_si

ANGLE = Quantity("rad", "", name=f"an angle of {AZIMUTHS}", display_unit="deg")
COORDINATE = Quantity("m", "", name=f"a coordinate of {POINTS}", display_unit="mm")


def parse_parameter(q: Quantity, value: Any, folder: Path | None = None) -> float | str:
    """As `parse_value`, of a parameter whose list may be written in another form.

    Args:
        q: The parameter.
        value: The number or text; the points of the body may be an array of arrays, the azimuths
            an array, a height field and response operators the name of their file.
        folder: The folder that a file's name starts from; None: the present one.

    Raises:
        LandingError: As `parse_value`; or the file is missing, or is no height field.
    """
    if q.name == POINTS and isinstance(value, list):
        return parse_value(q, written_points([_point(k, p) for k, p in enumerate(value, 1)]))
    if q.name == AZIMUTHS and isinstance(value, list):
        return parse_value(q, " ".join(repr(to_si(ANGLE, _number(AZIMUTHS, x))) for x in value))
    if q.name == TERRAIN and isinstance(value, str) and value.strip() and not is_terrain(value):
        path = (folder or Path()) / value.strip()
        missing = f"there is no height field {path}; {TERRAIN} names a table of heights"
        table = read_text(path, "height field", missing)
        return parse_value(q, terrain_from_table(table, str(path)))
    if q.name == OPERATORS and isinstance(value, str) and value.strip() and not is_operators(value):
        path = (folder or Path()) / value.strip()
        missing = f"there is no table {path}; {OPERATORS} names a table of response operators"
        table = read_text(path, "table of response operators", missing)
        return parse_value(q, operators_from_table(table, str(path)))
    return parse_value(q, value)


def _point(number: int, point: Any) -> list[float]:
    if not isinstance(point, list) or len(point) != 3:
        raise LandingError(
            f"{POINTS}: point {number} = {point!r} is not three coordinates; write [x, y, z]"
        )
    return [to_si(COORDINATE, _number(f"{POINTS}: point {number}", x)) for x in point]


def _number(where: str, value: Any) -> float | str:
    if not is_number(value):
        raise LandingError(f"{where} has {value!r}, which is no number")
    number: float | str = value
    return number
