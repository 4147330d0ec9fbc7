"""One landing of an FMU through FMPy, as a history."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from pathlib import Path

import numpy as np

from rlv_landing.effort import check_duration
from rlv_landing.history import History
from rlv_landing.parameters import Parameters
from rlv_landing.sampling import sample_count

from .input_table import Setting, in_steps, sloped
from .peaks import known_extremes
from .runner import FmuRunner

# a step with all outputs takes at least so long [s]
SECONDS_PER_SAMPLE = 15e-6
# the longest step in which a linear load is constant, where it cannot have a rate [s]
LONGEST_STEP = 1e-3


def land_fmu(
    path: Path,
    parameters: Parameters,
    inputs: Sequence[Setting] = (),
    until: float = 1.0,
    every: float = 1e-3,
    progress: Callable[[float], object] | None = None,
) -> History:
    """Land an FMU; return its outputs every `every` [s], and its true peaks.

    The communication points are the samples, and the times at which inputs are set between them.
    Results do not depend on the samples. Linear loads on an FMU of FMI 3.0, which has no
    rates, are set at their means in steps of at most 1 ms.

    Args:
        path: The FMU.
        parameters: The vehicle, all of whose values are set.
        inputs: What is set, in the order of time.
        until: The end [s].
        every: The time between samples [s].
        progress: Called with the time reached [s].

    Raises:
        LandingError: A time is out of bounds, or the FMU does not load, or refuses with its reason.
    """
    names = parameters.interface.output_names
    count = sample_count(0.0, until, every, len(names), costs=(0.0, SECONDS_PER_SAMPLE))
    times = [k * every for k in range(count)]
    rows = np.empty((len(times), len(names)))
    with FmuRunner(path, dict(parameters.items())) as runner:
        settings = iter(inputs)
        if sloped(inputs) and not runner.takes_rates:
            step = every / ceil(every / LONGEST_STEP)
            check_duration(
                f"a landing until {until:g} s with loads in steps of {step:g} s",
                SECONDS_PER_SAMPLE * until / step,
                "land shorter, or sample more seldom",
            )
            settings = in_steps(inputs, step, until)
        waiting = next(settings, None)
        now = 0.0
        for row, time in zip(rows, times):
            while waiting and (waiting.time < time or waiting.time == time == 0.0):
                now = _advance_to(runner, now, waiting.time)
                runner.set_inputs(waiting.values, waiting.rates)
                waiting = next(settings, None)
            now = _advance_to(runner, now, time)
            row[:] = runner.values()
            if progress is not None:
                progress(time)
        found = {name.removeprefix("peak."): peak for name, peak in runner.peaks().items()}
    history = History(np.array(times), names, rows, parameters)
    history.extremes = known_extremes(found, history)
    return history


def _advance_to(runner: FmuRunner, now: float, time: float) -> float:
    if time > now:
        runner.advance(now, time)
    return max(now, time)
