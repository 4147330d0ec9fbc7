"""Calls in a wrong order or with wrong arguments: an error with a reason, and nothing changes."""

from __future__ import annotations

from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_void_p

from fmpy import fmi2
from fmu_instance import ERROR, OK, assert_lands_like_landing, reals, refs


def test_calls_out_of_order_are_errors_that_say_so_and_change_nothing(instance):
    def refused(function: str, when: str, *arguments) -> None:
        assert instance.status(function, *arguments) == ERROR
        assert f"{function} must not be called {when}" in instance.reason()

    step = (c_double(0.0), c_double(1e-3), 1)
    before, during = "before the initialization mode", "in initialization mode"
    after, ended = "after the initialization mode", "after the termination"
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
    assert_lands_like_landing(instance)
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
    assert_lands_like_landing(instance)


def test_parameters_are_fixed_after_initialisation_and_outputs_are_never_set(instance):
    value = reals(0.3)
    assert instance.status("fmi2SetReal", refs(instance.vr["body.y"]), 1, value) == ERROR
    assert "body.y is no parameter or input" in instance.reason()
    instance.start()
    assert instance.status("fmi2SetReal", refs(instance.vr["ground.friction"]), 1, value) == ERROR
    assert (
        "ground.friction is a fixed parameter: set it before the end of the initialization mode, "
        "or reset" in instance.reason()
    )
    assert_lands_like_landing(instance)


def bad_arguments(vr):
    one, text = refs(vr["external.force_x"]), refs(vr["drop.mode"])
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
            f"drop.mode (value reference {vr['drop.mode']}) is a String",
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
        logged = len(instance.log)
        assert instance.status(function, *arguments) == ERROR, function
        assert len(instance.log) == logged + 1, function
        assert reason in instance.reason()
        assert instance.log[-1][0] == ERROR
        assert instance.categories[-1] == "logStatusError"
    instance.start()
    assert_lands_like_landing(instance)


def test_getters_and_setters_take_no_variables_at_all(instance):
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


def test_functions_of_the_other_version_of_fmi_are_errors(instance, make3):
    """The library has those of both, and each has callbacks of other types."""
    for one, function, own in ((instance, "fmi3Reset", 2), (make3(), "fmi2Reset", 3)):
        call = getattr(one.slave.dll, function)
        assert call(c_void_p(one.slave.component)) == ERROR
        assert one.reason() == f"{function}: the instance was made by FMI {own}.0"
        one.start()
        one.steps(0, 2)
