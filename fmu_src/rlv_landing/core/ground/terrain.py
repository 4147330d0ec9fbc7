"""Heights between the nodes of a regular grid: bicubic, once continuously differentiable.

A cubic between two nodes has the slope of the line through a node's neighbours there (Catmull and
Rom), so a plane is met exactly and so is every node. [closure]
"""

from __future__ import annotations

from ..memory import Doubles
from ..records import Cubic, HeightField, TerrainHeight, TerrainPlace, Vector


def cubic(a: float, b: float, c: float, d: float, part: float) -> Cubic:
    """The cubic from `b` to `c`, whose neighbours are `a` and `d`, at a `part` of the way."""
    p1 = 0.5 * (c - a)
    p2 = a - 2.5 * b + 2.0 * c - 0.5 * d
    p3 = 0.5 * (d - a) + 1.5 * (b - c)
    return Cubic(
        b + part * (p1 + part * (p2 + part * p3)),
        p1 + part * (2.0 * p2 + part * 3.0 * p3),
    )


def along_row(heights: Doubles, at: int, part: float) -> Cubic:
    """The cubic through four nodes of a row, the first of which is `heights[at]`."""
    return cubic(heights[at], heights[at + 1], heights[at + 2], heights[at + 3], part)


def height_between(
    heights: Doubles, at: int, width: int, part_u: float, part_v: float
) -> TerrainHeight:
    """Height [m], and its slopes a spacing, among 16 nodes, the first of which is `heights[at]`.

    Args:
        heights: The grid, row by row.
        at: The first node's place.
        width: Length of a row.
        part_u: Part of the way from the second to the third node of a row.
        part_v: Part of the way from the second to the third row.
    """
    r0 = along_row(heights, at, part_u)
    r1 = along_row(heights, at + width, part_u)
    r2 = along_row(heights, at + 2 * width, part_u)
    r3 = along_row(heights, at + 3 * width, part_u)
    across = cubic(r0.value, r1.value, r2.value, r3.value, part_v)
    slope_u = cubic(r0.slope, r1.slope, r2.slope, r3.slope, part_v).value
    return TerrainHeight(across.value, slope_u, across.slope)


def height_in_cell(
    heights: Doubles, column: int, row: int, width: int, u: float, v: float
) -> TerrainHeight:
    """As `height_between`, in the cell that begins at the node `column`, `row`.

    `u` and `v` are the coordinates in spacings. The grid has a node more on each side.
    """
    return height_between(heights, row * width + column, width, u - column, v - row)


def terrain_place(field: HeightField, heights: Doubles, width: int, place: Vector) -> TerrainPlace:
    """A height field below a place from the deck's origin, in the axes of the ground's plane [m].

    Beyond the field its edge goes on.

    Args:
        field: The grid.
        heights: Its heights, row by row, with a node more on each side.
        width: The length of such a row.
        place: The place: along 1, above the plane, along 2.
    """
    u = (field.cos_d * place.x - field.sin_d * place.z - field.u0) / field.du
    v = (field.sin_d * place.x + field.cos_d * place.z - field.v0) / field.dv
    last_u = field.columns - 1.0
    last_v = field.rows - 1.0
    outside = 0.0
    if u < 0.0 or v < 0.0 or u > last_u or v > last_v:
        outside = 1.0
        u = min(max(u, 0.0), last_u)
        v = min(max(v, 0.0), last_v)
    found = height_in_cell(
        heights, int(min(u, last_u - 1.0)), int(min(v, last_v - 1.0)), width, u, v
    )
    along_u = found.slope_u / field.du
    along_v = found.slope_v / field.dv
    return TerrainPlace(
        found.height - place.y,
        field.cos_d * along_u + field.sin_d * along_v,
        field.cos_d * along_v - field.sin_d * along_u,
        outside,
    )
