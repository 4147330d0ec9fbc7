"""What the FMU does with calls that are wrong: a status, a reason in the log, and an instance that
goes on.
"""

from __future__ import annotations

import math
from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

import numpy as np
import pytest
from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from fmu_instance import DISCARD, ERROR, OK, Instance

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUT_NAMES, OUTPUT_QUANTITIES, STATISTIC_QUANTITIES

REAL, TEXT = "external.force_x", "drop.mode"


def refs(*numbers: int):
    return (c_uint * len(numbers))(*numbers)


def reals(*numbers: float):
    return (c_double * len(numbers))(*numbers)


def assert_lands_as_ever(instance: Instance, first: int = 0) -> None:
    """The instance, initialised and `first` ms on, goes on with `Landing`'s very numbers."""
    instance.steps(first, first + 20)
    landing = Landing()
    landing.advance_to((first + 19) * 1e-3 + 1e-3)
    vrs = [instance.vr[n] for n in ("body.x", "body.pitch", "leg[2].footpad.y")]
    assert instance.slave.getReal(vrs) == [
        landing.get(n) for n in ("body.x", "body.pitch", "leg[2].footpad.y")
    ]


# -- initialisation


BAD_PARAMETERS = [
    ("ground.friction", -1.0, "ground.friction = -1 is outside [0, 3]"),
    ("vehicle.mass", math.nan, "vehicle.mass = nan kg"),
    ("drop.contact_time", 0.9, "drop.contact_time = 0.9 s"),
    ("external.force_y", math.inf, "external.force_y = inf N"),
]


@pytest.mark.parametrize(("name", "value", "reason"), BAD_PARAMETERS)
def test_bad_start_value_is_an_error_with_its_reason_and_others_may_be_set_at_once(
    instance, name, value, reason
):
    good = instance.get(name)
    with pytest.raises(FMICallException, match="error"):
        instance.start(**{name: value})
    assert reason in instance.reason()
    assert instance.step(0.0, 1e-3) == ERROR
    assert "fmi2DoStep must not be called in initialization mode" in instance.reason()
    instance.set(name, good)
    instance.slave.exitInitializationMode()
    assert_lands_as_ever(instance)


def test_bad_text_is_an_error_that_names_the_choices(instance):
    instance.slave.enterInitializationMode()
    instance.slave.setString([instance.vr[TEXT]], ["2-3"])
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert "drop.mode" in instance.reason()
    assert "2-2" in instance.reason()


@pytest.mark.parametrize("then", ["reset", "terminate and free", "free"])
def test_after_a_bad_start_value_the_instance_may_be_reset_or_freed(instance, then):
    with pytest.raises(FMICallException):
        instance.start(**{"ground.friction": -1.0})
    if then == "reset":
        instance.slave.reset()
        instance.start()
        assert_lands_as_ever(instance)
    if then == "terminate and free":
        instance.slave.terminate()
    instance.free()


def test_outputs_of_bad_parameters_are_an_error_not_numbers(instance):
    instance.set("ground.friction", -1.0)
    value = reals(1.0)
    assert instance.status("fmi2GetReal", refs(instance.vr["body.y"]), 1, value) == ERROR
    assert math.isnan(value[0])
    assert "ground.friction = -1 is outside [0, 3]" in instance.reason()


def test_errors_that_the_host_does_not_log_are_on_standard_error(instance, capfd):
    instance.slave.setDebugLogging(False, [])
    with pytest.raises(FMICallException):
        instance.start(**{"ground.friction": -1.0})
    assert "RlvLanding (test): ground.friction = -1 is outside [0, 3]" in capfd.readouterr().err
    assert instance.log == []


# -- calls out of order


def test_calls_out_of_order_are_errors_that_say_so_and_change_nothing(instance):
    def refused(function: str, when: str, *arguments) -> None:
        assert instance.status(function, *arguments) == ERROR
        assert f"{function} must not be called {when}" in instance.reason()

    step = (c_double(0.0), c_double(1e-3), 1)
    before, during = "before fmi2EnterInitializationMode", "in initialization mode"
    after, ended = "after fmi2ExitInitializationMode", "after fmi2Terminate"
    setup = (0, c_double(0.0), c_double(0.0), 0, c_double(0.0))
    for function, arguments in (
        ("fmi2DoStep", step),
        ("fmi2ExitInitializationMode", ()),
        ("fmi2Terminate", ()),
    ):
        refused(function, before, *arguments)
    instance.slave.enterInitializationMode()
    for function, arguments in (
        ("fmi2DoStep", step),
        ("fmi2EnterInitializationMode", ()),
        ("fmi2SetupExperiment", setup),
    ):
        refused(function, during, *arguments)
    instance.slave.exitInitializationMode()
    for function, arguments in (
        ("fmi2EnterInitializationMode", ()),
        ("fmi2ExitInitializationMode", ()),
        ("fmi2SetupExperiment", setup),
    ):
        refused(function, after, *arguments)
    assert_lands_as_ever(instance)
    instance.slave.terminate()
    for function, arguments in (
        ("fmi2DoStep", step),
        ("fmi2Terminate", ()),
        ("fmi2SetReal", (refs(0), 1, reals(0.0))),
    ):
        refused(function, ended, *arguments)
    assert instance.get("body.y") < 3.0
    instance.slave.reset()
    instance.start()
    assert_lands_as_ever(instance)


def test_parameters_are_fixed_after_initialisation_and_outputs_are_never_set(instance):
    value = reals(0.3)
    assert instance.status("fmi2SetReal", refs(instance.vr["body.y"]), 1, value) == ERROR
    assert "body.y is no parameter or input" in instance.reason()
    instance.start()
    assert instance.status("fmi2SetReal", refs(instance.vr["ground.friction"]), 1, value) == ERROR
    assert (
        "ground.friction is a fixed parameter: set it before fmi2ExitInitializationMode, or reset"
        in instance.reason()
    )
    assert_lands_as_ever(instance)


@pytest.mark.parametrize("start", [math.nan, math.inf])
def test_start_time_must_be_finite(instance, start):
    assert (
        instance.status("fmi2SetupExperiment", 0, c_double(0.0), c_double(start), 0, c_double(0.0))
        == ERROR
    )
    assert "startTime" in instance.reason()


# -- arguments that cannot be


def bad_arguments(vr):
    one, text = refs(vr[REAL]), refs(vr[TEXT])
    state, size = c_void_p(), c_size_t()
    return [
        ("fmi2SetReal", (None, 1, reals(0.0)), "fmi2SetReal: vr is NULL"),
        ("fmi2SetReal", (one, 1, None), "fmi2SetReal: value is NULL"),
        ("fmi2GetReal", (None, 1, reals(0.0)), "fmi2GetReal: vr is NULL"),
        ("fmi2GetReal", (one, 1, None), "fmi2GetReal: value is NULL"),
        (
            "fmi2GetReal",
            (refs(100_000), 1, reals(0.0)),
            "value reference 100000 is not one of 0 to",
        ),
        (
            "fmi2SetReal",
            (refs(2**32 - 1), 1, reals(0.0)),
            "value reference 4294967295 is not one of 0 to",
        ),
        (
            "fmi2SetReal",
            (refs(2_000_000), 1, reals(0.0)),
            "value reference 2000000 is not one of 0 to",
        ),
        (
            "fmi2SetReal",
            (text, 1, reals(0.0)),
            f"drop.mode (value reference {vr[TEXT]}) is a String",
        ),
        ("fmi2GetReal", (text, 1, reals(0.0)), "is a String"),
        ("fmi2SetInteger", (one, 1, (c_int * 1)(0)), "is a Real"),
        ("fmi2GetInteger", (one, 1, (c_int * 1)(0)), "is a Real"),
        ("fmi2SetBoolean", (one, 1, (c_int * 1)(0)), "is a Real"),
        ("fmi2GetBoolean", (refs(vr["status.phase"]), 1, (c_int * 1)(0)), "is an Integer"),
        (
            "fmi2SetBoolean",
            (refs(vr["leg[1].contact.active"]), 1, (c_int * 1)(1)),
            "is no parameter or input",
        ),
        ("fmi2GetString", (one, 1, (c_char_p * 1)()), "is a Real"),
        ("fmi2SetString", (text, 1, (c_char_p * 1)(None)), "the value of drop.mode is NULL"),
        (
            "fmi2SetString",
            (text, 1, (c_char_p * 1)(b"\xff\xfe")),
            "the value of drop.mode is not UTF-8",
        ),
        (
            "fmi2SetString",
            (text, 1, (c_char_p * 1)(b"\xed\xa0\x80")),
            "the value of drop.mode is not UTF-8",
        ),
        ("fmi2GetFMUstate", (None,), "fmi2GetFMUstate: FMUstate is NULL"),
        ("fmi2SetFMUstate", (None,), "fmi2SetFMUstate: FMUstate is NULL"),
        ("fmi2SetFMUstate", (c_void_p(4096),), "FMUstate is no state of this FMU, or was freed"),
        (
            "fmi2FreeFMUstate",
            (byref(c_void_p(4096)),),
            "FMUstate is no state of this FMU, or was freed",
        ),
        ("fmi2SerializedFMUstateSize", (state, byref(size)), "FMUstate is NULL"),
        (
            "fmi2SerializeFMUstate",
            (c_void_p(4096), (fmi2.fmi2Byte * 4)(), 4),
            "FMUstate is no state of this FMU, or was freed",
        ),
        ("fmi2DeSerializeFMUstate", (None, 4, byref(state)), "serializedState is NULL"),
        ("fmi2DeSerializeFMUstate", ((fmi2.fmi2Byte * 4)(), 4, None), "FMUstate is NULL"),
        ("fmi2SetDebugLogging", (1, 1, None), "categories is NULL"),
        (
            "fmi2SetDebugLogging",
            (1, 1, (c_char_p * 1)(b"logNonsense")),
            "logNonsense is no log category of this FMU",
        ),
        (
            "fmi2SetDebugLogging",
            (1, 1, (c_char_p * 1)(None)),
            "NULL is no log category of this FMU",
        ),
        ("fmi2GetRealStatus", (2, None), "value is NULL"),
        ("fmi2SetRealInputDerivatives", (one, 1, None, reals(0.0)), "order is NULL"),
        (
            "fmi2SetRealInputDerivatives",
            (one, 1, (c_int * 1)(2), reals(0.0)),
            "only the first derivative is taken",
        ),
        (
            "fmi2SetRealInputDerivatives",
            (one, 1, (c_int * 1)(0), reals(0.0)),
            "only the first derivative is taken",
        ),
        (
            "fmi2SetRealInputDerivatives",
            (refs(vr["body.y"]), 1, (c_int * 1)(1), reals(0.0)),
            "body.y is no input",
        ),
        (
            "fmi2SetRealInputDerivatives",
            (refs(vr["ground.friction"]), 1, (c_int * 1)(1), reals(0.0)),
            "ground.friction is no input",
        ),
        (
            "fmi2GetRealOutputDerivatives",
            (refs(vr["body.y"]), 1, (c_int * 1)(1), reals(0.0)),
            "this FMU has no derivatives of outputs",
        ),
        (
            "fmi2GetDirectionalDerivative",
            (one, 1, one, 1, reals(1.0), reals(1.0)),
            "this FMU has no directional derivatives",
        ),
        ("fmi2CancelStep", (), "no step is pending"),
    ]


def test_arguments_that_cannot_be_are_errors_with_a_reason_and_change_nothing(instance):
    for function, arguments, reason in bad_arguments(instance.vr):
        said = len(instance.log)
        assert instance.status(function, *arguments) == ERROR, function
        assert len(instance.log) == said + 1, function
        assert reason in instance.reason()
        assert instance.log[-1][0] == ERROR
        assert instance.categories[-1] == "logStatusError"
    instance.start()
    assert_lands_as_ever(instance)


def test_nothing_at_all_may_be_set_and_got(instance):
    for function in ("fmi2SetReal", "fmi2GetReal", "fmi2SetString", "fmi2GetBoolean"):
        assert instance.status(function, None, 0, None) == OK


def test_calls_without_an_instance_are_errors(instance):
    instance.slave.component, kept = None, instance.slave.component
    for function, arguments, _ in bad_arguments(instance.vr):
        assert instance.status(function, *arguments) == ERROR
    assert instance.step(0.0, 1e-3) == ERROR
    assert instance.status("fmi2Reset") == ERROR
    instance.status("fmi2FreeInstance")
    instance.slave.component = kept


# -- instances


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (
            {"guid": b"{00000000-0000-0000-0000-000000000000}"},
            "description and binary are of different builds",
        ),
        ({"guid": None}, "fmuGUID is NULL"),
        ({"name": None}, "instanceName is NULL"),
        ({"name": b"\xff"}, "instanceName is not UTF-8"),
        ({"kind": fmi2.fmi2ModelExchange}, "for co-simulation only"),
        ({"resources": None}, "fmuResourceLocation is NULL"),
        ({"resources": b"file:///nowhere"}, "no slavemodule.txt there"),
        ({"resources": b"http://example.org/"}, "no slavemodule.txt there"),
        ({"resources": b"file:///" + b"x" * 10_000}, "no slavemodule.txt there"),
    ],
)
def test_an_instance_that_cannot_be_is_null_with_the_reason_logged(
    instance, unpacked, description, change, reason
):
    good = {
        "name": b"one",
        "kind": fmi2.fmi2CoSimulation,
        "guid": description.guid.encode(),
        "resources": (unpacked / "resources").as_uri().encode(),
    }
    arguments = good | change
    instantiate = instance.slave.dll.fmi2Instantiate
    made = instantiate(
        arguments["name"],
        arguments["kind"],
        arguments["guid"],
        arguments["resources"],
        byref(instance.callbacks),
        0,
        1,
    )
    assert not made
    assert reason in instance.reason()
    assert instance.log[-1][0] == ERROR


def test_a_host_without_callbacks_is_told_on_standard_error(instance, capfd):
    assert not instance.slave.dll.fmi2Instantiate(
        b"mute", fmi2.fmi2CoSimulation, b"wrong", b"file:///x", None, 0, 1
    )
    assert "RlvLanding (mute): fmi2Instantiate: fmuGUID = wrong" in capfd.readouterr().err


# -- logging


def test_only_the_categories_asked_for_are_logged(instance):
    def provoke() -> list[str]:
        instance.log.clear()
        instance.categories.clear()
        instance.step(5.0, 1e-3)
        instance.status("fmi2CancelStep")
        return list(instance.categories)

    instance.start()
    assert provoke() == ["logStatusDiscard", "logStatusError"]
    for chosen, seen in (
        (["logStatusDiscard"], ["logStatusDiscard"]),
        (["logStatusError"], ["logStatusError"]),
        (["logStatusWarning"], []),
        (["logAll"], ["logStatusDiscard", "logStatusError"]),
        ([], ["logStatusDiscard", "logStatusError"]),
    ):
        instance.slave.setDebugLogging(True, chosen)
        assert provoke() == seen
    instance.slave.setDebugLogging(False, [])
    assert provoke() == []


def test_a_percent_sign_in_a_message_does_not_reach_the_hosts_printf(instance):
    instance.status("fmi2SetDebugLogging", 1, 1, (c_char_p * 1)(b"100%n"))
    assert "100%%n is no log category" in instance.reason()


# -- steps and questions about them


def test_status_functions_answer_what_they_can_and_discard_the_rest(instance):
    status, time, flag, number, text = c_int(9), c_double(), c_int(9), c_int(), c_char_p()
    instance.start()
    instance.steps(0, 3)
    assert instance.status("fmi2GetStatus", fmi2.fmi2DoStepStatus, byref(status)) == OK
    assert status.value == OK
    assert instance.step(3e-3, -1.0) == DISCARD
    assert instance.status("fmi2GetStatus", fmi2.fmi2DoStepStatus, byref(status)) == OK
    assert status.value == DISCARD
    assert instance.status("fmi2GetRealStatus", fmi2.fmi2LastSuccessfulTime, byref(time)) == OK
    assert time.value == pytest.approx(3e-3, abs=1e-15)
    assert instance.status("fmi2GetBooleanStatus", fmi2.fmi2Terminated, byref(flag)) == OK
    assert flag.value == 0
    assert instance.status("fmi2GetStringStatus", fmi2.fmi2PendingStatus, byref(text)) == OK
    assert text.value == b""
    for function, kind, place in (
        ("fmi2GetStatus", fmi2.fmi2Terminated, status),
        ("fmi2GetRealStatus", fmi2.fmi2Terminated, time),
        ("fmi2GetBooleanStatus", fmi2.fmi2LastSuccessfulTime, flag),
        ("fmi2GetIntegerStatus", fmi2.fmi2LastSuccessfulTime, number),
        ("fmi2GetStringStatus", fmi2.fmi2Terminated, text),
    ):
        assert instance.status(function, kind, byref(place)) == DISCARD
        assert f"{function}: this function does not answer status kind {kind}" in instance.reason()
    assert_lands_as_ever(instance, 3)


def test_results_are_the_same_for_steps_from_10_us_to_100_ms_in_any_order(make):
    """At common times, every 0.1 s, to 1e-9 of each quantity's largest value."""
    generator = np.random.default_rng(20240501)
    reals = [n for n in OUTPUT_NAMES if n != "status.phase" and not n.endswith("contact.active")]
    landing, rows = Landing(), []
    for k in range(1, 11):
        landing.advance_to(k * 0.1)
        rows.append([landing.get(n) for n in reals])
    expected = np.array(rows)
    for longest in (1e-5, 1e-3, 1e-2, 1e-1):
        instance = make()
        instance.start()
        vrs, time, found = [instance.vr[n] for n in reals], 0.0, []
        for k in range(1, 11):
            if longest == 1e-5:
                times = [
                    *(k * 0.1 - 0.1 + 1e-5 * generator.uniform(1.0, 2.0, 200).cumsum()),
                    k * 0.1,
                ]
            else:
                cuts = generator.uniform(k * 0.1 - 0.1, k * 0.1, int(0.1 / longest))
                times = [*np.unique(cuts), k * 0.1]
            for goal in times:
                if goal > time:
                    instance.slave.doStep(time, goal - time)
                    time = goal
            found.append(instance.slave.getReal(vrs))
        assert np.all(
            np.abs(np.array(found) - expected)
            <= 1e-9 * np.maximum(1.0, np.abs(expected).max(axis=0))
        )


# -- the importer's tolerance


def test_the_importers_tolerance_is_the_integrators(instance):
    instance.slave.setupExperiment(startTime=0.0, tolerance=1e-8)
    instance.slave.enterInitializationMode()
    instance.slave.exitInitializationMode()
    instance.steps(0, 300)
    landing = Landing(rtol=1e-8)
    landing.advance_to(299e-3 + 1e-3)
    assert [instance.get(n) for n in ("body.x", "energy.balance")] == [
        landing.get(n) for n in ("body.x", "energy.balance")
    ]


def test_a_tolerance_that_the_integrator_does_not_know_is_an_error(instance):
    instance.slave.setupExperiment(startTime=0.0, tolerance=0.5)
    instance.slave.enterInitializationMode()
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert "rtol = 0.5 is outside [1e-12, 1e-2]" in instance.reason()


# -- inputs at once


def test_an_input_shows_in_the_outputs_before_the_next_step(instance):
    instance.start()
    instance.steps(0, 100)
    landing = Landing()
    landing.advance_to(99e-3 + 1e-3)
    instance.set(REAL, 1000.0)
    landing.set_inputs({REAL: 1000.0})
    assert instance.get("body.ax") == landing.get("body.ax")
    instance.set(REAL, math.nan)
    assert instance.get("body.ax") == landing.get("body.ax")
    assert instance.step(100e-3, 1e-3) == DISCARD
    instance.set(REAL, 1000.0)
    assert instance.step(100e-3, 1e-3) == OK


# -- all outputs at once, kept until something changes


def read_one_by_one(instance: Instance) -> list[float]:
    """All outputs, each by its own call of the function of its type."""
    found = []
    for q in OUTPUT_QUANTITIES:
        read = {
            "real": instance.slave.getReal,
            "integer": instance.slave.getInteger,
            "boolean": instance.slave.getBoolean,
        }[q.kind]
        found += read([instance.vr[q.name]])
    return found


def test_outputs_are_those_of_the_present_however_often_and_in_whatever_order_they_are_read(
    instance,
):
    landing = Landing()
    instance.start()
    assert read_one_by_one(instance) == landing.values()
    instance.steps(0, 150)
    landing.advance_to(149e-3 + 1e-3)
    state, before = instance.slave.getFMUState(), landing.values()
    assert read_one_by_one(instance) == before == read_one_by_one(instance)
    instance.set(REAL, 500.0)
    landing.set_inputs({REAL: 500.0})
    assert read_one_by_one(instance) == landing.values() != before
    assert instance.set_rate(REAL, 100.0) == OK
    instance.steps(150, 151)
    landing.set_inputs({REAL: 500.0}, {REAL: 100.0})
    landing.advance_to(150e-3 + ((151e-3) - 150e-3))
    assert instance.get("body.vx") == pytest.approx(landing.get("body.vx"), rel=1e-12)
    instance.slave.setFMUState(state)
    assert read_one_by_one(instance) == before
    mixed = [instance.vr[name] for name in ("body.y", REAL, "vehicle.mass", "body.x")]
    body = dict(zip(OUTPUT_NAMES, before))
    assert instance.slave.getReal(mixed) == [
        body["body.y"],
        0.0,
        Landing().parameters["vehicle.mass"],
        body["body.x"],
    ]
    instance.slave.terminate()
    instance.slave.reset()
    assert instance.get("body.y") == Landing().get("body.y")


def test_the_solver_tells_what_it_has_done_and_a_state_holds_it(instance):
    names = [q.name for q in STATISTIC_QUANTITIES]
    landing = Landing()
    instance.start()
    instance.steps(0, 200)
    landing.advance_to(199e-3 + 1e-3)
    told = instance.slave.getInteger([instance.vr[name] for name in names])
    assert dict(zip(names, told)) == {
        f"solver.{name}": count for name, count in landing.statistics.items()
    }
    assert told[0] > 0
    state = instance.slave.getFMUState()
    instance.steps(200, 250)
    instance.slave.setFMUState(state)
    assert instance.slave.getInteger([instance.vr[name] for name in names]) == told
    assert (
        instance.status("fmi2SetInteger", refs(instance.vr[names[0]]), 1, (c_int * 1)(0)) == ERROR
    )
    assert "solver.steps is no parameter or input" in instance.reason()
