"""What is found between samples, beside closed forms: turning points, works, first contacts."""

from __future__ import annotations

from math import cos, pi, sqrt

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing.history import History
from rlv_landing.validation.first_contact import first_contact
from rlv_landing.validation.measures import damper_work

MS = 1e-3
STIFFNESS, DAMPING, STROKE = 2e5, 1500.0, 0.02


@given(st.floats(20.0, 80.0), st.floats(0.1, 0.9))
def test_a_stroke_that_turns_between_samples_has_the_work_of_its_turn(rate, offset):
    """Force k s + c s' over stroke a sin(w t): k a^2/2 + pi c w a^2/4 up to the top.

    Back at stroke 0 the spring has given all back, and pi c w a^2/2 is lost.
    """
    time = (np.arange(round(3000 * pi / rate) // 2) + offset) * MS
    time = np.concatenate([[0.0], time[time > 0.0]])
    stroke = STROKE * np.sin(rate * time)
    speed = rate * STROKE * np.cos(rate * time)
    force = -(STIFFNESS * stroke + DAMPING * speed)
    found = damper_work(time, force, stroke, 0.0, speed)
    lost = 0.25 * pi * DAMPING * rate * STROKE**2
    assert found.top == approx(0.5 * pi / rate, abs=2e-6)
    assert found.stroke_max == approx(STROKE, rel=1e-6)
    assert found.absorbed == approx(0.5 * STIFFNESS * STROKE**2 + lost, rel=1e-3)
    assert found.end == approx(pi / rate, abs=2e-5)
    assert found.dissipated == approx(2.0 * lost, rel=4e-3, abs=1e-3)


@given(st.floats(0.2, 5.0), st.floats(-3.0, 3.0), st.floats(0.001, 0.1))
def test_a_first_contact_is_where_the_free_flight_meets_the_ground(sink, along, height):
    """A footpad that falls with v from h touches after (sqrt(v^2 + 2 g h) - v)/g."""
    time = np.arange(400) * MS
    contact = (sqrt(sink * sink + 2.0 * 9.81 * height) - sink) / 9.81
    depth = sink * time + 0.5 * 9.81 * time**2 - height
    # in the ground it is held back
    depth = np.where(depth > 0.0, 0.3 * depth, depth)
    names = [f"leg[1].{what}" for what in ("contact.force_y", "contact.penetration", "footpad.x")]
    place = np.where(time < contact, along * time, along * contact)
    columns = np.column_stack([np.where(depth > 0.0, 1e5 * depth, 0.0), depth, place])
    history = History(time, names, columns)
    found = first_contact(history, 1)
    if contact > time[-1]:
        assert found is None
        return
    assert found is not None
    if found.sample > 2:
        assert found.time == approx(contact, abs=1e-9)
        assert found.value(history, "leg[1].footpad.x") == approx(along * contact, abs=1e-9)
    else:
        assert abs(found.time - contact) <= MS


def test_a_foot_that_stands_from_the_start_touches_at_the_first_sample():
    names = ["leg[1].contact.force_y", "leg[1].contact.penetration"]
    columns = np.full((5, 2), 1e-3)
    columns[0, 0] = cos(1.0)
    standing = History(np.arange(5) * MS, names, columns)
    found = first_contact(standing, 1)
    assert found is not None
    assert (found.sample, found.time) == (0, 0.0)
    assert found.value(standing, names[0]) == cos(1.0)
