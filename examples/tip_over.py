"""The tip-over of the vehicle with locked legs, by `envelope`'s bisection, beside the closed form
of a rigid block (docs/envelope.md).
"""

from __future__ import annotations

from math import degrees, radians

from rlv_landing import load_preset
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.envelope.tip_over import LOCKED, RigidBlock
from rlv_landing.workers import default_workers

RAISED = (-0.5, 0.0, 0.5)
SLOPES = (0.0, 5.0, 10.0)


def main() -> None:
    """Print a line for each mode, height of the CG and slope: critical speeds over tilts from 0.5
    to 8 deg steeper than the slope.
    """
    print(
        "mode   CG above feet  slope  points  tilt           critical speed   model/block: mean, least, largest"
    )
    for mode in ("2-2", "1-2-1"):
        preset = load_preset("yue2022-figures", mode)
        for raised in RAISED:
            joints = {
                f"{strut}.joint_depth": preset[f"{strut}.joint_depth"] + raised
                for strut in ("main_strut", "auxiliary_strut")
            }
            start = {"drop.pitch_rate": 0.0, "drop.vertical_velocity": -0.5}
            parameters = preset.with_values({**LOCKED, **joints, **start})
            for slope in SLOPES:
                tilt = Axis("drop.tilt", radians(slope + 0.5), radians(slope + 8.0), radians(0.25))
                speed = Axis("drop.horizontal_velocity", 0.5, 6.5, 0.02)
                study = EnvelopeStudy(
                    parameters.with_values({"ground.slope": radians(slope)}),
                    speed,
                    tilt,
                    cells=4,
                    levels=0,
                    until=5.0,
                )
                block = RigidBlock.of(parameters)
                points = [
                    c
                    for line in envelope(study, default_workers()).families[0].lines
                    for c in line
                ]
                ratios = [c.x / block.critical_speed(c.y, -0.5) for c in points]
                tilts, speeds = [degrees(c.y) for c in points], [c.x for c in points]
                print(
                    f"{mode:6s} {block.height:10.2f} m {slope:6.0f} deg {len(points):4d}  {min(tilts):4.1f} to {max(tilts):4.1f} deg"
                    f"  {min(speeds):.2f} to {max(speeds):.2f} m/s  {sum(ratios) / len(ratios):.4f}, {min(ratios):.4f}, {max(ratios):.4f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
