"""The boundary between two verdicts in a plane, found with few verdicts.

Cells are halved where their corners differ, then the edges that the boundary crosses. Points are
whole numbers on one fine lattice: no point is judged twice, and the result does not depend on the
order of judging.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import product

import contourpy
import numpy as np

Point = tuple[int, int]
Judge = Callable[[Sequence[Point]], Sequence[bool]]


@dataclass(frozen=True)
class Lattice:
    """Coarse cells, the cells that they are halved into, and the fine lattice of points.

    Attributes:
        cells: Coarse cells along each axis.
        levels: How many times cells are halved where their corners differ.
        steps: Units of the fine lattice along x and y in a coarse cell, a power of two of at least
            2^levels.
    """

    cells: int
    levels: int
    steps: tuple[int, int]

    @property
    def size(self) -> Point:
        """Units along x and y."""
        return self.cells * self.steps[0], self.cells * self.steps[1]

    @property
    def uniform(self) -> int:
        """The number of points of the whole fine lattice: a uniform grid of this resolution."""
        return (self.size[0] + 1) * (self.size[1] + 1)


@dataclass(frozen=True)
class Crossing:
    """Two points of the fine lattice, neighbours along x or y, with the boundary between them."""

    stable: Point
    lost: Point

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of the edge, at most half a unit off the boundary."""
        return 0.5 * (self.stable[0] + self.lost[0]), 0.5 * (self.stable[1] + self.lost[1])


@dataclass(frozen=True, order=True)
class Cell:
    """The cell (i, j) of those that have been halved `level` times."""

    level: int
    i: int
    j: int


class Tracer:
    """Traces the boundary between stable and lost points of a lattice.

    `judge` returns True for each point that is stable. `verdicts` has every point that was judged.
    """

    def __init__(self, lattice: Lattice, judge: Judge) -> None:
        self.lattice = lattice
        self.verdicts: dict[Point, bool] = {}
        self._judge = judge
        side = lattice.cells << lattice.levels
        self._spacing = (lattice.size[0] // side, lattice.size[1] // side)
        self._side = side

    def trace(self) -> list[list[Crossing]]:
        """Trace the boundary.

        Returns:
            The boundary's lines, each in order; a closed line ends at its first crossing. The list
            is empty where all verdicts are the same.
        """
        cells = self._refine()
        lines = contourpy.contour_generator(z=self._filled(cells)).lines(0.5)
        edges = [[self._edge(x, y) for x, y in np.asarray(line)] for line in lines]
        found = self._bisect({edge for line in edges for edge in line})
        return [[found[edge] for edge in line] for line in edges]

    def _judge_new(self, points: Iterable[Point]) -> None:
        new = sorted(set(points) - self.verdicts.keys())
        self.verdicts.update(zip(new, self._judge(new)))

    def _refine(self) -> set[Cell]:
        """Halve every cell on whose border verdicts differ, down to the finest level.

        Hanging points (corners of smaller neighbours) count as points of the border.
        """
        n = self.lattice.cells
        cells = {Cell(0, i, j) for i, j in product(range(n), repeat=2)}
        self._judge_new(corner for cell in cells for corner in self._border(cell, 1))
        while True:
            mixed = [
                cell for cell in cells if cell.level < self.lattice.levels and self._differ(cell)
            ]
            if not mixed:
                return cells
            cells.difference_update(mixed)
            halves = [
                Cell(c.level + 1, 2 * c.i + a, 2 * c.j + b)
                for c in mixed
                for a, b in product((0, 1), repeat=2)
            ]
            cells.update(halves)
            self._judge_new(corner for cell in halves for corner in self._border(cell, 1))

    def _border(self, cell: Cell, parts: int) -> Iterable[Point]:
        """Points on the cell's border, `parts` to an edge."""
        step = self.lattice.steps[0] >> cell.level, self.lattice.steps[1] >> cell.level
        for k, m in product(range(parts + 1), repeat=2):
            if k in (0, parts) or m in (0, parts):
                yield (
                    cell.i * step[0] + k * step[0] // parts,
                    cell.j * step[1] + m * step[1] // parts,
                )

    def _differ(self, cell: Cell) -> bool:
        parts = 1 << (self.lattice.levels - cell.level)
        return len({self.verdicts[p] for p in self._border(cell, parts) if p in self.verdicts}) > 1

    def _filled(self, cells: set[Cell]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """1 stable, 0 lost at every corner of the finest cells.

        The whole of a larger cell has the verdict of its border.
        """
        z = np.zeros((self._side + 1, self._side + 1))
        for cell in sorted(cells):
            width = 1 << (self.lattice.levels - cell.level)
            i, j = cell.i * width, cell.j * width
            z[j : j + width + 1, i : i + width + 1] = self.verdicts[
                i * self._spacing[0], j * self._spacing[1]
            ]
        for (x, y), stable in self.verdicts.items():
            z[y // self._spacing[1], x // self._spacing[0]] = stable
        return z

    def _edge(self, x: float, y: float) -> Crossing:
        """The edge of a finest cell in whose middle a line of contourpy's crosses it."""
        a, b = (
            (int(way(x)) * self._spacing[0], int(way(y)) * self._spacing[1])
            for way in (np.floor, np.ceil)
        )
        return Crossing(a, b) if self.verdicts[a] else Crossing(b, a)

    def _bisect(self, edges: set[Crossing]) -> dict[Crossing, Crossing]:
        """Each edge with the two neighbours on the fine lattice between which the boundary is."""
        narrowed = {edge: edge for edge in edges}
        while True:
            middles = {}
            for edge, now in narrowed.items():
                x, y = (now.stable[0] + now.lost[0]) // 2, (now.stable[1] + now.lost[1]) // 2
                if (x, y) not in (now.stable, now.lost):
                    middles[edge] = (x, y)
            if not middles:
                return narrowed
            self._judge_new(middles.values())
            for edge, middle in middles.items():
                now = narrowed[edge]
                narrowed[edge] = (
                    Crossing(middle, now.lost)
                    if self.verdicts[middle]
                    else Crossing(now.stable, middle)
                )
