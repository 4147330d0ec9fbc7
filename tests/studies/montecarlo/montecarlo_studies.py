"""Short Monte Carlo studies for tests: what they are about is what happens around the landings."""

from __future__ import annotations

from pathlib import Path

STUDY = """
[montecarlo]
mode = "space"
samples = {samples}
seed = 5
until = 0.06
rtol = 1e-3
{more}
[set]
drop.contact_time = 0.0
drop.pitch_rate = 0.0
[[factor]]
name = "drop.heading"
unit = "deg"
low = -180.0
high = 180.0
[covariance]
names = ["drop.tilt", "drop.roll", "drop.vertical_velocity"]
units = ["deg", "deg", "m/s"]
mean = [0.0, 0.0, -1.4]
deviation = [1.0, 1.5, 0.2]
correlation = [[1.0, 0.0, 0.3], [0.0, 1.0, 0.0], [0.3, 0.0, 1.0]]
{tables}
"""


def write(folder: Path, samples: int = 12, more: str = "", tables: str = "") -> Path:
    """A study in `folder`."""
    path = folder / "study.toml"
    path.write_text(STUDY.format(samples=samples, more=more, tables=tables))
    return path
