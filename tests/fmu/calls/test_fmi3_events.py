"""FMI 3.0: events are found where they are, steps end early, inputs are set within steps."""

from __future__ import annotations

from ctypes import byref, c_void_p
from typing import Any

import pytest
from fmu_instance import ERROR, OK

from rlv_landing import Landing
from rlv_landing.quantities import LEGS

END = 0.4


def marks(landing: Landing) -> tuple[Any, ...]:
    """What changes at an event."""
    stroke_max = landing.parameters.main_strut.stroke_max
    strokes = [landing.get(f"leg[{leg}].main_strut.stroke") for leg in LEGS]
    return (
        [landing.get(f"leg[{leg}].contact.penetration") > 0.0 for leg in LEGS],
        [(stroke > 1e-12) + (stroke > stroke_max) for stroke in strokes],
        landing.get("status.phase"),
    )


def events(instance, step: float = 1e-3) -> list[float]:
    """Land to END by early returns, handling events; return their times."""
    found, time = [], 0.0
    if instance.event_mode:
        assert instance.update_discrete_states() == OK
        instance.slave.enterStepMode()
    while time < END - 1e-12:
        goal = min((round(time / step - 1e-6) + 1) * step, END) if step < END else END
        goal = goal if goal > time + 1e-12 else goal + step
        status, event, early, last = instance.step(time, goal - time)
        assert status == OK
        assert event == (instance.event_mode and last < goal) or last == goal
        assert early == (last < goal)
        if early:
            found.append(last)
        if event:
            instance.slave.enterEventMode()
            assert instance.update_discrete_states() == OK
            instance.slave.enterStepMode()
        time = last
    return found


@pytest.fixture
def started(make3):
    """Makes an initialised instance with its wishes."""

    def instance(mode: str = "2-2", start: dict[str, float] | None = None, **wishes: Any) -> Any:
        made = make3(**wishes)
        made.event_mode = wishes.get("event_mode", False)
        made.slave.enterInitializationMode(startTime=0.0)
        made.slave.setString([made.vr["drop.mode"]], [mode])
        for name, value in (start or {}).items():
            made.set(name, value)
        made.slave.exitInitializationMode()
        return made

    return instance


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_an_event_is_found_within_a_nanosecond_of_where_it_is_and_none_is_missed(started, mode):
    found = events(started(mode, early_return=True, event_mode=True))
    landing, scanned = Landing(mode=mode), Landing(mode=mode)
    # the struts' stops give way by some micrometres in the free flight
    assert found[0] == pytest.approx(landing.parameters.drop.contact_time, abs=1e-4)
    for time in found:
        landing.advance_to(time - 1e-9)
        before = marks(landing)
        landing.advance_to(time)
        assert marks(landing) != before
    changes, last = 0, marks(scanned)
    for k in range(1, round(END / 2e-5) + 1):
        scanned.advance_to(k * 2e-5)
        changes, last = changes + (marks(scanned) != last), marks(scanned)
    assert len(found) == changes


def test_events_do_not_depend_on_the_communication_step_or_on_who_is_told(started):
    found = events(started(early_return=True, event_mode=True))
    assert len(found) >= 6
    for step in (0.1e-3, 7e-3, END):
        assert events(started(early_return=True), step) == pytest.approx(found, abs=1e-9)


def test_a_host_that_takes_no_early_return_is_told_of_events_at_the_end_of_its_step(started):
    instance, plain = started(event_mode=True), started()
    expected = {round(t * 1e3 + 0.5) for t in events(started(early_return=True))}
    instance.slave.enterStepMode()
    told = set()
    for k in range(round(END * 1e3)):
        status, event, early, last = instance.step(k * 1e-3, 1e-3)
        assert (status, early, last) == (OK, False, k * 1e-3 + 1e-3)
        assert plain.step(k * 1e-3, 1e-3) == (OK, False, False, last)
        if event:
            told.add(k + 1)
            instance.slave.enterEventMode()
            instance.slave.enterStepMode()
    assert told == expected
    assert instance.get("leg.main_strut.force") == plain.get("leg.main_strut.force")


def test_functions_of_the_other_mode_are_errors_and_change_nothing(started):
    plain, instance = started(), started(event_mode=True)
    assert plain.status("fmi3EnterEventMode") == ERROR
    assert "eventModeUsed is fmi3False" in plain.reason()
    assert plain.status("fmi3EnterStepMode") == ERROR
    assert plain.update_discrete_states() == ERROR
    assert instance.status("fmi3EnterEventMode") == ERROR
    assert "must not be called in event mode" in instance.reason()
    instance.slave.enterStepMode()
    assert instance.update_discrete_states() == ERROR
    assert "fmi3UpdateDiscreteStates must not be called in step mode" in instance.reason()
    assert instance.step(0.0, 1e-3)[0] == OK


def test_inputs_that_are_set_in_event_mode_act_from_the_event_on(started):
    instance, landing = started(event_mode=True, early_return=True), Landing()
    instance.slave.enterStepMode()
    *_, touchdown = instance.step(0.0, END)
    instance.slave.enterEventMode()
    instance.set("external.force_x", 200.0)
    instance.slave.enterStepMode()
    landing.advance_to(touchdown)
    landing.set_inputs({"external.force_x": 200.0})
    time = touchdown
    while time < 0.2:
        *_, time = instance.step(time, 0.2 - time)
        instance.slave.enterEventMode()
        instance.slave.enterStepMode()
    landing.advance_to(0.2)
    assert instance.get("body.vx") == pytest.approx([landing.get("body.vx")], rel=1e-9)


def test_a_state_at_an_event_goes_on_to_the_same_events(started):
    one, other = (started(event_mode=True, early_return=True) for _ in range(2))
    one.slave.enterStepMode()
    *_, time = one.step(0.0, END)
    assert other.restore(one.state()) == OK
    for instance in (one, other):
        instance.next = instance.step(time, END)
    assert one.next == other.next
    assert one.next[1:3] == (True, True)


def test_times_of_the_epoch_reach_the_end_through_all_events(started, make3):
    start = 1.7e9
    instance = make3(early_return=True)
    instance.start(start_time=start)
    time, returns = start, 0
    while time < start + END:
        status, _, early, time = instance.step(time, start + END - time)
        assert status == OK
        returns += early
    assert returns == len(events(started(early_return=True)))


LOADS = [300.0, -200.0, 100.0, 0.0, 500.0, -50.0, 20.0, 10.0, 400.0, 0.0]


def test_a_host_is_asked_for_inputs_every_millisecond_of_a_step(started):
    """What it sets acts as if it had made steps of 1 ms itself."""
    asked: list[float] = []

    def update(instance, time, set_requested, get_allowed, finished, can_return, *_):
        assert (set_requested, get_allowed, finished, can_return) == (True, True, True, False)
        asked.append(time)
        assert instance.get("time") == [time]
        instance.set("external.force_x", LOADS[round(time * 1e3) % 10])

    instance, plain = started(update=update), started()
    for step in range(20):
        for one in (instance, plain):
            one.set("external.force_x", LOADS[0])
        assert instance.step(step * 1e-2, 1e-2) == (OK, False, False, step * 1e-2 + 1e-2)
        for k in range(10):
            plain.set("external.force_x", LOADS[k])
            plain.steps(10 * step + k, 10 * step + k + 1)
    assert asked == pytest.approx([k * 1e-3 for k in range(200) if k % 10], abs=1e-12)
    for name in ("body.vx", "body.x", "leg.main_strut.force"):
        assert instance.get(name) == pytest.approx(plain.get(name), rel=1e-9, abs=1e-9)


def test_a_ground_that_moves_to_a_position_does_not_depend_on_the_parts_of_a_step(started):
    """It is there at the end of the host's step, whether that is left on the way or not."""
    made = [started(update=lambda *_: None), started(early_return=True), started()]
    for instance in made:
        for step in range(20):
            instance.set("ground.heave", 1e-3 * (step % 3))
            time = step * 1e-2
            while time < step * 1e-2 + 1e-2 - 1e-12:
                *_, time = instance.step(time, step * 1e-2 + 1e-2 - time)
    for name in ("body.y", "leg.footpad.y", "energy.work_ground"):
        expected = made[2].get(name)
        for instance in made[:2]:
            assert instance.get(name) == pytest.approx(expected, rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize(("wanted", "reached"), [(0.0042, 0.0042), (0.0, 0.003), (1.0, 0.01)])
def test_a_step_ends_where_the_host_asks_in_an_update(started, wanted, reached):
    def update(_, time, *rest):
        *_, can_return, request, request_time = rest
        assert can_return
        if time > 0.0025:
            request[0], request_time[0] = True, wanted

    instance = started(update=update, early_return=True)
    status, event, early, last = instance.step(0.0, 0.01)
    assert (status, event, early) == (OK, False, reached < 0.01)
    assert last == pytest.approx(reached, abs=1e-15)
    assert instance.step(last, 0.01 - last if early else 0.01)[0] == OK


def test_a_host_that_takes_no_early_return_cannot_ask_for_it(started):
    def update(_, __, *rest):
        rest[-2][0] = True

    assert started(update=update).step(0.0, 0.01) == (OK, False, False, 0.01)


def test_calls_that_an_update_may_not_make_are_errors(started):
    refused: list[str] = []

    def update(instance, time, *_):
        if time > 1.5e-3:
            return
        for function in ("Terminate", "Reset", "EnterEventMode", "EnterStepMode"):
            assert instance.status(f"fmi3{function}") == ERROR
            refused.append(instance.reason())
        assert instance.status("fmi3GetFMUState", byref(c_void_p())) == ERROR
        refused.append(instance.reason())
        assert instance.step(time, 1e-3)[0] == ERROR
        refused.append(instance.reason())
        instance.status("fmi3FreeInstance")
        refused.append(instance.reason())

    instance = started(update=update)
    assert instance.step(0.0, 0.01)[0] == OK
    assert len(refused) == 7
    assert all("must not be called in an intermediate update" in reason for reason in refused)


def test_a_bad_input_in_an_update_ends_the_step_as_an_error_that_says_where(started):
    def update(instance, time, *_):
        instance.set("external.force_x", float("nan") if time > 2.5e-3 else 0.0)

    instance = started(update=update)
    status, _, early, last = instance.step(0.0, 0.01)
    assert (status, early) == (ERROR, False)
    assert last == pytest.approx(3e-3)
    assert "external.force_x = nan" in instance.log[-2][1]
    assert "for that reason the step has ended at 0.003 s" in instance.reason()
    instance.set("external.force_x", 0.0)
    assert instance.step(last, 1e-3)[0] == OK
