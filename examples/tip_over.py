"""The tip-over of the vehicle with locked legs beside the closed form of a rigid block.

The vehicle's critical speeds are found by the bisection of `envelope` (docs/envelope.md).
"""

from __future__ import annotations

from math import degrees, radians

from rlv_landing import Parameters, load_preset
from rlv_landing.studies.envelope.search import Critical, envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.envelope.tip_over import LOCKED, RigidBlock
from rlv_landing.workers import default_workers

# height of the CG above the preset's [m], slope [deg], velocity of the CG upward at contact [m/s]
RAISED = (-0.5, 0.0, 0.5)
SLOPES = (0.0, 5.0, 10.0)
SINK = -0.5


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


def main() -> None:
    """Print a row for each mode, height of the CG and slope."""
    print(
        "mode   CG above feet  slope  points  tilt           critical speed   "
        "model/block: mean, least, largest"
    )
    for mode in ("2-2", "1-2-1"):
        preset = load_preset("yue2022-figures", mode)
        for raised in RAISED:
            joints = {
                f"{strut}.joint_depth": preset[f"{strut}.joint_depth"] + raised
                for strut in ("main_strut", "auxiliary_strut")
            }
            start = {"drop.pitch_rate": 0.0, "drop.vertical_velocity": SINK}
            parameters = preset.with_values({**LOCKED, **joints, **start})
            block = RigidBlock.of(parameters)
            for slope in SLOPES:
                print(row(mode, block, slope, critical_points(parameters, slope)), flush=True)


if __name__ == "__main__":
    main()
