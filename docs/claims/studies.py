"""Values that studies give: minutes."""

from __future__ import annotations

import importlib.util
from contextlib import redirect_stdout
from functools import lru_cache
from io import StringIO

from marks import ROOT, Value

from rlv_landing.studies.envelope.search import Envelope, envelope
from rlv_landing.studies.envelope.study import study_from
from rlv_landing.studies.toml_keys import read
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
    for compute in (envelope_landings, uniform_landings, times_fewer, tip_over_table)
}
