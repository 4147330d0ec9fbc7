"""The geometry of a leg: where its struts meet body and footpad, and how far they move."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from .needs import Needs

# the main strut's joint above the auxiliary strut's, over the footpad's distance from the body
RISE = 0.8


class LegGeometry(NamedTuple):
    """A leg in its radial plane; radii and depths from the CG, downward positive.

    Attributes:
        footpad_radius: Distance of the footpad from the axis [m].
        footpad_depth: Depth of the footpad below the CG [m].
        joint_radius: Distance of both joints from the axis [m].
        main_depth: Depth of the main strut's joint [m].
        main_length: Length of the main strut, extended [m].
        auxiliary_depth: Depth of the auxiliary strut's joint [m].
        auxiliary_length: Length of the auxiliary strut [m].
        stroke_ratio: Shortening of the main strut over the way of the footpad upward, at full
            extension.
    """

    footpad_radius: float
    footpad_depth: float
    joint_radius: float
    main_depth: float
    main_length: float
    auxiliary_depth: float
    auxiliary_length: float
    stroke_ratio: float


def leg_geometry(needs: Needs) -> LegGeometry:
    """The legs that the `needs` ask for, auxiliary struts at the body's lower end.

    [derived] The auxiliary strut is taken as rigid: the footpad moves on a circle about its joint.
    With the unit vector t of that motion, t_y upward, and u from the main strut's joint to the
    footpad, the ratio is -t.u/t_y. By virtual work the main strut bears the footpad's vertical
    force over it.
    """
    radius = 0.5 * needs.span
    reach = radius - needs.body_radius
    auxiliary_depth = needs.cg_height - needs.clearance
    main_depth = auxiliary_depth - RISE * reach
    main = hypot(reach, needs.cg_height - main_depth)
    auxiliary = hypot(reach, needs.clearance)
    # from the joints to the footpad, outward and downward; the footpad goes outward and up
    across = needs.clearance / auxiliary
    up = reach / auxiliary
    along_main = reach / main * across - (needs.cg_height - main_depth) / main * up
    return LegGeometry(
        footpad_radius=radius,
        footpad_depth=needs.cg_height,
        joint_radius=needs.body_radius,
        main_depth=main_depth,
        main_length=main,
        auxiliary_depth=auxiliary_depth,
        auxiliary_length=auxiliary,
        stroke_ratio=-along_main / up,
    )
