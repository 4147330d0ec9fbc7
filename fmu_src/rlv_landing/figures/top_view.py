"""The footpads' tracks seen from above, with the support polygon and the CG's path."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import ConvexHull

from ..history import History
from ..touchdown import each_leg
from .style import BODY, COLOURS, FAINT, INK, plain_axes
from .wireframe import Lines, contact_forces, wireframe

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# samples that are drawn at most
SAMPLES = 1000


def top_view(history: History, longest: float) -> Figure:
    """Tracks, polygon and path on the left, the stability margin over time on the right.

    A track is thick where the ground bears its footpad. The polygon is drawn at the start, faint,
    and at the end.

    Args:
        history: A landing in space, with its parameters.
        longest: The last time that is drawn, if the landing is as long [s].
    """
    from matplotlib.figure import Figure

    assert history.parameters is not None
    last = int(np.searchsorted(history.time, longest, side="right"))
    rows = np.unique(np.linspace(0, last - 1, min(last, SAMPLES)).astype(int))
    feet, center = seen_from_above(history, rows)
    borne = np.linalg.norm(contact_forces(history, history.parameters, rows), axis=-1) > 0.0
    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    above, beside = figure.subplots(1, 2, width_ratios=(1.0, 1.0))
    for i, colour in zip(range(feet.shape[1]), COLOURS):
        track = feet[:, i]
        above.plot(*track.T, color=colour, linewidth=0.8)
        pressed = np.where(borne[:, i, None], track, np.nan)
        above.plot(*pressed.T, color=colour, linewidth=3.0, label=f"leg {i + 1}")
        above.plot(*track[-1], "o", color=colour, markersize=5)
    _polygon(above, feet[0], FAINT, "--")
    _polygon(above, feet[-1], INK, "-")
    above.plot(*center.T, color=BODY, linewidth=1.2, label="CG")
    above.plot(*center[-1], "+", color=INK, markersize=10)
    above.set_aspect("equal", adjustable="datalim")
    above.set_xlabel("x [m]")
    above.set_ylabel("-z [m], to the left")
    above.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=5, frameon=False, fontsize=8
    )
    margin = history["status.stability_margin"]
    beside.plot(history.time[:last], margin[:last], color=INK, linewidth=1.5)
    beside.set_xlabel("time [s]")
    beside.set_ylabel("stability margin [m]")
    for ax in (above, beside):
        plain_axes(ax, zero=ax is beside)
    return figure


def seen_from_above(history: History, rows: Any) -> tuple[Lines, Lines]:
    """Footpads (rows, legs, 2) and the whole vehicle's CG (rows, 2) at `rows`: x and -z [m]."""
    parameters = history.parameters
    assert parameters is not None
    feet = wireframe(history, parameters, rows)["feet"][:, :, 0]
    body = np.column_stack([history[f"body.{axis}"][rows] for axis in "xyz"])
    masses = np.array([leg.vehicle.footpad_mass for leg in each_leg(parameters)])
    mass = parameters.vehicle.mass
    center = (mass * body + np.einsum("i,kij->kj", masses, feet)) / (mass + masses.sum())
    return feet[..., [0, 2]] * (1.0, -1.0), center[:, [0, 2]] * (1.0, -1.0)


def margin_of(feet: Lines, center: Lines) -> float:
    """Distance [m] of a `center` (2,) to the nearest edge of the footpads' (legs, 2) convex hull.

    It is negative outside of it.
    """
    return -float((ConvexHull(feet).equations @ [*center, 1.0]).max())


def _polygon(ax: Any, feet: Lines, colour: str, style: str) -> None:
    corners = feet[ConvexHull(feet).vertices]
    ax.plot(*np.concatenate([corners, corners[:1]]).T, style, color=colour, linewidth=1.0)
