"""The stable side of an envelope's boundaries: its shade and its name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..quantities import shown
from ..studies.envelope.search import Envelope, Family
from .style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.tri import Triangulation

Array = NDArray[np.float64]
# how much a shade covers; where families' sides lie over each other it is darker
COVER = 0.13
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

    axes = (envelope.study.x, envelope.study.y)
    (x, y) = (np.linspace(a.low, a.high, TRIED) / shown(a.quantity)[1] for a in axes)
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
    found = {
        (x, y): 1.0 if landing.lost(study.criterion) else -1.0 for x, y, landing in family.landings
    }
    found |= {(c.x, c.y): 0.0 for line in family.lines for c in line}
    corners = np.array(list(found))
    spans = np.array([a.high - a.low for a in (study.x, study.y)])
    across, up = (corners / spans).T
    triangles = Triangulation(across, up).triangles
    x, y = (corners / [shown(a.quantity)[1] for a in (study.x, study.y)]).T
    return Triangulation(x, y, triangles), np.array(list(found.values()))
