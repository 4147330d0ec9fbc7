"""Values that studies give: minutes."""

from __future__ import annotations

import importlib.util
from contextlib import redirect_stdout
from functools import lru_cache
from io import StringIO
from math import radians

from marks import ROOT, Value

from rlv_landing import Landing, load_preset
from rlv_landing.studies.envelope.search import Envelope, envelope
from rlv_landing.studies.envelope.study import study_from
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.toml_keys import read
from rlv_landing.studies.whole_landing import whole_landing
from rlv_landing.workers import default_workers

EXAMPLES = ROOT / "examples"
COLUMNS = (
    *("mode", "CG above the feet", "slope", "tilt", "critical speed"),
    *("model/block: mean", "least", "largest"),
)


@lru_cache
def example() -> Envelope:
    """The boundaries of `examples/envelope.toml`."""
    document, _ = read(EXAMPLES / "envelope.toml")
    return envelope(study_from(document, EXAMPLES), default_workers())


def topples(at: str, slope: float, tilt: float, speed: float) -> bool:
    """Whether the default vehicle topples in 2-2, friction 0.6, on `slope` and at `tilt` [rad]."""
    values = {
        "vehicle.transverse_load_at": at,
        "ground.friction": 0.6,
        "ground.slope": slope,
        "drop.tilt": tilt,
        "drop.pitch_rate": 0.0,
        "drop.contact_time": 0.0,
        "drop.horizontal_velocity": speed,
    }
    history = whole_landing(Landing(load_preset("yue2022-figures", "2-2").with_values(values)))
    return outcome(history, {}).name == "toppled"


def critical_speed(at: str, slope: str, tilt: str) -> float:
    """The horizontal speed from which on it topples, bisected to 0.01 m/s, angles in deg [m/s]."""
    low, high = 0.0, 6.0
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        lost = topples(at, radians(float(slope)), radians(float(tilt)), middle)
        low, high = (low, middle) if lost else (middle, high)
    return 0.5 * (low + high)


def envelope_landings() -> float:
    """The landings of `examples/envelope.toml`."""
    return float(example().landings)


def uniform_landings() -> float:
    """The landings of a uniform grid of the same resolution."""
    return float(example().uniform)


def times_fewer() -> float:
    """How many times more that is."""
    return uniform_landings() / envelope_landings()


@lru_cache
def tip_over_rows() -> tuple[tuple[str, ...], ...]:
    """The rows of `examples/tip_over.py`: its columns' texts."""
    path = EXAMPLES / "tip_over.py"
    spec = importlib.util.spec_from_file_location("tip_over", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    with redirect_stdout(StringIO()) as printed:
        module.main()
    return tuple(tuple(line.split()) for line in printed.getvalue().splitlines()[1:])


def tip_over_table() -> str:
    """The table of envelope.md."""
    lines = [f"| {' | '.join(COLUMNS)} |\n", f"|{'---|' * len(COLUMNS)}\n"]
    for row in tip_over_rows():
        mode, height, _, slope, _, _, tilt, _, tilts, _, speed, _, speeds, _, *ratios = row
        mean, least, largest = (f"{float(r.rstrip(',')):.3f}" for r in ratios)
        lines.append(
            f"| {mode} | {height} m | {slope} deg | {tilt} to {tilts} deg "
            f"| {speed} to {speeds} m/s | {mean} | {least} | {largest} |\n"
        )
    return "\n" + "".join(lines)


SLOW = {
    compute.__name__: Value(compute, slow=True)
    for compute in (
        envelope_landings,
        uniform_landings,
        times_fewer,
        tip_over_table,
        critical_speed,
    )
}
