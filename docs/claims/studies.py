"""Values that studies give: minutes."""

from __future__ import annotations

import importlib.util
from functools import lru_cache
from math import radians
from types import ModuleType

from directions import speed_by_direction, worst_direction
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
def tip_over() -> ModuleType:
    """The module `examples/tip_over.py`."""
    spec = importlib.util.spec_from_file_location("tip_over", EXAMPLES / "tip_over.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@lru_cache
def tip_over_rows(mode: str, inertia: str = "") -> tuple[tuple[str, ...], ...]:
    """The rows of `examples/tip_over.py`: its columns' texts; inertia [kg m2] or the preset's."""
    rows = tip_over().rows(mode, inertia=float(inertia) if inertia else None)
    return tuple(tuple(row.split()) for row in rows)


def tip_over_table() -> str:
    """The table of envelope.md."""
    lines = [f"| {' | '.join(COLUMNS)} |\n", f"|{'---|' * len(COLUMNS)}\n"]
    for row in (*tip_over_rows("2-2"), *tip_over_rows("1-2-1")):
        mode, height, _, slope, _, _, tilt, _, tilts, _, speed, _, speeds, _, *ratios = row
        mean, least, largest = (f"{float(r.rstrip(',')):.3f}" for r in ratios)
        lines.append(
            f"| {mode} | {height} m | {slope} deg | {tilt} to {tilts} deg "
            f"| {speed} to {speeds} m/s | {mean} | {least} | {largest} |\n"
        )
    return "\n" + "".join(lines)


def tip_over_deviation(what: str, which: str, mode: str, height: str, inertia: str = "") -> float:
    """A deviation of the model's critical speed from the block's, over rows of the table [%].

    `what` is mean or point, `which` least or largest, `height` the CG's above the feet [m] or all.
    """
    columns = {"mean": [-3], "point": [-2, -1]}[what]
    rows = [row for row in tip_over_rows(mode, inertia) if height in ("all", row[1])]
    found = [max(abs(float(row[column].rstrip(",")) - 1.0) for column in columns) for row in rows]
    return 100.0 * {"least": min, "largest": max}[which](found)


def swings(mode: str) -> float:
    """In how many swings the model topples to the block's side, or stays up as it does."""
    found = tip_over()
    return float(sum(found.swings_as_the_block(mode, *swing) for swing in found.SWINGS))


SLOW = {
    compute.__name__: Value(compute, slow=True)
    for compute in (
        envelope_landings,
        uniform_landings,
        times_fewer,
        tip_over_table,
        tip_over_deviation,
        swings,
        critical_speed,
        speed_by_direction,
        worst_direction,
    )
}
