"""Calls of hosts that FMI does not foresee, and that do no harm."""

from __future__ import annotations

import ctypes
import struct
from ctypes import byref, c_char_p, c_double

import pytest
from fmpy import fmi2
from fmu_instance import DISCARD, ERROR, OK, WARNING, reals, refs

from rlv_landing import Landing
from rlv_landing.core import COMPILED
from rlv_landing.quantities import OUTPUT_QUANTITIES

MODEL_EXCHANGE = (
    "EnterEventMode", "NewDiscreteStates", "EnterContinuousTimeMode", "CompletedIntegratorStep",
    "SetTime", "SetContinuousStates", "GetDerivatives", "GetEventIndicators",
    "GetContinuousStates", "GetNominalsOfContinuousStates",
)  # fmt: skip


def test_outputs_of_every_type_can_be_read_as_reals(instance):
    instance.start()
    instance.steps(0, 150)
    landing = Landing()
    landing.advance_to(149e-3 + 1e-3)
    names = [q.name for q in OUTPUT_QUANTITIES]
    assert {q.kind for q in OUTPUT_QUANTITIES} == {"real", "integer", "boolean"}
    assert instance.slave.getReal([instance.vr[n] for n in names]) == landing.values()
    mixed = [instance.vr[n] for n in ("status.phase", "vehicle.mass", "leg[1].contact.active")]
    assert instance.slave.getReal(mixed) == [
        landing.get("status.phase"),
        landing.parameters["vehicle.mass"],
        landing.get("leg[1].contact.active"),
    ]


def test_other_variables_are_read_by_the_function_of_their_type_only(instance):
    for name in ("solver.steps", "solver.compiled", "drop.mode"):
        assert instance.status("fmi2GetReal", refs(instance.vr[name]), 1, reals(0.0)) == ERROR


def test_the_fmu_says_whether_its_core_is_compiled(instance):
    instance.start()
    assert instance.slave.getBoolean([instance.vr["solver.compiled"]]) == [COMPILED]


@pytest.mark.parametrize("name", MODEL_EXCHANGE)
def test_functions_of_model_exchange_are_there_and_refuse(instance, name):
    function = getattr(instance.slave.dll, f"fmi2{name}")
    component = ctypes.c_void_p(instance.slave.component)
    assert function(component, *[ctypes.c_void_p()] * 3) == ERROR
    assert instance.reason() == f"fmi2{name}: this FMU is for co-simulation only"
    instance.start()
    instance.steps(0, 3)


def test_an_unknown_log_category_is_a_warning_and_the_known_ones_are_chosen(instance):
    wanted = (c_char_p * 3)(b"logNonsense", b"logStatusDiscard", None)
    assert instance.status("fmi2SetDebugLogging", 1, 3, wanted) == WARNING
    texts = [f"fmi2SetDebugLogging: {name} is no log category" for name in ("logNonsense", "NULL")]
    assert all(
        status == WARNING and message.startswith(text)
        for (status, message), text in zip(instance.log[-2:], texts)
    )
    instance.start()
    logged = len(instance.log)
    assert instance.status("fmi2CancelStep") == ERROR
    assert len(instance.log) == logged
    assert instance.step(5.0, 1e-3) == DISCARD
    assert len(instance.log) == logged + 1


def test_a_host_without_a_logger_lands(instance, unpacked, description):
    dll = instance.slave.dll
    resources = (unpacked / "resources").as_uri().encode()
    for callbacks in (None, byref(fmi2.fmi2CallbackFunctions())):
        instantiate = dll.fmi2Instantiate
        instantiate.restype = ctypes.c_void_p
        guid = description.guid.encode()
        made = ctypes.c_void_p(instantiate(b"mute", 1, guid, resources, callbacks, 0, 1))
        assert made
        zero = c_double(0.0)
        assert dll.fmi2SetupExperiment(made, 0, zero, zero, 0, zero) == OK
        assert dll.fmi2EnterInitializationMode(made) == OK
        assert dll.fmi2ExitInitializationMode(made) == OK
        assert dll.fmi2DoStep(made, zero, c_double(1e-3), 1) == OK
        assert dll.fmi2DoStep(made, c_double(9.0), c_double(1e-3), 1) == DISCARD
        dll.fmi2FreeInstance(made)


def single(value: float) -> float:
    """The number of single precision nearest to `value`."""
    return struct.unpack("f", struct.pack("f", value))[0]


@pytest.mark.parametrize("start", [0.0, 1e8, -1e8, 1.7e9])
def test_a_start_time_of_the_epoch_lands_like_one_of_0(instance, start):
    """The host's own time has errors of up to 2.4e-7 s there."""
    instance.slave.setupExperiment(startTime=start)
    instance.slave.enterInitializationMode()
    instance.slave.exitInitializationMode()
    time = start
    for _ in range(1000):
        assert instance.step(time, 1e-3) == OK
        time += 1e-3
    landing = Landing()
    landing.advance_to(time - start)
    assert instance.get("body.y") == pytest.approx(landing.get("body.y"), rel=1e-9)


def test_a_host_of_single_precision_lands(instance):
    instance.start()
    step = single(1e-3)
    for k in range(1000):
        assert instance.step(single(k * step), step) == OK
    landing = Landing()
    landing.advance_to(1.0)
    assert instance.get("body.y") == pytest.approx(landing.get("body.y"), rel=1e-5)


@pytest.mark.parametrize("start", [0.0, 1e8])
def test_another_time_is_still_refused(instance, start):
    instance.slave.setupExperiment(startTime=start)
    instance.slave.enterInitializationMode()
    instance.slave.exitInitializationMode()
    for k in range(10):
        assert instance.step(start + k * 1e-3, 1e-3) == OK
    for wrong in (9e-3, 9.99e-3, 10.01e-3, 1.0):
        assert instance.step(start + wrong, 1e-3) == DISCARD
    assert instance.step(start + 10e-3, 1e-3) == OK
