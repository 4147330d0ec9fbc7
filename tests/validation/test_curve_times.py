"""Times of measured curves are in any unit by the heading; what no landing has is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import LandingError
from rlv_landing.validation.curves import read_curves

UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
STEPS = st.floats(1e-4, 5e-3)
TEN_YEARS = st.integers(1_500_000_000, 1_900_000_000)
same_folder = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def written(folder: Path, times: np.ndarray, heading: str) -> Path:
    path = folder / "curves.csv"
    rows = "".join(f"{t!r},{k % 7 - 3}\n" for k, t in enumerate(times.tolist()))
    path.write_text(f"{heading},body.pitch [deg]\n{rows}")
    return path


@same_folder
@given(STEPS, st.integers(20, 60), st.sampled_from(sorted(UNITS)))
def test_times_in_the_headings_unit_are_seconds(tmp_path, step, count, unit):
    times = step * np.arange(count)
    path = written(tmp_path, times * UNITS[unit], f"time [{unit}]")
    assert read_curves(path).time == approx(times, rel=1e-12)


@same_folder
@given(STEPS, st.sampled_from(["ms", "us", "ns"]))
def test_times_without_the_unit_in_the_heading_are_refused_with_it(tmp_path, step, unit):
    """A record of at least 0.3 s, as a landing's are."""
    times = step * np.arange(int(0.3 / step) + 2) * UNITS[unit]
    if step * UNITS[unit] <= 0.1 and times[-1] <= 60.0:
        return
    with pytest.raises(LandingError) as refused:
        read_curves(written(tmp_path, times, "time"))
    clock = "a stamp of a clock" in str(refused.value)
    assert clock or f"head the column time [{unit}]" in str(refused.value)
    assert len(str(refused.value)) < 300 + len(str(tmp_path))


@same_folder
@given(STEPS, TEN_YEARS, st.sampled_from(sorted(UNITS)), st.booleans())
def test_stamps_of_a_clock_are_refused_with_the_remedy(tmp_path, step, start, unit, named):
    """Whether the heading has the unit or not, and where rounding makes stamps equal."""
    times = np.round((start + step * np.arange(50)) * UNITS[unit])
    path = written(tmp_path, times, f"time [{unit}]" if named else "time")
    with pytest.raises(LandingError, match=r"a stamp of a clock; subtract the stamp of the first"):
        read_curves(path)


@pytest.mark.parametrize(
    ("times", "message"),
    [
        ([0.0, 0.1, 0.05, 0.2], "row 4: time = 0.05 s does not come after 0.1 s; sort the rows"),
        ([0.0, 0.1, 0.1, 0.2], "row 4: time = 0.1 s does not come after 0.1 s"),
        ([0.0, float("nan"), 0.1], "row 3: time = 'nan' is not a finite number"),
        ([0.0, 0.5, 1.0, 1.5], "a landing needs at most 0.1 s and 60 s"),
        ((0.05 * np.arange(2000)).tolist(), "spans 99.95 s"),
    ],
)
def test_times_that_no_landing_has_are_refused(tmp_path, times, message):
    path = written(tmp_path, np.array(times), "time")
    with pytest.raises(LandingError, match=message):
        read_curves(path)
