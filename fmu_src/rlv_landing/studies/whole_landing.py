"""A landing until its outcome is decided: at rest, toppled, or out of time."""

from __future__ import annotations

from array import array

import numpy as np

from ..history import History, joined
from ..landing import Landing
from .outcome import SETTLED, TOPPLED
from .replay import ReplayedHistory

CHECK_EVERY = 0.25
# the end [s after the first contact] of a landing that is not decided before
LATEST = 10.0


def whole_landing(
    landing: Landing, until: float, every: float = 1e-3, *, decided: bool = True
) -> ReplayedHistory:
    """Land from now until the vehicle is at rest, has toppled, or `until` [s].

    The state is checked every 0.25 s. The vehicle is at rest where `status.phase` is settled then.
    It has toppled where it was toppled at every sample of the last 0.25 s: one that is beyond its
    feet for a moment may still come back.

    Args:
        landing: The landing; its state moves on.
        until: The latest end [s].
        every: Time between samples [s].
        decided: Whether the landing may end before `until`.

    Raises:
        LandingError: As `Landing.run`.
    """
    states: list[tuple[float, array[float]]] = [(landing.time, landing.state())]

    def keep(_time: float) -> None:
        states.append((landing.time, landing.state()))

    if not decided:
        return ReplayedHistory(landing.run(until, every, keep), landing, states)
    samples = max(1, round(CHECK_EVERY / every))
    start, checks = landing.time, 0
    parts: list[History] = []
    while not parts or landing.time + 0.5 * every < until:
        checks += 1
        part = landing.run(min(start + checks * samples * every, until), every, keep)
        parts.append(part)
        phase = part["status.phase"]
        if phase[-1] == SETTLED or np.all(phase == TOPPLED):
            break
    return ReplayedHistory(joined(parts), landing, states)
