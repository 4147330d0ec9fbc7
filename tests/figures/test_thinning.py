"""A long landing's picture: few rows, whatever its length, with the peaks of all of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rlv_landing.figures.thinning import CONTACTS, DRAWN, measured, thinned
from rlv_landing.history import History

NAMES = (*DRAWN, *CONTACTS)
MOST, SPANS, PART = 6000, 100, 100


def parts(count: int) -> Iterator[History]:
    """Parts of a history of random curves, whose contacts begin at random times."""
    random = np.random.default_rng(5)
    for k in range(count):
        time = (k * PART + np.arange(PART)) * 1e-3
        data = random.normal(size=(PART, len(NAMES)))
        data[:, len(DRAWN) :] = (time > 3.5)[:, None] * np.abs(data[:, len(DRAWN) :])
        yield History(time, NAMES, data)


def test_a_short_landing_has_all_its_rows() -> None:
    whole = thinned(parts(40), most=MOST, spans=SPANS)
    assert np.array_equal(whole.time, np.arange(40 * PART) * 1e-3)
    assert np.array_equal(whole.data, np.concatenate([p.data for p in parts(40)]))


def test_a_long_one_keeps_its_peaks_ends_and_contacts_in_bounded_memory() -> None:
    whole = np.concatenate([p.data for p in parts(500)])
    seen = 0

    def watched() -> Iterator[History]:
        nonlocal seen
        for part in parts(500):
            seen += 1
            yield part

    found = thinned(watched(), most=MOST, spans=SPANS)
    assert seen == 500
    assert len(found) <= MOST + PART
    assert found.time[0] == 0.0
    assert found.time[-1] == (500 * PART - 1) * 1e-3
    assert np.all(np.diff(found.time) > 0.0)
    # every row is one of the landing
    rows = np.rint(found.time / 1e-3).astype(int)
    assert np.array_equal(found.data, whole[rows])
    for i, name in enumerate(NAMES):
        column = found[name]
        assert (column.min(), column.max()) == (whole[:, i].min(), whole[:, i].max()), name
    for name in CONTACTS:
        assert found.time[np.flatnonzero(found[name] > 0.0)[0]] == 3501 * 1e-3


def test_what_a_moving_picture_shows_has_a_row_for_each_instant() -> None:
    found = thinned(parts(500), shown=(20.0, 20.9), most=MOST, spans=SPANS)
    shown = found.time[(found.time >= 20.0) & (found.time <= 20.9)]
    assert len(shown) >= 900
    assert len(found) <= MOST + PART


def test_measures_have_every_row_from_the_first_contact_on_and_few_before_and_behind() -> None:
    whole = np.concatenate([p.data for p in parts(500)])
    found = measured(parts(500), most=MOST, spans=SPANS)
    rows = np.rint(found.time / 1e-3).astype(int)
    assert np.all(np.diff(rows) > 0)
    assert np.array_equal(found.data, whole[rows])
    assert (rows[0], rows[-1]) == (0, 500 * PART - 1)
    assert set(range(3501, 3501 + MOST - PART)) <= set(rows.tolist())
    assert len(found) <= 3 * (MOST + PART)
    for i, name in enumerate(NAMES):
        column = found[name]
        assert (column.min(), column.max()) == (whole[:, i].min(), whole[:, i].max()), name


def test_measures_of_a_short_landing_have_all_its_rows() -> None:
    found = measured(parts(40), most=MOST, spans=SPANS)
    assert np.array_equal(found.data, np.concatenate([p.data for p in parts(40)]))
