"""The landings that every importer runs, and `Landing`'s numbers at its communication points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.parameters.table import parameters_of
from rlv_landing.quantities import OUTPUT_NAMES, OUTPUT_QUANTITIES


@dataclass(frozen=True)
class Job:
    """A landing with these parameters.

    The inputs are 0 up to the end of step `inputs_after`, and constant from there.
    """

    parameters: dict[str, float | str] = field(default_factory=dict)
    inputs: dict[str, float] = field(default_factory=dict)
    inputs_after: int = 50
    step: float = 1e-3
    steps: int = 1000

    def as_json(self, outputs: Sequence[str] = OUTPUT_NAMES) -> dict[str, object]:
        """The job for a host, as `hosts/job.py` describes it."""
        return {
            **asdict(self),
            "outputs": {q.name: q.kind for q in OUTPUT_QUANTITIES if q.name in outputs},
        }

    def expected(self, times: np.ndarray) -> np.ndarray:
        """`Landing`'s outputs, one row for each of `times` [s], the ends of the steps."""
        landing = Landing(Parameters().with_values(self.parameters))
        rows = []
        for k, time in enumerate(times, start=1):
            landing.advance_to(time)
            rows.append(landing.values())
            if k == self.inputs_after:
                landing.set_inputs(self.inputs)
        return np.array(rows)


def drop_of(mode: str) -> dict[str, float | str]:
    """The FMU's parameters of the drop test of `mode`, the string `drop.mode` among them."""
    return {
        name: value
        for name, value in load_preset("yue2022-figures", mode).items()
        if name.startswith("drop.") and name in parameters_of(mode)
    }


# heave and tilt are set in flight: the deck has moved before the first footpad touches it
LOADS_AND_DECK = {
    "external.force_x": 400.0,
    "external.moment": 30.0,
    "ground.heave": 0.005,
    "ground.tilt": 0.01,
}
SLIPPERY = Job({"ground.friction": 0.05, "vehicle.mass": 200.0}, LOADS_AND_DECK)
JOBS = {
    "2-2, slippery, loads, moved deck": SLIPPERY,
    "1-2-1, by a string": Job({**drop_of("1-2-1"), "ground.friction": 0.4}, LOADS_AND_DECK),
}


def assert_same(
    result: np.ndarray, job: Job, outputs: Sequence[str] = OUTPUT_NAMES, rounding: float = 0.0
) -> None:
    """`result` (time, outputs) is the job's landing within 1e-9 of each quantity's largest value.

    `rounding` is added for importers that write texts.
    """
    assert result.shape == (job.steps, 1 + len(outputs))
    assert np.allclose(result[:, 0], np.arange(1, job.steps + 1) * job.step, rtol=0.0, atol=1e-9)
    expected = dict(zip(OUTPUT_NAMES, job.expected(result[:, 0]).T))
    largest = {name: np.abs(values).max() for name, values in expected.items()}
    largest["energy.balance"] = largest["energy.kinetic"]  # what rounding leaves of energies
    for name, column in zip(outputs, result[:, 1:].T):
        assert np.abs(column - expected[name]).max() <= 1e-9 * largest[name] + rounding, name
