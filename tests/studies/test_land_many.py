"""`land_many`: a batch of landings in threads gives what each landing gives by itself."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from interrupting import interrupted_after

from rlv_landing import Landing, LandingError, Parameters, land_many

SPACE = Parameters().for_mode("space").with_values({"drop.contact_time": 0.0})
STATES = {
    "drop.heading [deg]": [0.0, 20.0, -30.0, 45.0, 10.0],
    "drop.roll": [0.0, 0.02, -0.01, 0.0, 0.03],
    "drop.lateral_velocity": [0.1, -0.2, 0.3, 0.0, 0.2],
    "external.moment_y": [0.0, 10.0, 0.0, -20.0, 5.0],
}


@pytest.mark.parametrize("mode", ["space", "2-2"])
def test_a_batch_has_the_peaks_of_each_landing_on_any_threads(mode):
    base = SPACE if mode == "space" else Parameters().for_mode(mode)
    tilts = np.radians([-3.0, 0.0, 2.0, 4.0, 5.0, -1.0, 1.0, 3.0, -2.0])
    found = [
        land_many(base, {"drop.tilt": tilts}, until=0.2, workers=workers) for workers in (1, 2, 3)
    ]
    for name in found[0]:
        for other in found[1:]:
            np.testing.assert_array_equal(found[0][name], other[name])
    for tilt, least in zip(tilts, found[0]["legs.main_strut.force.min"]):
        landing = Landing(base.with_values({"drop.tilt": float(tilt)}), rtol=1e-4)
        landing.advance_to(0.2)
        extremes = landing.extremes()
        own = min(extremes[f"leg[{leg}].main_strut.force"].minimum for leg in (1, 2, 3, 4))
        assert least == pytest.approx(own, rel=1e-9)


def test_states_are_columns_rows_or_a_frame_in_any_unit():
    rows = [dict(zip(STATES, values)) for values in zip(*STATES.values())]
    found = [land_many(SPACE, s, until=0.05) for s in (STATES, rows, pd.DataFrame(STATES))]
    for name in found[0]:
        for other in found[1:]:
            np.testing.assert_array_equal(found[0][name], other[name])
    frame = found[0].to_pandas()
    assert len(frame) == 5
    assert frame.attrs["units"]["margin.slid"] == "m"
    assert frame["error"].isna().all()


def test_a_landing_that_cannot_be_made_is_a_row_with_its_error():
    bad = {"drop.roll": [0.01, float("nan"), 0.02, 9.0], "drop.tilt": [0.0, 0.0, "much", 0.0]}
    found = land_many(SPACE, bad, until=0.05)
    assert found.errors[0] is None
    for error, words in zip(found.errors[1:], ("drop.roll = nan", "'much'", "drop.roll = 9 rad")):
        assert error is not None
        assert words in error
    assert np.isnan(found["margin.slid"][1:]).all()
    assert found["outcome"].tolist()[1:] == [None] * 3
    assert np.isfinite(found["margin.slid"][0])


@pytest.mark.parametrize(
    ("states", "options", "message"),
    [
        ({"drop.rol": [0.0]}, {}, "did you mean drop.roll?"),
        ({"drop.roll [m]": [0.0]}, {}, "wrong unit"),
        ({"drop.roll": [0.0], "drop.tilt": [0.0, 1.0]}, {}, "1 values of drop.roll and 2 of"),
        ([{"drop.roll": 0.0}, {"drop.tilt": 0.0}], {}, "do not have the same names"),
        ({"drop.mode": ["2-2"]}, {}, "drop.mode is the same for all states"),
        ({"external.moment": [0.0]}, {}, "needs drop.mode = 2-2 or 1-2-1"),
        ({"drop.roll": [0.0], "drop.roll [deg]": [0.0]}, {}, "two columns of drop.roll"),
        ({"drop.roll": [0.0]}, {"responses": ["outcom"]}, "did you mean outcome?"),
        ({"drop.roll": [0.0]}, {"every": 0.2, "until": 0.1}, "no landing would have a second"),
        ({"drop.roll": [0.0]}, {"every": 0.0}, "every = 0 s is outside"),
        ({"drop.roll": [0.0]}, {"until": -1.0}, "until = -1 s is outside"),
        ({"drop.roll": [0.0]}, {"workers": 0}, "workers = 0 must be a whole number of 1"),
        ({"drop.roll": [0.0]}, {"limits": {"main_strut.forc": 1.0}}, "did you mean main_strut"),
    ],
)
def test_bad_input_is_one_clear_line(states, options, message):
    with pytest.raises(LandingError) as caught:
        land_many(SPACE, states, **options)
    assert message in str(caught.value)


def test_no_states_are_no_landings():
    assert len(land_many(SPACE, {"drop.roll": []})) == 0


def test_progress_counts_to_the_end_and_ctrl_c_ends_a_batch():
    seen: list[int] = []
    land_many(SPACE, {"drop.roll": [0.0] * 20}, until=0.02, progress=seen.append)
    assert seen[-1] == 20
    assert seen == sorted(seen)
    interrupted_after(
        0.2, lambda: land_many(SPACE, {"drop.roll": [0.0] * 100_000}, until=0.5, workers=1)
    )


@pytest.mark.parametrize(
    ("states", "told"),
    [
        (None, "the states are a NoneType; give columns by name"),
        ([1, 2], "the states are no mappings"),
        ("states.csv", "the states are no mappings"),
        ({"drop.tilt": 0.1}, "drop.tilt = 0.1 is one value"),
        ({"drop.tilt": np.array(0.1)}, "is one value"),
    ],
)
def test_what_is_no_states_is_refused(states, told):
    with pytest.raises(LandingError, match=told):
        land_many(Parameters(), states, until=0.01)


def test_what_is_no_number_is_the_error_of_its_row():
    given = [True, 1j, [0.1], None, "a", float("nan"), 0.1]
    found = land_many(Parameters(), {"drop.tilt": given}, until=0.01, every=1e-2)
    assert [error is None for error in found.errors] == [False] * 6 + [True]


@pytest.mark.parametrize("workers", [float("nan"), 1.5, True, 0, "2"])
def test_workers_are_a_whole_number(workers):
    with pytest.raises(LandingError, match=r"workers = .* must be a whole number of 1 or more"):
        land_many(Parameters(), {"drop.tilt": [0.1]}, until=0.01, workers=workers)
