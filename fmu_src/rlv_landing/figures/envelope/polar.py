"""The polar chart of an envelope: speed over its direction, seen from above."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...quantities import shown
from ...studies.envelope.study import EnvelopeStudy
from ..style import FAINT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FROM_X = "direction from x (up) towards z"


def scales(study: EnvelopeStudy) -> tuple[float, float]:
    """Size in SI of the unit that each axis is drawn in; a polar chart's angle is in radians."""
    x, y = (shown(axis.quantity)[1] for axis in (study.x, study.y))
    return (1.0, y) if study.is_polar else (x, y)


def make_polar(ax: Axes, study: EnvelopeStudy) -> None:
    """Turn polar axes so that x is up and z to the right, as seen from above; speed from 0."""
    polar: Any = ax
    polar.set_theta_zero_location("N")
    polar.set_theta_direction(-1)
    polar.set_rlim(0.0, study.y.high / scales(study)[1])
    polar.set_rlabel_position(100.0)
    polar.grid(visible=True, linewidth=0.3, color=FAINT)
    unit = shown(study.y.quantity)[0]
    polar.set_xlabel(f"{study.y.name} [{unit}], {FROM_X}", fontsize="small")
