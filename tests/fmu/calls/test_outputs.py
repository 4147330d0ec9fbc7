"""Outputs are those of the present inputs and state, in whatever order they are read."""

from __future__ import annotations

import math
from ctypes import c_int

import pytest
from fmu_instance import DISCARD, ERROR, OK, Instance, refs

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUT_NAMES, OUTPUT_QUANTITIES, PEAKS, STATISTIC_QUANTITIES

FORCE = "external.force_x"


def test_an_input_shows_in_the_outputs_before_the_next_step(instance):
    instance.start()
    instance.steps(0, 100)
    landing = Landing()
    landing.advance_to(99e-3 + 1e-3)
    instance.set(FORCE, 1000.0)
    landing.set_inputs({FORCE: 1000.0})
    assert instance.get("body.ax") == landing.get("body.ax")
    instance.set(FORCE, math.nan)
    assert instance.get("body.ax") == landing.get("body.ax")
    assert instance.step(100e-3, 1e-3) == DISCARD
    instance.set(FORCE, 1000.0)
    assert instance.step(100e-3, 1e-3) == OK


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
    instance.set(FORCE, 500.0)
    landing.set_inputs({FORCE: 500.0})
    assert read_one_by_one(instance) == landing.values() != before
    assert instance.set_rate(FORCE, 100.0) == OK
    instance.steps(150, 151)
    landing.set_inputs({FORCE: 500.0}, {FORCE: 100.0})
    landing.advance_to(150e-3 + ((151e-3) - 150e-3))
    assert instance.get("body.vx") == pytest.approx(landing.get("body.vx"), rel=1e-12)
    instance.slave.setFMUState(state)
    assert read_one_by_one(instance) == before
    mixed = [instance.vr[name] for name in ("body.y", FORCE, "vehicle.mass", "body.x")]
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


def test_the_solvers_counts_are_landings_and_a_state_holds_it(instance):
    names = [q.name for q in STATISTIC_QUANTITIES if q.kind == "integer"]
    landing = Landing()
    instance.start()
    instance.steps(0, 200)
    landing.advance_to(199e-3 + 1e-3)
    counts = instance.slave.getInteger([instance.vr[name] for name in names])
    assert dict(zip(names, counts)) == {
        f"solver.{name}": count for name, count in landing.statistics.items()
    }
    assert counts[0] > 0
    state = instance.slave.getFMUState()
    instance.steps(200, 250)
    instance.slave.setFMUState(state)
    assert instance.slave.getInteger([instance.vr[name] for name in names]) == counts
    assert (
        instance.status("fmi2SetInteger", refs(instance.vr[names[0]]), 1, (c_int * 1)(0)) == ERROR
    )
    assert "solver.steps is no parameter or input" in instance.reason()


def peaks_of(instance):
    names = [q.name for p in PEAKS for q in (p.value, p.time)]
    return instance.slave.getReal([instance.vr[name] for name in names])


def expected_peaks(landing):
    extremes = landing.extremes()
    return [
        number
        for p in PEAKS
        for number in (extremes[p.output][:2] if p.side == "min" else extremes[p.output][2:])
    ]


def test_peaks_are_the_landings_whatever_the_steps_and_a_state_holds_them(instance):
    landing = Landing()
    instance.start()
    assert peaks_of(instance) == expected_peaks(landing)
    instance.steps(0, 200)
    landing.advance_to(199e-3 + 1e-3)
    told = peaks_of(instance)
    assert told == expected_peaks(landing)
    names = [p.value.name for p in PEAKS]
    force = told[2 * names.index("peak.leg[1].main_strut.force.min")]
    assert force < -3000.0
    state = instance.slave.getFMUState()
    instance.steps(200, 400)
    assert peaks_of(instance) != told
    instance.slave.setFMUState(state)
    assert peaks_of(instance) == told
    read = [instance.get(name) for name in names]
    assert read == told[::2]
