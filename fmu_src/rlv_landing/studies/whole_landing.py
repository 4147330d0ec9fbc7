"""A landing until its outcome is decided: at rest, toppled, or out of time."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from ..audit.rest import LONGEST_WAIT, REST_AFTER
from ..errors import LandingError
from ..landing import Landing
from ..outputs import layout_of
from ..sampling import Samples
from .outcome import SETTLED, TOPPLED
from .replay import ReplayedHistory
from .standing import Standing, may_stand

Array = NDArray[np.float64]
CHECK_EVERY = 0.25
# time between samples [s], at least, of what still rocks at REST_AFTER from its first contact
LATER_EVERY = 1e-2


def whole_landing(
    landing: Landing,
    until: float | None = None,
    every: float = 1e-3,
    *,
    decided: bool = True,
    progress: Callable[[float], object] | None = None,
    standing: bool = False,
) -> ReplayedHistory:
    """Land from now until the vehicle is at rest, has toppled, or `until` [s].

    The state is checked every 0.25 s. The vehicle is at rest where `status.phase` is settled then;
    at sea, where it has been so for one period of the waves' peak.
    It has toppled where it was toppled at every sample of the last 0.25 s: one that is beyond its
    feet for a moment may still come back. What is not decided 10 s after its first contact, such as
    a heavy vehicle that rocks, is sampled every 10 ms from then on, or every `every` [s] if that is
    longer, so that the samples of 60 s have little more memory than those of 10 s.

    Args:
        landing: The landing; its state moves on.
        until: The latest end [s]; None: 60 s after the first contact, as long as `audit` waits.
        every: Time between samples [s].
        decided: Whether the landing may end before `until`.
        progress: Called with the time reached [s] on the way.
        standing: Whether it may end where the vehicle stands, see `standing.Standing`: before it is
            at rest, where nothing but the ground at rest acts on it.

    Raises:
        LandingError: As `Landing.run`.
    """
    states: list[tuple[float, array[float]]] = [(landing.time, landing.state())]

    def keep(_time: float) -> None:
        states.append((landing.time, landing.state()))
        if progress is not None:
            progress(landing.time)

    contact = landing.parameters.drop.contact_time
    if until is None:
        until = contact + LONGEST_WAIT
    if not decided:
        return ReplayedHistory(landing.run(until, every, keep), landing, states)
    stands = Standing(landing).at_all if standing and may_stand(landing) else None
    with landing.span() as extremes:
        parts = list(_until_decided(landing, until, every, keep, stands))
        whole = landing.history(parts or [landing.samples(until, every, keep)])
        whole.extremes = extremes()
    stood = stands is not None and bool(parts) and stands(parts[-1].rows)
    return ReplayedHistory(
        whole, landing, states, stands_from=len(whole) - len(parts[-1].rows) if stood else None
    )


def check_samples(every: float, until: float | None) -> None:
    """Check that a landing until `until` [s] has two samples that are `every` [s] apart.

    Raises:
        LandingError: It has one, at its start.
    """
    longest = LONGEST_WAIT if until is None else until
    if every > longest:
        raise LandingError(
            f"every = {every:g} s is above until = {longest:g} s; "
            "no landing would have a second sample"
        )


def most_samples(until: float | None, every: float, *, decided: bool) -> float:
    """The number of samples of a landing that is decided last, its first contact at its start."""
    if not decided and until is not None:
        return until / every
    end = LONGEST_WAIT if until is None else until
    later = max(0.0, end - REST_AFTER) / max(every, LATER_EVERY)
    return min(end, REST_AFTER) / every + later


def _until_decided(
    landing: Landing,
    until: float,
    every: float,
    keep: Callable[[float], object],
    stands: Callable[[Array], bool] | None,
) -> Iterator[Samples]:
    """The landing in parts, until it is decided or `until` [s]; see `whole_landing`."""
    layout = layout_of(landing.parameters.drop.mode, landing.interface.output_names)
    phase = layout.places["status.phase"][0]
    contact, calm = landing.parameters.drop.contact_time, _calm_time(landing)
    for end, step in ((min(until, contact + REST_AFTER), every), (until, max(every, LATER_EVERY))):
        for part in _checked(landing, end, step, keep):
            yield part
            told = part.rows[:, phase]
            if np.all(told == TOPPLED) or (stands is not None and stands(part.rows)):
                return
            if told[-1] == SETTLED and _settled_for(landing) >= calm:
                return


def _checked(
    landing: Landing, end: float, every: float, keep: Callable[[float], object]
) -> Iterator[Samples]:
    """The landing until `end` [s] in parts of 0.25 s, as far as whole intervals fit."""
    start, samples, checks = landing.time, max(1, round(CHECK_EVERY / every)), 0
    while end - landing.time > every * (1.0 - 1e-9):
        checks += 1
        yield landing.samples(min(start + checks * samples * every, end), every, keep)


def _calm_time(landing: Landing) -> float:
    """How long [s] a vehicle must have been settled to be at rest: through one wave of the peak."""
    sea = landing.parameters.sea
    return sea.peak_period if sea.wave_height > 0.0 else 0.0


def _settled_for(landing: Landing) -> float:
    """How long [s] the landing has been settled; below 0 where it is not."""
    since = landing.settled_since
    return -1.0 if since is None else landing.time - since
