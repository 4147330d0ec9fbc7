"""Instantiation, setup and initialisation, with good and bad values."""

from __future__ import annotations

import math
from ctypes import byref, c_double

import pytest
from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from fmu_instance import ERROR, OK, WARNING, assert_lands_like_landing, reals, refs

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.landing import LOOSEST_RTOL
from rlv_landing.outputs import Extreme
from rlv_landing.presets import preset_names
from rlv_landing.quantities import MODES, PEAKS

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


@pytest.mark.parametrize("tolerance", [0.0, 1e-13, math.nan])
def test_a_tolerance_that_the_integrator_does_not_know_is_an_error(instance, tolerance):
    instance.slave.setupExperiment(startTime=0.0, tolerance=tolerance)
    instance.slave.enterInitializationMode()
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert f"rtol = {tolerance:g} is outside [1e-12, 1e-2]" in instance.reason()


@pytest.mark.parametrize("tolerance", [LOOSEST_RTOL, 2e-4, 0.5, math.inf])
def test_a_tolerance_that_makes_peaks_wrong_is_a_warning_and_the_loosest_is_taken(
    instance, tolerance
):
    status = instance.status(
        "fmi2SetupExperiment", 1, c_double(tolerance), c_double(0.0), 0, c_double(0.0)
    )
    if tolerance > LOOSEST_RTOL:
        assert status == WARNING
        assert f"tolerance = {tolerance:g} makes peak forces" in instance.reason()
    else:
        assert status == OK
    instance.slave.enterInitializationMode()
    instance.slave.exitInitializationMode()
    instance.steps(0, 300)
    landing = Landing(rtol=LOOSEST_RTOL)
    landing.advance_to(299e-3 + 1e-3)
    assert instance.get("body.x") == landing.get("body.x")


@pytest.mark.parametrize("mode", list(MODES))
@pytest.mark.parametrize("preset", preset_names())
def test_peaks_are_right_to_1_percent_at_the_loosest_tolerance(preset, mode):
    exact, loose = (_extremes(load_preset(preset, mode), rtol) for rtol in (1e-8, LOOSEST_RTOL))
    for peak in PEAKS:
        if peak.output == "status.stability_margin":
            continue
        right, found = exact[peak.output], loose[peak.output]
        scale = max(abs(right.minimum), abs(right.maximum))
        assert abs(found.minimum - right.minimum) < 0.01 * scale, peak.output
        assert abs(found.maximum - right.maximum) < 0.01 * scale, peak.output


def _extremes(parameters: Parameters, rtol: float) -> dict[str, Extreme]:
    landing = Landing(parameters, rtol=rtol)
    landing.advance_to(1.0)
    return landing.extremes()
