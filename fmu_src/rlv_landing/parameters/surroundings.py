"""Lists that are one text each: points of the body, a height field, the legs' azimuths."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import isfinite, pi, remainder
from typing import NamedTuple

from ..errors import LandingError

POINTS = "vehicle.body_points"
TERRAIN = "ground.terrain"
AZIMUTHS = "vehicle.leg_azimuths"
# two legs nearer to each other than this stand at one azimuth [rad]
LEAST_ANGLE = 1e-3
MOST_POINTS = 32
FARTHEST = 100.0
MOST_NODES = 40_000
HIGHEST = 1e3
Point = tuple[float, float, float]


def read_points(text: str) -> list[Point]:
    """The points of a text `x y z; x y z` [m].

    Raises:
        LandingError: It is none, or a point is too far away, or there are too many.
    """
    found = []
    for number, part in enumerate(filter(None, (p.strip() for p in text.split(";"))), 1):
        words = part.replace(",", " ").split()
        try:
            x, y, z = map(float, words)
        except ValueError:
            raise LandingError(
                f"{POINTS}: point {number}, {part!r}, is not three numbers; write x y z in m, and "
                "a semicolon between two points"
            ) from None
        if not all(abs(part) <= FARTHEST for part in (x, y, z)):
            raise LandingError(
                f"{POINTS}: point {number} = {x:g} {y:g} {z:g} m is outside [-{FARTHEST:g}, "
                f"{FARTHEST:g}] m; give it from the CG's height on the legs' axis"
            )
        found.append((x, y, z))
    if len(found) > MOST_POINTS:
        raise LandingError(
            f"{POINTS} has {len(found)} points, the limit is {MOST_POINTS}; leave out some"
        )
    return found


def written_points(points: Sequence[Sequence[float]]) -> str:
    """The text of points."""
    return "; ".join(" ".join(repr(float(x)) for x in point) for point in points)


class Axis(NamedTuple):
    """The coordinates of a grid along one axis."""

    first: float  # [m]
    spacing: float  # [m]
    nodes: int


class Terrain(NamedTuple):
    """A height field: heights above the ground's plane at the nodes of a regular grid.

    Attributes:
        x: The nodes along x.
        z: The nodes along z.
        heights: [z.nodes x x.nodes] The heights [m], one row along x after the other.
    """

    x: Axis
    z: Axis
    heights: tuple[float, ...]


def terrain_of(x: Sequence[float], z: Sequence[float], heights: Sequence[Sequence[float]]) -> str:
    """The text `ground.terrain` of a height field.

    Args:
        x: Coordinates of the nodes along x [m], evenly spaced and growing.
        z: Those along z.
        heights: [len(z)][len(x)] Heights above the ground's plane [m].

    Raises:
        LandingError: The grid is not regular, or has a hole.
    """
    for row in heights:
        if len(row) != len(x):
            raise LandingError(
                f"{TERRAIN}: a row has {len(row)} heights for {len(x)} coordinates along x; "
                "give every node a height"
            )
    if len(heights) != len(z):
        raise LandingError(
            f"{TERRAIN}: {len(heights)} rows for {len(z)} coordinates along z; give one for each"
        )
    flat = tuple(float(h) for row in heights for h in row)
    return written_terrain(_checked(Terrain(_axis("x", x), _axis("z", z), flat)))


def written_terrain(field: Terrain) -> str:
    """The text of a height field: `x first spacing count z first spacing count h heights`."""
    axes = (f"{n} {a.first!r} {a.spacing!r} {a.nodes}" for n, a in (("x", field.x), ("z", field.z)))
    return " ".join((*axes, "h", *map(repr, field.heights)))


def is_terrain(text: str) -> bool:
    """Whether a text begins as that of a height field does."""
    words = text[:200].split()
    return len(words) > 4 and (words[0], words[4]) == ("x", "z")


@lru_cache(maxsize=4)
def read_terrain(text: str) -> Terrain:
    """The height field of a text.

    Raises:
        LandingError: It is no such text, or the field has a hole.
    """
    words = text.split()
    if len(words) < 9 or (words[0], words[4], words[8]) != ("x", "z", "h"):
        raise LandingError(
            f"{TERRAIN} = {text!r} is no height field; name its file in a parameter file or by "
            "--set, or make the text by rlv_landing.parameters.terrain_of"
        )
    try:
        numbers = [float(word) for word in (*words[1:4], *words[5:8], *words[9:])]
        axes = [Axis(a, b, int(c)) for a, b, c in (numbers[:3], numbers[3:6])]
    except (ValueError, OverflowError):
        raise LandingError(f"{TERRAIN}: {text[:60]!r} ... has what is no number") from None
    return _checked(Terrain(axes[0], axes[1], tuple(numbers[6:])))


@lru_cache(maxsize=4)
def canonical_terrain(text: str) -> str:
    """A text of a height field as it is kept; an empty one is none.

    Raises:
        LandingError: As `read_terrain`.
    """
    return written_terrain(read_terrain(text)) if text.strip() else ""


def terrain_from_table(text: str, name: str) -> str:
    """The text `ground.terrain` of a table: x along its head, z in its first column, in m.

    Raises:
        LandingError: The table, which errors call `name`, is no height field.
    """
    rows = [line.replace(";", ",").split(",") for line in text.splitlines() if line.strip()]
    if len(rows) < 3 or len(rows[0]) < 3:
        raise LandingError(
            f"{name} is no height field: write z\\x and the coordinates along x in the first line, "
            "then z and its heights in each line, at least 2 x 2 heights"
        )
    numbers = []
    for k, row in enumerate(rows, 1):
        cells = row[1:] if k == 1 else row
        try:
            numbers.append([float(cell) for cell in cells])
        except ValueError:
            bad = next(cell for cell in cells if not _is_number(cell))
            what = "a hole" if not bad.strip() else f"{bad.strip()!r}, which is no number"
            raise LandingError(
                f"{name}, line {k}, has {what}; give every node a height in m"
            ) from None
    head, body = numbers[0], numbers[1:]
    try:
        return terrain_of(head, [row[0] for row in body], [row[1:] for row in body])
    except LandingError as e:
        raise LandingError(f"{name}: {e}") from None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _axis(name: str, values: Sequence[float]) -> Axis:
    """The axis of evenly spaced coordinates."""
    count = len(values)
    if count < 2:
        raise LandingError(f"{TERRAIN} has {count} node along {name}; at least 2 make a field")
    spacing = (values[-1] - values[0]) / (count - 1)
    for k, value in enumerate(values):
        if not abs(value - (values[0] + k * spacing)) <= 1e-6 * abs(spacing):
            raise LandingError(
                f"{TERRAIN}: {name} = {value:g} m is off the even spacing of {spacing:g} m from "
                f"{values[0]:g} to {values[-1]:g} m; give a regular grid"
            )
    return Axis(float(values[0]), float(spacing), count)


def _checked(field: Terrain) -> Terrain:
    nodes = field.x.nodes * field.z.nodes
    for name, axis in (("x", field.x), ("z", field.z)):
        if axis.nodes < 2 or not 1e-4 <= axis.spacing <= 1e4 or not abs(axis.first) <= 1e6:
            raise LandingError(
                f"{TERRAIN}: {axis.nodes} nodes along {name} from {axis.first:g} m, "
                f"{axis.spacing:g} m apart, are no field; give at least 2, growing, 0.1 mm to "
                "10 km apart"
            )
    if nodes > MOST_NODES:
        raise LandingError(
            f"{TERRAIN} has {nodes} heights, the limit is {MOST_NODES}; give a coarser or a "
            "smaller one"
        )
    if len(field.heights) != nodes:
        raise LandingError(
            f"{TERRAIN} has {len(field.heights)} heights for {field.x.nodes} x {field.z.nodes} "
            "nodes; give every node one"
        )
    for k, height in enumerate(field.heights):
        if not (isfinite(height) and abs(height) <= HIGHEST):
            row, column = divmod(k, field.x.nodes)
            x = field.x.first + column * field.x.spacing
            z = field.z.first + row * field.z.spacing
            raise LandingError(
                f"{TERRAIN}: the height at x = {x:g} m, z = {z:g} m is {height:g} m, "
                f"outside [-{HIGHEST:g}, {HIGHEST:g}] m; a field has no holes: fill them"
            )
    return field


def read_azimuths(text: str) -> list[float]:
    """The azimuths of a text `g1 g2 g3` [rad].

    Raises:
        LandingError: One is no number, or two legs stand at one azimuth.
    """
    found = []
    for leg, word in enumerate(text.replace(",", " ").split(), 1):
        if not _is_number(word) or not abs(float(word)) <= 2.0 * pi:
            raise LandingError(
                f"{AZIMUTHS}: leg {leg} = {word!r} is no angle; write numbers in rad from -2 pi to "
                "2 pi, with a blank between two"
            )
        found.append(float(word))
    for j, second in enumerate(found):
        for i, first in enumerate(found[:j]):
            apart = abs(remainder(second - first, 2.0 * pi))
            if apart < LEAST_ANGLE:
                raise LandingError(
                    f"{AZIMUTHS}: legs {i + 1} and {j + 1} stand {apart:g} rad apart, at one "
                    f"azimuth, {first:g} rad; the least angle is {LEAST_ANGLE:g} rad"
                )
    return found


def check_azimuths(text: str, legs: int) -> None:
    """Check that a text of azimuths has one for each of so many legs, or none.

    Raises:
        LandingError: It has more or fewer.
    """
    found = read_azimuths(text)
    if found and len(found) != legs:
        raise LandingError(
            f"{AZIMUTHS} has {len(found)} azimuths for vehicle.legs = {legs}; give each leg "
            "one, or none for legs evenly round the body"
        )
