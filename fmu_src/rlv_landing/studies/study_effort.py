"""The memory and time that the landings of a study, and its Sobol indices, take at least.

What this machine does not have is refused before the first landing, see `rlv_landing.effort`.
"""

from __future__ import annotations

from ..audit.rest import LONGEST_WAIT
from ..effort import SECONDS_PER_SAMPLE, SECONDS_PER_SECOND, check_duration, check_memory
from ..quantities import OUTPUT_NAMES
from ..workers import default_workers
from .whole_landing import CHECK_EVERY, most_samples

# a sample is there twice: as the integrator's row, and in the columns of the history
BYTES_PER_SAMPLE = 16.0 * len(OUTPUT_NAMES)
# an estimate of the indices of one resample: the call, and each value in it
SECONDS_PER_RESAMPLE, SECONDS_PER_VALUE = 5e-4, 5e-8
# a value of a response: in the table, in its pages, and in one resample of them with its products
BYTES_PER_VALUE = 32.0


def check_landings(
    count: int,
    workers: int,
    until: float | None,
    every: float,
    *,
    decided: bool,
    timed: bool = True,
) -> None:
    """Refuse landings that this machine has not the memory or the time for.

    Args:
        count: The number of landings, the least where it is not known.
        workers: How many of them are made at once.
        until: The end of each [s], the latest where it may be `decided`; None: 60 s.
        every: Time between samples [s].
        decided: Whether a landing ends where its outcome is decided, 0.25 s from its start on.
        timed: Whether the time is known; that on a cluster is not.

    Raises:
        LandingError: They need too much.
    """
    samples = most_samples(until, every, decided=decided)
    until = LONGEST_WAIT if until is None else until
    at_once = min(workers, count)
    end = f"until {until:g} s at most" if decided else f"until = {until:g} s"
    what = f"{end}, every = {every:g} s"
    remedy = "land shorter, sample more seldom, or make fewer landings"
    check_memory(
        f"{what}, {at_once} landings at once,",
        BYTES_PER_SAMPLE * samples * at_once,
        f"{remedy} at once (--workers)",
        at_most=decided,
    )
    if timed:
        shortest = min(until, CHECK_EVERY) if decided else until
        each = (SECONDS_PER_SECOND + SECONDS_PER_SAMPLE / every) * shortest
        cores = min(at_once, default_workers())
        check_duration(f"{count} landings, {what},", each * count / cores, remedy)


def check_indices(samples: int, factors: int, responses: int, resamples: int) -> None:
    """Refuse Sobol indices that this machine has not the memory or the time for.

    Args:
        samples: The samples.
        factors: The factors.
        responses: The responses.
        resamples: The bootstrap resamples.

    Raises:
        LandingError: They need too much.
    """
    values = (factors + 2.0) * responses * samples
    what = f"indices of {responses} responses and {factors} factors by {samples} samples"
    check_memory(what, BYTES_PER_VALUE * values, "take fewer samples, or name fewer responses")
    check_duration(
        f"{resamples} resamples of {what}",
        resamples * (SECONDS_PER_RESAMPLE + SECONDS_PER_VALUE * values),
        "take fewer --resamples or samples, or name fewer responses",
    )
