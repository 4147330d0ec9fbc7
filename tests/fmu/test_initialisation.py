"""Instantiation, setup and initialisation, with good and bad values."""

from __future__ import annotations

import math
from ctypes import byref, c_double

import pytest
from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from fmu_instance import ERROR, assert_lands_like_landing, reals, refs

from rlv_landing import Landing

BAD_PARAMETERS = [
    ("ground.friction", -1.0, "ground.friction = -1 is outside [0, 3]"),
    ("vehicle.mass", math.nan, "vehicle.mass = nan kg"),
    ("drop.contact_time", 0.9, "drop.contact_time = 0.9 s"),
    ("external.force_y", math.inf, "external.force_y = inf N"),
]


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
    assert_lands_like_landing(instance)


def test_bad_text_is_an_error_that_names_the_choices(instance):
    instance.slave.enterInitializationMode()
    instance.slave.setString([instance.vr["drop.mode"]], ["2-3"])
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
        assert_lands_like_landing(instance)
    if then == "terminate and free":
        instance.slave.terminate()
    instance.free()


def test_outputs_of_bad_parameters_are_an_error_not_numbers(instance):
    instance.set("ground.friction", -1.0)
    value = reals(1.0)
    assert instance.status("fmi2GetReal", refs(instance.vr["body.y"]), 1, value) == ERROR
    assert math.isnan(value[0])
    assert "ground.friction = -1 is outside [0, 3]" in instance.reason()


@pytest.mark.parametrize("start", [math.nan, math.inf])
def test_start_time_must_be_finite(instance, start):
    assert (
        instance.status("fmi2SetupExperiment", 0, c_double(0.0), c_double(start), 0, c_double(0.0))
        == ERROR
    )
    assert "startTime" in instance.reason()


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
