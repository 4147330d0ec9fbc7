"""Settings of the node: numbers may be texts with a unit, as options may."""

from __future__ import annotations

import pytest

from rlv_landing import LandingError
from rlv_ros_bridge.node.settings import SETTINGS, check_setting, settings_of


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("step_size", "1 ms", 1e-3),
        ("step_size", "0.002", 2e-3),
        ("stop_time", "1 min", 60.0),
        ("wait_timeout", "0.5 h", 1800.0),
        ("input_timeout", "500 ms", 0.5),
        ("realtime_factor", "50 %", 0.5),
        ("step_count", "12", 12),
        ("publish_every.struts", "4", 4),
    ],
)
def test_numbers_are_taken_from_texts_with_units(name, text, value):
    found = check_setting(name, text)
    assert found == value
    assert type(found) is type(SETTINGS[name].default)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("step_size", "1 m", "step_size = '1 m' has the wrong unit; give it in s"),
        ("step_size", "fast", "step_size = 'fast' is not a number with a unit"),
        ("step_size", "1_0 ms", "a number has no underscores"),
        ("step_size", "5 s", r"step_size = 5 is outside \[1e-06, 1\]"),
        ("stop_time", "1e-400 s", "1e-400 is below the smallest number"),
        ("step_count", "1.5", "step_count = 1.5 is not a whole number"),
        ("realtime_factor", "nan", "realtime_factor = nan is outside"),
        ("clock", "true", "clock = 'true' is neither true nor false"),
    ],
)
def test_texts_that_are_no_such_number_are_refused(name, text, message):
    with pytest.raises(LandingError, match=message):
        check_setting(name, text)


@pytest.mark.parametrize("legs", [3, 4, 8])
def test_contacts_of_the_legs_that_a_vehicle_has_can_be_thinned_out(legs):
    names = settings_of(tuple(range(1, legs + 1)))
    thinned = [name for name in names if name.endswith("_contact")]
    assert thinned == [f"publish_every.leg_{leg}_contact" for leg in range(1, legs + 1)]
    assert {"publish_every.struts", "publish_every.clock", "record"} <= set(names)
