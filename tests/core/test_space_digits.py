"""The compiled core and the kernels as plain Python land in space with the same digits."""

import os
import subprocess
import sys

import pytest

from rlv_landing.core import COMPILED

# five legs that differ, points of the body, a height field on a slope, the CG off the legs' axis, a
# turned deck that moves in all directions, at sea, where a window ends; prints every bit
LAND = """
import sys
from rlv_landing import Landing, core, load_preset
assert core.COMPILED is (sys.argv[1] == "compiled")
values = {
    "drop.mode": "space", "vehicle.legs": 5, "drop.heading": 0.35, "drop.roll": 0.03,
    "drop.yaw_rate": 0.2, "drop.roll_rate": -0.1, "drop.lateral_velocity": 0.2,
    "drop.contact_time": 0.0, "ground.slope": 0.03, "ground.slope_direction": 0.7,
    "vehicle.transverse_load_at": sys.argv[2],
    "vehicle.body_points": "0.2 -2.12 0.1; -0.3 -2.12 0.0",
    "ground.terrain": "x -3 3 3 z -3 2 4 h 0 0.1 0 0.02 0 0.03 0 0 0.05 0.01 0 0",
    "leg[1].main_strut.kind": "spring-damper", "leg[2].ground.step": 0.01,
    "leg.kind": sys.argv[4],
    "sea.wave_height": 2.0, "sea.direction": 1.0, "sea.time": 0.4149, "sea.deck_y": 8.0,
}
landing = Landing(load_preset("yue2022-figures").with_values(values), "space", 1e-3, sys.argv[3])
landing.set_inputs(
    {"external.force_z": 90.0, "external.moment_x": 20.0, "ground.heave_rate": 0.1,
     "ground.tilt": 0.01, "ground.roll_rate": 0.05, "ground.yaw_rate": 0.1},
    {"ground.sway_rate": 0.3, "ground.tilt_rate": -0.2},
)
landing.advance_to(0.012 if sys.argv[4] == "radial" else 0.004)
system = landing._solver.system
relative = (system.relative_kinetic, system.relative_acceleration)
print(*(float(v).hex() for v in (*landing.state(), *landing.values(), *relative)), sep="\\n")
"""


def landed(core: str, at: str, method: str, kind: str) -> list[str]:
    """The numbers of a landing on the `core` of this name."""
    pure = {"RLV_LANDING_PURE": "1"} if core == "pure" else {}
    kept = {k: v for k, v in os.environ.items() if k != "RLV_LANDING_PURE"}
    run = subprocess.run(
        [sys.executable, "-c", LAND, core, at, method, kind],
        env={**kept, **pure}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return run.stdout.splitlines()


@pytest.mark.skipif(not COMPILED, reason="needs the compiled core")
@pytest.mark.parametrize(
    ("at", "method", "kind"),
    [
        ("footpad", "exponential", "radial"),
        ("joint", "dormand-prince", "radial"),
        ("footpad", "exponential", "tripod"),
    ],
)
def test_pure_and_compiled_land_in_space_with_the_same_digits(at, method, kind):
    compiled, pure = (landed(core, at, method, kind) for core in ("compiled", "pure"))
    assert len(compiled) > 200
    assert compiled == pure
