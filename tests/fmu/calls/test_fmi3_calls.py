"""FMI 3.0: calls out of order and arguments that cannot be are errors; values; states."""

from __future__ import annotations

from ctypes import byref, c_bool, c_char_p, c_double, c_float, c_int, c_size_t, c_void_p
from typing import Any

import pytest
from fmpy import fmi3
from fmu_instance import DISCARD, ERROR, OK, reals, refs

from rlv_landing import Landing

SEEN = {"body.x": "body.x", "leg.footpad.y": "leg[{}].footpad.y"}


def assert_lands_like_landing(instance: Any, first: int = 0) -> None:
    """The instance gives `Landing`'s digits after 20 more steps of 1 ms, from step `first`."""
    instance.steps(first, first + 20)
    landing = Landing()
    landing.advance_to((first + 19) * 1e-3 + 1e-3)
    for name, ours in SEEN.items():
        found = instance.get(name)
        assert found == [landing.get(ours.format(k + 1)) for k in range(len(found))]


def strings(*texts: bytes | None) -> Any:
    return (c_char_p * len(texts))(*texts)


def bad_arguments(vr: dict[str, int]) -> list[tuple[str, tuple[Any, ...], str]]:
    """Calls with arguments that cannot be, and what their messages say."""
    mu, force, mode, time = (
        vr[n] for n in ("ground.friction", "leg.contact.force", "drop.mode", "time")
    )
    second = force + 18  # of leg 2, no variable of its own in FMI 3.0
    size, state = c_size_t(), c_void_p()
    return [
        ("fmi3GetFloat64", (None, 1, reals(0.0), 1), "valueReferences is NULL"),
        ("fmi3GetFloat64", (refs(mu), 1, None, 1), "values is NULL"),
        ("fmi3GetFloat64", (refs(time + 1), 1, reals(0.0), 1), "is that of no variable"),
        ("fmi3GetFloat64", (refs(4294967295), 1, reals(0.0), 1), "is that of no variable"),
        ("fmi3GetFloat64", (refs(second), 1, reals(0.0), 1), "is that of no variable"),
        (
            "fmi3GetFloat64",
            (refs(mu, force), 2, reals(0.0, 0.0), 2),
            "nValues = 2, but the variables have 5 values",
        ),
        ("fmi3GetFloat64", (refs(mu), 1, reals(0.0, 0.0), 2), "have 1 values"),
        ("fmi3GetFloat64", (refs(mode), 1, reals(0.0), 1), "drop.mode (value reference"),
        ("fmi3GetInt32", (refs(mu), 1, (c_int * 1)(), 1), "is a Float64"),
        ("fmi3GetBoolean", (refs(force), 1, (c_bool * 4)(), 4), "leg.contact.force (value"),
        ("fmi3GetString", (refs(time), 1, strings(None), 1), "time (value reference"),
        ("fmi3GetFloat32", (refs(mu), 1, (c_float * 1)(), 1), "is a Float64"),
        ("fmi3GetInt64", (refs(mode), 1, None, 1), "is a String"),
        ("fmi3SetUInt8", (refs(time + 9), 1, None, 1), "is that of no variable"),
        ("fmi3GetBinary", (refs(mode), 1, None, None, 1), "is a String"),
        ("fmi3SetClock", (refs(mu), 1, None), "is a Float64"),
        ("fmi3SetFloat64", (refs(force), 1, reals(*[0.0] * 4), 4), "leg.contact.force is no para"),
        ("fmi3SetFloat64", (refs(time), 1, reals(0.0), 1), "time is no parameter or input"),
        ("fmi3SetFloat64", (refs(mu), 1, reals(0.1, 0.2), 2), "nValues = 2"),
        ("fmi3SetString", (refs(mode), 1, strings(None), 1), "the value of drop.mode is NULL"),
        ("fmi3SetString", (refs(mode), 1, strings(b"\xff"), 1), "is not UTF-8"),
        ("fmi3GetFMUState", (None,), "FMUstate is NULL"),
        ("fmi3SetFMUState", (c_void_p(4096),), "is no state of this FMU, or was freed"),
        ("fmi3SerializedFMUStateSize", (state, byref(size)), "FMUstate is NULL"),
        ("fmi3DeserializeFMUState", ((fmi3.fmi3Byte * 4)(), 4, byref(state)), "are no state"),
        ("fmi3SetDebugLogging", (c_bool(True), 1, None), "categories is NULL"),
        ("fmi3EnterConfigurationMode", (), "no structural parameters"),
        ("fmi3EvaluateDiscreteStates", (), "no discrete states"),
        ("fmi3GetNumberOfVariableDependencies", (mu, byref(size)), "no dependencies of elements"),
        ("fmi3GetNumberOfContinuousStates", (byref(size),), "is for co-simulation only"),
        ("fmi3SetTime", (c_double(0.0),), "is for co-simulation only"),
        ("fmi3ActivateModelPartition", (0, c_double(0.0)), "is for co-simulation only"),
        ("fmi3GetIntervalDecimal", (refs(mu), 1, reals(0.0), None), "has no clocks"),
        (
            "fmi3GetOutputDerivatives",
            (refs(force), 1, (c_int * 1)(1), reals(0.0), 1),
            "has no derivatives",
        ),
        ("fmi3DoStep", (c_double(0.0), c_double(1e-3), True, *[None] * 4), "must not be called"),
        ("fmi3EnterEventMode", (), "must not be called before the initialization mode"),
        ("fmi3EnterStepMode", (), "must not be called before the initialization mode"),
        ("fmi3ExitInitializationMode", (), "must not be called before"),
    ]


def test_arguments_that_cannot_be_are_errors_with_a_reason_and_change_nothing(make3):
    """The host gets the reasons whether it wants messages or not, as FMI 3.0 says of errors."""
    for logging in (True, False):
        instance = make3(logging=logging)
        for function, arguments, reason in bad_arguments(instance.vr):
            logged = len(instance.log)
            assert instance.status(function, *arguments) == ERROR, (function, reason)
            assert len(instance.log) == logged + 1, (function, reason)
            assert reason in instance.reason(), function
            assert instance.log[-1][0] == ERROR
        instance.start()
        assert_lands_like_landing(instance)


def test_calls_without_an_instance_are_errors(make3):
    instance = make3()
    instance.slave.component, kept = None, instance.slave.component
    for function, arguments, _ in bad_arguments(instance.vr):
        assert instance.status(function, *arguments) == ERROR
    instance.status("fmi3FreeInstance")
    instance.slave.component = kept


def test_getters_and_setters_take_no_variables_at_all(make3):
    instance = make3()
    for kind in ("Float32", "Float64", "Int8", "UInt64", "Int32", "Boolean", "String"):
        for call in ("Get", "Set"):
            assert instance.status(f"fmi3{call}{kind}", None, 0, None, 0) == OK
    assert instance.status("fmi3GetClock", None, 0, None) == OK


def test_pointers_for_results_must_not_be_null(make3):
    instance = make3(event_mode=True)
    instance.start()
    assert instance.status("fmi3UpdateDiscreteStates", *[None] * 6) == ERROR
    assert "discreteStatesNeedUpdate is NULL" in instance.reason()
    instance.slave.enterStepMode()
    step = (c_double(0.0), c_double(1e-3), True)
    assert instance.status("fmi3DoStep", *step, *[None] * 4) == ERROR
    assert "eventHandlingNeeded is NULL" in instance.reason()
    assert_lands_like_landing(instance)


def test_arrays_scalars_and_time_are_read_in_any_order_in_one_call(make3):
    instance = make3()
    instance.start(start_time=2.0)
    assert instance.step(2.0, 0.25)[0] == OK
    names = ["leg.footpad.z", "time", "body.y", "ground.friction", "time"]
    names.append("peak.leg.contact.force.max")
    together = instance.slave.getFloat64([instance.vr[n] for n in names], 12)
    assert together == [number for name in names for number in instance.get(name)]
    assert instance.get("time") == [2.25]
    active = instance.slave.getBoolean([instance.vr["leg.contact.active"]], 4)
    assert active == [depth > 0.0 for depth in instance.get("leg.contact.penetration")]
    assert any(active)
    assert instance.slave.getInt32([instance.vr["status.phase"]]) == [1]
    assert instance.slave.getString([instance.vr["drop.mode"]]) == ["2-2"]
    # as in FMI 2.0, numeric outputs of other types may be read as Float64
    assert instance.get("status.phase") == [1.0]


def test_bad_parameters_steps_and_inputs_are_refused_as_in_fmi_2(make3):
    instance = make3()
    instance.slave.enterInitializationMode(startTime=0.0)
    instance.set("ground.friction", -1.0)
    assert instance.status("fmi3ExitInitializationMode") == ERROR
    assert "ground.friction = -1" in instance.reason()
    instance.set("ground.friction", Landing().parameters.ground.friction)
    instance.slave.exitInitializationMode()
    for time, step in ((0.0, 0.0), (0.0, -1e-3), (0.0, float("nan")), (0.5, 1e-3)):
        status, event, early, last = instance.step(time, step)
        assert (status, event, early, last) == (DISCARD, False, False, 0.0)
    instance.set("external.force_x", float("inf"))
    assert instance.step(0.0, 1e-3)[0] == DISCARD
    instance.set("external.force_x", 0.0)
    assert instance.status("fmi3SetFloat64", refs(instance.vr["ground.friction"]), 1, reals(0.1), 1)
    assert "is a fixed parameter" in instance.reason()
    assert_lands_like_landing(instance)


@pytest.mark.parametrize(("start", "reason"), [(float("nan"), "startTime = nan s must be finite")])
def test_a_start_time_that_cannot_be_is_an_error_and_may_be_set_again(make3, start, reason):
    instance = make3()
    arguments = (c_bool(False), c_double(0.0), c_double(start), c_bool(False), c_double(0.0))
    assert instance.status("fmi3EnterInitializationMode", *arguments) == ERROR
    assert reason in instance.reason()
    instance.start()
    assert_lands_like_landing(instance)


def test_a_state_goes_on_with_the_same_digits_in_another_instance(make3):
    first, second = make3(), make3(event_mode=True)
    first.start(**{"ground.friction": 0.35})
    first.steps(0, 150)
    data = first.state()
    first.steps(150, 300)
    assert second.restore(data) == OK
    second.steps(150, 300)
    for name in ("body.x", "leg.main_strut.force", "leg.contact.force_x"):
        assert first.get(name) == second.get(name)


def test_a_state_of_event_mode_is_one_of_step_mode_for_a_host_without_events(make3):
    first, second = make3(event_mode=True), make3()
    first.start()
    data = first.state()
    assert second.restore(data) == OK
    assert_lands_like_landing(second)
    assert first.restore(data) == OK
    assert first.step(0.0, 1e-3)[0] == ERROR
    assert "fmi3DoStep must not be called in event mode" in first.reason()
    first.slave.enterStepMode()
    assert_lands_like_landing(first)


def test_a_state_of_the_fmi_2_build_is_refused_and_the_other_way_round(make, make3):
    of_fmi2, of_fmi3 = make(), make3()
    of_fmi2.start()
    of_fmi3.start()
    data = of_fmi2.slave.serializeFMUstate(of_fmi2.slave.getFMUState())
    assert of_fmi3.restore(bytes(data)) == ERROR
    assert "are a state of another build or version" in of_fmi3.reason()
    assert_lands_like_landing(of_fmi3)


def test_reset_and_terminate_follow_the_standards_order(make3):
    instance = make3()
    instance.start()
    instance.steps(0, 3)
    assert instance.status("fmi3Terminate") == OK
    assert instance.step(3e-3, 1e-3)[0] == ERROR
    assert "must not be called after the termination" in instance.reason()
    assert len(instance.get("leg.footpad.y")) == 4
    assert instance.status("fmi3Reset") == OK
    instance.start()
    assert_lands_like_landing(instance)


def test_other_kinds_and_wrong_arguments_make_no_instance_and_say_why(
    make3, description3, unpacked3
):
    logged: list[str] = []
    callback = fmi3.fmi3LogMessageCallback(lambda *message: logged.append(message[-1].decode()))
    dll, token = make3().slave.dll, description3.instantiationToken.encode()
    path = str(unpacked3 / "resources").encode() + b"/"
    common = (path, c_bool(False), c_bool(False))
    update = fmi3.fmi3IntermediateUpdateCallback()
    for function in ("fmi3InstantiateModelExchange", "fmi3InstantiateScheduledExecution"):
        make = getattr(dll, function)
        make.restype = c_void_p
        rest = [kind() for kind in make.argtypes[7:]]
        assert make(b"name", token, *common, None, callback, *rest) is None
        assert logged.pop() == f"{function}: this FMU is for co-simulation only"
    make = dll.fmi3InstantiateCoSimulation
    make.restype = c_void_p
    flags = (c_bool(False), c_bool(False))
    last = len(description3.modelVariables) + 1000
    for name, guid, required, reason in (
        (None, token, (), "instanceName is NULL"),
        (b"\xff", token, (), "instanceName is not UTF-8"),
        (b"name", None, (), "instantiationToken is NULL"),
        (b"name", b"other", (), "of different builds"),
        (b"name", token, (last,), f"value reference {last} is that of no variable"),
        (b"name", token, (0,), "is no input or continuous output"),
    ):
        array = refs(*required) if required else None
        assert (
            make(name, guid, *common, *flags, array, len(required), None, callback, update) is None
        )
        assert reason in logged.pop(), reason
    assert logged == []
