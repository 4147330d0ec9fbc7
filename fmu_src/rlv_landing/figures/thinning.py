"""Fewer rows of a long landing for a picture, in which each curve keeps its peaks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from ..history import History
from .plots import ANY_LEGS, DRAWN_OF_A_LEG, TOP_ACCELERATION

# A landing of no more rows is drawn with all of them: a minute in steps of 1 ms.
MOST_ROWS = 60_000
# Spans of equal time into which a longer one is divided, as many as a picture has columns of
# pixels.
SPANS = 1000
# In each span the rows with the least and the largest value of these columns are kept, and its
# first row; of forces of contact also the first row that is not 0.
DRAWN = (
    *(f"leg[{leg}].{column}" for leg in ANY_LEGS for column, _, _ in DRAWN_OF_A_LEG),
    TOP_ACCELERATION[0],
    "body.pitch",
    "body.vx",
    "body.vy",
)
# Instants of a moving picture, each with the row that follows it.
INSTANTS = 10_000
CONTACTS = tuple(f"leg[{leg}].contact.force_y" for leg in ANY_LEGS)


def thinned(
    parts: Iterable[History],
    shown: tuple[float, float] | None = None,
    most: int = MOST_ROWS,
    spans: int = SPANS,
) -> History:
    """One history of all `parts`, which follow each other in time, of `most` rows and a part's.

    If there are more rows, only some of those in `spans` equal spans of time are kept. So memory
    is the same however long the landing is.

    Args:
        parts: At least one, all with the same columns.
        shown: First and last time of what a moving picture shows [s]: there are rows for each of
            10,000 instants between them.
        most: Rows from which on some are left out.
        spans: Spans of time.
    """
    return joined(_kept(parts, shown, most, spans))


def measured(parts: Iterable[History], most: int = MOST_ROWS, spans: int = SPANS) -> History:
    """One history of all `parts` for measures, of at most some three times `most` rows.

    Times, energies and peaks of the first compression and rebound need each row. So `most` rows
    from the first contact of a footpad on are kept; those before and behind as `thinned` does.

    Args:
        parts: At least one, all with the same columns.
        most: Rows from the first contact on that are kept.
        spans: As in `thinned`.
    """
    following = iter(parts)
    first_contact: list[History] = []

    def before() -> Iterator[History]:
        for part in following:
            if any((part[name] > 0.0).any() for name in CONTACTS if name in part):
                first_contact.append(part)
                return
            yield part

    def within() -> Iterator[History]:
        rows = 0
        for part in chain(first_contact, following):
            yield part
            rows += len(part)
            if rows >= most:
                return

    # One after the other, as they share the parts.
    found = _kept(before(), None, most, spans)
    found += within()
    found += _kept(following, None, most, spans)
    return joined(found)


def _kept(
    parts: Iterable[History], shown: tuple[float, float] | None, most: int, spans: int
) -> list[History]:
    """What `thinned` keeps of `parts`, of which there may be none."""
    kept: list[History] = []
    rows = 0
    for part in parts:
        kept.append(part)
        rows += len(part)
        if rows > most:
            kept = [_thin(joined(kept), shown, spans)]
            rows = len(kept[0])
    return kept


def joined(parts: list[History]) -> History:
    """One history of `parts`, which follow each other in time, without extremes."""
    first = parts[0]
    if len(parts) == 1:
        return first
    time = np.concatenate([p.time for p in parts])
    data = np.concatenate([p.data for p in parts])
    return History(time, first.names, data, first.parameters)


def _thin(history: History, shown: tuple[float, float] | None, spans: int) -> History:
    time = history.time
    edges = np.linspace(time[0], time[-1], spans + 1)[:-1]
    starts = np.unique(np.searchsorted(time, edges))
    keep = np.zeros(len(time), dtype=bool)
    keep[starts] = keep[-1] = True
    if shown is not None:
        rows = np.searchsorted(time, np.linspace(*shown, INSTANTS))
        keep[rows[rows < len(time)]] = True
    span_of = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(time)))
    for name in (*DRAWN, *CONTACTS):
        if name in history:
            values = history[name]
            for extreme in (np.minimum, np.maximum):
                keep[_first(values == extreme.reduceat(values, starts)[span_of], span_of)] = True
    for name in CONTACTS:
        if name in history:
            keep[_first(history[name] > 0.0, span_of)] = True
    return History(time[keep], history.names, history.data[keep], history.parameters)


def _first(found: NDArray[np.bool_], span_of: NDArray[np.intp]) -> NDArray[np.intp]:
    """The first row of each span that is `found`."""
    rows = np.flatnonzero(found)
    return rows[np.unique(span_of[rows], return_index=True)[1]]
