"""The outcome of a landing: a name, its time, the margins, and the first limit passed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..core import Phase
from ..errors import LandingError
from ..history import History
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import SPACE, Quantity
from .limits import PassedLimit, first_limit_passed, time_passed
from .on_ground import counted_legs, crossed_edge, joint_clearance, lean, slip
from .replay import ReplayedHistory

Array = NDArray[np.float64]
Name = Literal["toppled", "body strike", "bottomed out", "slid", "moving", "standing", "settled"]
# the outcomes, the severest first
SEVERITY: tuple[Name, ...] = get_args(Name)
CLEARANCE = "body.clearance"
SETTLED, TOPPLED = float(Phase.SETTLED), float(Phase.TOPPLED)
# the paper does not print its footpads' diameter; a leg's spreading alone moves a footpad by some
# centimetres
DEFAULT_SLIDE = 0.3
SLIDE = Quantity(
    "m",
    "largest distance that a footpad may move without having slid",
    0.0,
    1e3,
    name="slide",
    default=DEFAULT_SLIDE,
)


@dataclass(frozen=True)
class Outcome:
    """The outcome of a landing.

    `name` is the severest that holds, in this order:

    - toppled: at the end the vehicle's CG is beyond the outermost footpad or the body has turned
      over (`status.phase` 3). A vehicle that was beyond its feet for a moment and came back has not
      toppled. `time` is the start of the last such period;
    - body strike: a point of the body (`vehicle.body_points`) has met the ground, first at `time`;
    - bottomed out: a damper's stroke has passed `main_strut.stroke_max`, where it meets its stop.
      `time` is that of the first damper;
    - slid: a footpad is further than the threshold from where it first touched. `time` is when it
      passes it, linear between samples;
    - moving: neither at rest nor lost at the end, which is `time`: run it longer;
    - standing: the landing ended before it was at rest, because the vehicle stood since `time`: see
      `standing.stands`. Only landings that were made to end so have it;
    - settled: at rest since `time`.

    `leg` is the first that bottomed out, whatever the name, else None. Of legs that are mirror
    images the lower number stands for both. The motion after toppling is meaningless and counts in
    the stability margins only. Times are those of samples; for a `ReplayedHistory` those of
    toppling, bottoming out and settling are exact.

    `margins` [m]: `stability_min` and `stability_end`, the smallest and the last
    `status.stability_margin`; `stroke_left` to the stop; `slid`, the farthest that a footpad lies
    at the end from its first contact, relative to the ground, which may move (the legs' spreading
    is in it); `joint_clearance`, the least height above the ground of the body's lowest leg joints,
    the lowest of the body that the model knows. The least margins are those of the landing, between
    its samples too.

    Of a vehicle that toppled in space, `direction` [rad], from inertial x towards z, is that across
    the edge of the footpads' polygon which its CG passed, and `edge` has the legs of that edge:
    "legs 1, 2". One that turned over with its CG between its feet has no edge, and the direction in
    which its axis leans.
    """

    name: Name
    time: float
    leg: int | None
    margins: Mapping[str, float]
    first_limit: PassedLimit | None
    edge: str | None = None
    direction: float | None = None


def outcome(
    history: History, limits: Mapping[str, float] | None = None, slide: float = DEFAULT_SLIDE
) -> Outcome:
    """The outcome of the landing `history`.

    Args:
        history: A landing's columns over time, with its parameters.
        limits: Limits by name in LIMITS [SI].
        slide: Largest distance that a footpad may move without having slid [m].

    Raises:
        LandingError: The history has no parameters, a limit is unknown, or a limit or `slide` is
            negative or NaN.
    """
    return judged(history, limits, slide)[0]


def judged(
    history: History, limits: Mapping[str, float] | None = None, slide: float = DEFAULT_SLIDE
) -> tuple[Outcome, History]:
    """The outcome as `outcome` gives it, and the landing until it toppled, if it did."""
    if history.parameters is None:
        raise LandingError(
            "this history does not know its parameters; give one that Landing.run returned"
        )
    if not slide >= 0.0:
        raise LandingError(f"slide = {slide:g} m must be 0 m or more")
    p = history.parameters
    legs = counted_legs(p)
    phase, margin = history["status.phase"], history["status.stability_margin"]
    least_margin = history.extreme("status.stability_margin").minimum
    toppled = bool(phase[-1] == TOPPLED)
    end = float(history.time[-1])
    if toppled:
        end, history = _until_toppled(history)
    stops = {leg: stop_of(p, leg) for leg in legs}
    left = {leg: stops[leg] - history.extreme(_stroke(leg)).maximum for leg in legs}
    slips = [slip(history, leg) for leg in legs]
    bottomed = sorted(
        (time_passed(history, _stroke(leg), stops[leg]), leg) for leg, s in left.items() if s < 0.0
    )
    margins = {
        "stability_min": least_margin,
        "stability_end": float(margin[-1]),
        "stroke_left": min(left.values()),
        "slid": max((float(s[-1]) for s in slips if len(s)), default=0.0),
        "joint_clearance": joint_clearance(history),
    }
    first_slide = min(_first_beyond(history.time, s, slide) for s in slips)
    name: Name
    if toppled:
        name, time = "toppled", end
    elif (struck := _strike(history)) is not None:
        name, time = "body strike", struck
    elif bottomed:
        name, time = "bottomed out", bottomed[0][0]
    elif first_slide < inf:
        name, time = "slid", first_slide
    elif phase[-1] == SETTLED:
        name, time = "settled", _settled_since(history)
    elif isinstance(history, ReplayedHistory) and history.stands_from is not None:
        name, time = "standing", float(history.time[history.stands_from])
    else:
        name, time = "moving", end
    leg = bottomed[0][1] if bottomed else None
    first_limit = first_limit_passed(history, legs, limits) if limits else None
    edge, direction = _over(history) if toppled and p.drop.mode == SPACE else (None, None)
    return Outcome(name, time, leg, margins, first_limit, edge, direction), history


def _over(history: History) -> tuple[str | None, float]:
    """The edge over which a vehicle toppled in space, if any, and the direction [rad]."""
    return crossed_edge(history) or (None, lean(history))


def _strike(history: History) -> float | None:
    """When a point of the body first met the ground [s]; None where none did."""
    assert history.parameters is not None
    if not history.parameters.vehicle.body_points or CLEARANCE not in history:
        return None
    if history.extreme(CLEARANCE).minimum >= 0.0:
        return None
    return time_passed(history, CLEARANCE, 0.0, below=True)


def stop_of(parameters: Parameters, leg: int) -> float:
    """The stroke at which a leg's main strut meets its stop [m]."""
    return parameters.of_leg(leg).main_strut.stroke_max


def _stroke(leg: int) -> str:
    """The output that is the stroke of a leg's damper."""
    return f"leg[{leg}].main_strut.stroke"


def _until_toppled(history: History) -> tuple[float, History]:
    """Time at which a landing toppled [s], and the landing until the sample at that time."""
    first = _first_of_last_period(history["status.phase"], TOPPLED)
    time = float(history.time[first])
    if not isinstance(history, ReplayedHistory) or first == 0:
        return time, history.until(first + 1)

    def toppled(landing: Landing) -> bool:
        return landing.get("status.phase") == TOPPLED

    time = history.first_time(toppled, float(history.time[first - 1]), time)
    return time, history.ending_at(time)


def _settled_since(history: History) -> float:
    """The time [s] from which on the phase is settled until the end; exact where it can be."""
    if isinstance(history, ReplayedHistory):
        since = history.settled_since()
        if since is not None:
            return since
    return float(history.time[_first_of_last_period(history["status.phase"], SETTLED)])


def _first_beyond(time: Array, slip: Array, slide: float) -> float:
    """The time [s] at which a footpad has first slid by `slide`; infinite where it has not.

    It is linear between samples. `slip` ends with the last of the times.
    """
    if not len(slip) or not slip.max() > slide:
        return inf
    first = int(np.argmax(slip > slide))
    times = time[len(time) - len(slip) :]
    if not first:
        return float(times[0])
    return float(np.interp(slide, slip[first - 1 : first + 1], times[first - 1 : first + 1]))


def _first_of_last_period(phase: Array, which: float) -> int:
    """The index of the sample from which on the phase is `which` until the end."""
    other = np.flatnonzero(phase != which)
    return int(other[-1]) + 1 if len(other) else 0
