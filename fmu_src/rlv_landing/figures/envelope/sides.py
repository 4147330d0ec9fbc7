"""The stable side of an envelope's boundaries: its shade and its name."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...studies.envelope.search import Envelope, Family
from ..style import INK
from .polar import scales

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.tri import Triangulation

Array = NDArray[np.float64]
# how much a shade covers; where families' sides lie over each other it is darker
COVER = 0.13
# landings that are nearer to a boundary than so many tolerances say nothing beside it
NEAR = 1.5
# and than this part of the axis: the corners of coarse cells are not left out
NEAREST = 0.025
# points of a boundary's stretch between two critical points that this is judged by
BETWEEN = 9
# points along each axis that are tried for the name
TRIED = 41


def stable_word(envelope: Envelope) -> str:
    """What the side that is not lost is called."""
    return "stable" if envelope.study.criterion == "toppled" else "not lost"


def shade(ax: Axes, envelope: Envelope, family: Family, colour: str) -> None:
    """Shade what is not lost, between landings and up to the boundary."""
    mesh, values = _mesh(envelope, family)
    ax.tricontourf(mesh, values, levels=[-2.0, 0.0], colors=[colour], alpha=COVER)


def name_stable_side(ax: Axes, envelope: Envelope, families: Sequence[Family]) -> None:
    """Write the side's name where it is farthest from all boundaries, if there is such a place."""
    from matplotlib.tri import LinearTriInterpolator

    study = envelope.study
    axes = zip((study.x, study.y), scales(study))
    (x, y) = (np.linspace(a.low, a.high, TRIED) / size for a, size in axes)
    across, up = np.meshgrid(x, y)
    inside: Any = np.ones(across.shape, dtype=bool)
    for family in families:
        values = LinearTriInterpolator(*_mesh(envelope, family))(across, up)
        inside &= np.ma.filled(values, 1.0) < 0.0
    if not inside.any():
        return
    places = np.argwhere(inside)
    # a place is as good as it is far from what is not inside; beyond the axes nothing is
    around = np.argwhere(~np.pad(inside, 1)) - 1
    far = [np.square(around - place).sum(axis=1).min() for place in places]
    row, column = places[int(np.argmax(far))]
    ax.text(
        float(x[column]), float(y[row]), stable_word(envelope),
        ha="center", va="center", color=INK,
    )  # fmt: skip


def _mesh(envelope: Envelope, family: Family) -> tuple[Triangulation, Array]:
    """Triangles between landings and boundaries, and at each corner -1, 0 on a boundary, 1 lost."""
    from matplotlib.tri import Triangulation

    study = envelope.study
    critical = [(c.x, c.y) for line in family.lines for c in line]
    # a line from one critical point to the next may leave a landing beside it on its other side
    spans = np.array([a.high - a.low for a in (study.x, study.y)])
    tolerances = np.array([study.x.tolerance, study.y.tolerance])
    near = np.minimum(NEAR * tolerances, NEAREST * spans)
    around = _along(family)
    found = {
        (x, y): 1.0 if landing.lost(study.criterion) else -1.0
        for x, y, landing in family.landings
        if not (np.abs(around - (x, y)) < near).all(axis=1).any()
    }
    found |= dict.fromkeys(critical, 0.0)
    place = {point: i for i, point in enumerate(found)}
    ends = [[place[c.x, c.y] for c in line] for line in family.lines]
    drawn = {frozenset(pair) for line in ends for pair in pairwise(line)}
    corners, values = np.array(list(found)), np.array(list(found.values()))
    across, up = (corners / spans).T
    mesh = Triangulation(across, up)
    x, y = (corners / scales(study)).T
    flat = np.flatnonzero(~values[mesh.triangles].any(axis=1))
    mask = np.zeros(len(mesh.triangles), dtype=bool)
    mask[[t for t in flat if _side(mesh, values, drawn, int(t)) >= 0.0]] = True
    return Triangulation(x, y, mesh.triangles, mask), values


def _along(family: Family) -> Array:
    """Points along the boundaries, close to each other, (n, 2) [SI]."""
    parts = [
        np.linspace((a.x, a.y), (b.x, b.y), BETWEEN)
        for line in family.lines
        for a, b in pairwise(line)
    ]
    return np.concatenate([np.empty((0, 2)), *parts])


def _side(mesh: Triangulation, values: Array, drawn: set[frozenset[int]], start: int) -> float:
    """The side of a triangle between points of boundaries: below 0 if it is not lost.

    It is that of a triangle that is reached across no boundary.
    """
    seen, open_ends = {start}, [start]
    while open_ends:
        at = open_ends.pop()
        corners = mesh.triangles[at]
        for k, beyond in enumerate(map(int, mesh.neighbors[at])):
            crossed = frozenset(map(int, (corners[k], corners[(k + 1) % 3])))
            if beyond < 0 or beyond in seen or crossed in drawn:
                continue
            side = float(values[mesh.triangles[beyond]].sum())
            if side:
                return side
            seen.add(beyond)
            open_ends.append(beyond)
    return 0.0
