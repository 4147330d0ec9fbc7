"""A damper's first compression and rebound, found in the curve of its stroke.

The curve alone decides, so that landings of any vehicle and duration, logs and measured curves are
read alike. (derived)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
State = Literal["not compressed", "in compression", "in rebound", "complete"]
STATES: tuple[State, ...] = get_args(State)
# a turn of the curve counts if the stroke then moves by this part of the largest before it; what
# turns below these parts of the largest of all is chatter of footpad, ground or sensor
TURN, CHATTER, NOISE = 0.10, 0.10, 0.05
# at rest: in the last quarter of its time the stroke moves by at most this part of the largest
STILL, LAST = 0.02, 0.25
# a damper is extended again where its stroke is below this part of the largest
EXTENDED = 0.01


@dataclass(frozen=True)
class FirstStroke:
    """The first compression and rebound, as far as the curve shows them.

    Attributes:
        state: `not compressed`; `in compression`: the curve ends before the damper has rebounded or
            come to rest; `in rebound`: it ends before the rebound has; `complete`.
        top: Index of the largest stroke of the compression; None before `in rebound`.
        end: Index of the smallest stroke of the rebound; None before `complete`.
    """

    state: State
    top: int | None = None
    end: int | None = None


def first_stroke(stroke: Array) -> FirstStroke:
    """The first compression and rebound in a curve that starts at the contact.

    The compression lasts to the largest stroke before the first real rebound: the first fall by
    more than a tenth of the largest stroke before it. A fall from below a tenth of the largest
    stroke of all, or by less than a twentieth of it, is chatter. The rebound lasts to the smallest
    stroke before the damper is compressed again by as much. A damper that comes to rest, or extends
    fully, has ended what it was in.

    Args:
        stroke: Stroke at even steps, positive in compression [m], (n,).
    """
    if not len(stroke) or not stroke.max() > 0.0:
        return FirstStroke("not compressed")
    largest = float(stroke.max())
    before = np.maximum.accumulate(stroke)
    fallen = (before - stroke > np.maximum(TURN * before, NOISE * largest)) & (
        before > CHATTER * largest
    )
    turned = _first(fallen)
    if turned is None and not is_still(stroke, largest):
        return FirstStroke("in compression")
    top = int(np.argmax(stroke[:turned]))
    after, size = stroke[top:], float(stroke[top])
    risen = after - np.minimum.accumulate(after) > max(TURN * size, NOISE * largest)
    again = _first(risen)
    low = int(np.argmin(after[:again]))
    rests = turned is None or is_still(after, size)
    if again is None and not rests and after[low] > EXTENDED * size:
        return FirstStroke("in rebound", top)
    return FirstStroke("complete", top, top + low)


def _first(found: NDArray[np.bool_]) -> int | None:
    i = int(np.argmax(found))
    return i if found[i] else None


def is_still(stroke: Array, largest: float) -> bool:
    """Whether the curve ends at rest.

    In the last quarter of its time it moves by at most 2 % of the largest stroke.

    Args:
        stroke: Stroke at even steps [m], (n,), n above 0.
        largest: The largest stroke [m].
    """
    last = stroke[int((1.0 - LAST) * (len(stroke) - 1)) :]
    return len(stroke) > 1 and float(np.ptp(last)) <= STILL * largest
