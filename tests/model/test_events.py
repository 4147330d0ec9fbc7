"""`Landing.advance_within_step`: events are found, and change nothing."""

from __future__ import annotations

import random

import pytest

from rlv_landing import Landing, LandingError, Parameters
from rlv_landing.events.search import turns

END = 0.6
# drops that bounce, slide, end at a stop, or topple
DROPS = (
    {},
    {"drop.mode": "1-2-1", "drop.tilt": 0.12},
    {"drop.vertical_velocity": -2.5, "main_strut.stroke_max": 0.03},
    {"drop.horizontal_velocity": 1.5, "ground.friction": 0.9},
)


def landing_of(drop: dict[str, object]) -> Landing:
    return Landing(Parameters().with_values(drop))


def events(landing: Landing, times: list[float]) -> list[float]:
    """Times of the events of a landing that is stepped to these times [s]."""
    found = []
    for time in times:
        while landing.advance_within_step(time, time, to_event=True):
            found.append(landing.time)
            if landing.time == time:
                break
        assert landing.time == time
    return found


@pytest.mark.parametrize("drop", DROPS)
def test_events_are_the_same_whatever_the_steps_and_change_no_digit(drop):
    draw = random.Random(7)
    whole, steps, plain = (landing_of(drop) for _ in range(3))
    found = events(whole, [END])
    assert len(found) > 2
    assert found == sorted(set(found))
    uneven = sorted(draw.uniform(0.0, END) for _ in range(300))
    assert events(steps, [*uneven, END]) == pytest.approx(found, abs=1e-9)
    plain.advance_to(END)
    assert whole.values() == steps.values() == plain.values()
    assert whole.statistics == plain.statistics
    assert whole.extremes() == plain.extremes()


def test_an_end_stop_that_is_reached_and_left_gives_two_events():
    landing = landing_of(DROPS[2])
    events(landing, [END])
    peak = landing.extremes()["leg[1].main_strut.stroke"]
    assert peak.maximum > 0.03
    again = landing_of(DROPS[2])
    found = events(again, [END])
    before = max(t for t in found if t < peak.maximum_time)
    after = min(t for t in found if t > peak.maximum_time)
    check = landing_of(DROPS[2])
    for time, sign in ((before, 1.0), (after, -1.0)):
        check.advance_to(time - 1e-6)
        assert sign * (check.get("leg[1].main_strut.stroke") - 0.03) < 0.0
        check.advance_to(time)
        assert sign * (check.get("leg[1].main_strut.stroke") - 0.03) > 0.0


def test_a_crossing_that_is_undone_within_a_step_is_seen_in_the_parabola_through_it():
    """Of distances (a - 1/4)^2 - depth from an edge, with a from 0 to 1 in the step."""

    def parts(depth: float) -> list[float]:
        first, amid, last = ((a - 0.25) ** 2 - depth for a in (0.0, 0.5, 1.0))
        phase = 1.0
        return turns([first, -first, phase], [amid, -amid, phase], [last, -last, phase])

    assert parts(0.01) == pytest.approx([0.25, 0.25])
    assert parts(-0.01) == []


def test_a_landing_that_rests_has_no_more_events():
    landing = Landing()
    landing.advance_to(30.0)
    assert not landing.advance_within_step(60.0, 60.0, to_event=True)
    assert landing.time == 60.0


def test_a_time_that_has_passed_is_refused():
    landing = Landing()
    landing.advance_to(0.1)
    with pytest.raises(LandingError, match="reset"):
        landing.advance_within_step(0.05, 0.2, to_event=True)
