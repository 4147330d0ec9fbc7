"""A landing that lasts until every damper has ended its first compression and rebound."""

from __future__ import annotations

from ..core import Phase
from ..history import History, joined
from ..landing import Landing
from .measures import leg_work
from .reading import RUN_AFTER_CONTACT
from .sensors import SAMPLING

# the shortest and the longest [s], and by how much a landing that is too short goes on
SHORTEST, LONGEST, LONGER = 1.0, 10.0, 1.5


def whole_strokes(landing: Landing) -> History:
    """The landing at 5 kHz until the end of every damper's first rebound.

    It lasts 1 s at least, 0.9 s from the first contact on, and 10 s at most.

    Raises:
        LandingError: As `Landing.run`.
    """
    until = max(SHORTEST, landing.parameters.drop.contact_time + RUN_AFTER_CONTACT + 0.1)
    history = landing.run(until, 1.0 / SAMPLING)
    while history.time[-1] < LONGEST and _is_stroking(history):
        until = min(LONGER * until, LONGEST)
        history = joined([history, landing.run(until, 1.0 / SAMPLING)])
    return history


def _is_stroking(history: History) -> bool:
    """Whether the landing is not decided and a damper has not ended its first rebound."""
    if history["status.phase"][-1] in (Phase.SETTLED, Phase.TOPPLED):
        return False
    work = leg_work(history)
    return len(work) < len(history.legs) or any(w.state != "complete" for w in work.values())
