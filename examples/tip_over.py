"""The tip-over of the vehicle with locked legs beside the closed form of a rigid block.

The vehicle's critical speeds are found by the bisection of `envelope` (docs/envelope.md).
"""

from __future__ import annotations

from itertools import product
from math import degrees, radians

from rlv_landing import Parameters, load_preset
from rlv_landing.quantities import MODES
from rlv_landing.studies.envelope.judged_landing import judged_landing
from rlv_landing.studies.envelope.search import Critical, envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.envelope.tip_over import START, RigidBlock, locked_vehicle
from rlv_landing.workers import default_workers

# height of the CG above the preset's [m], slope [deg], velocity of the CG upward at contact [m/s]
RAISED = (-0.5, 0.0, 0.5)
SLOPES = (0.0, 5.0, 10.0)
SINK = START["drop.vertical_velocity"]
# slopes and tilts [rad] and horizontal speeds [m/s] with which a vehicle swings from foot to foot
SWINGS = [*product((-0.1, 0.0, 0.1), (-0.1, 0.0, 0.1), map(float, range(-5, 6)))]


def critical_points(parameters: Parameters, slope: float) -> list[Critical]:
    """The vehicle's critical speeds over tilts from 0.5 to 8 deg steeper than the slope [deg]."""
    tilt = Axis("drop.tilt", radians(slope + 0.5), radians(slope + 8.0), radians(0.25))
    speed = Axis("drop.horizontal_velocity", 0.5, 6.5, 0.02)
    on_slope = parameters.with_values({"ground.slope": radians(slope)})
    study = EnvelopeStudy(on_slope, speed, tilt, cells=4, levels=0, until=5.0)
    found = envelope(study, default_workers())
    return [point for line in found.families[0].lines for point in line]


def row(mode: str, block: RigidBlock, slope: float, points: list[Critical]) -> str:
    """A row of the table: tilts, speeds, and the ratio of the model's speed to the block's."""
    ratios = [c.x / block.critical_speed(c.y, SINK) for c in points]
    tilts, speeds = [degrees(c.y) for c in points], [c.x for c in points]
    return (
        f"{mode:6s} {block.height:10.2f} m {slope:6.0f} deg {len(points):4d}  "
        f"{min(tilts):4.1f} to {max(tilts):4.1f} deg  {min(speeds):.2f} to {max(speeds):.2f} m/s  "
        f"{sum(ratios) / len(ratios):.4f}, {min(ratios):.4f}, {max(ratios):.4f}"
    )


def rows(mode: str, *, inertia: float | None = None) -> list[str]:
    """The rows of a mode: a row for each height of the CG and slope."""
    found = []
    for raised in RAISED:
        depths = {
            f"{strut}__joint_depth": load_preset("yue2022-figures", mode)[f"{strut}.joint_depth"]
            + raised
            for strut in ("main_strut", "auxiliary_strut")
        }
        other = {} if inertia is None else {"vehicle__inertia": inertia}
        parameters = locked_vehicle(mode, **depths, **other)
        block = RigidBlock.of(parameters)
        found += [row(mode, block, slope, critical_points(parameters, slope)) for slope in SLOPES]
    return found


def swings_as_the_block(mode: str, slope: float, tilt: float, speed: float) -> bool:
    """Whether the vehicle topples to the block's side, or stays up as it does (rad, rad, m/s)."""
    parameters = locked_vehicle(mode, ground__slope=slope, drop__tilt=tilt)
    axes = (
        Axis("drop.horizontal_velocity", -50.0, 50.0, 1.0),
        Axis("drop.tilt", -1.5, 1.5, 0.1),
    )
    study = EnvelopeStudy(parameters, *axes, until=4.5)
    side = judged_landing(study, {"drop.horizontal_velocity": speed}).towards
    return side == RigidBlock.of(parameters).topples(tilt, slope, speed, SINK)


def main() -> None:
    """Print a row for each mode, height of the CG and slope, and the count of the swings."""
    print(
        "mode   CG above feet  slope  points  tilt           critical speed   "
        "model/block: mean, least, largest"
    )
    for mode in MODES:
        print(*rows(mode), sep="\n", flush=True)
    for mode in MODES:
        agreed = sum(swings_as_the_block(mode, *swing) for swing in SWINGS)
        print(f"{mode}: to the same side, or to none, in {agreed} of {len(SWINGS)} swings")


if __name__ == "__main__":
    main()
