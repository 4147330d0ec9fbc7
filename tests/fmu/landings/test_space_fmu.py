"""The FMU of a vehicle that lands in space: variables, digits, states, what it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from ctypes import c_char_p
from itertools import pairwise
from math import radians
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from five_legs import DECK, five_legs
from fmi3_instance import Instance3
from fmu_instance import ERROR, OK, Instance, refs

from rlv_landing import Landing
from rlv_landing.parameters import parameters_of
from rlv_landing.quantities import STATISTIC_QUANTITIES, interface_of, whole_name

SPACE = interface_of("space", 5)
LEGS = range(1, 6)
# of each kind: body, attitude, legs from the first to the last
SEEN = (
    *("body.z", "body.q_w", "body.heading", "body.spin_y", "body.az", "energy.balance"),
    *("leg[1].main_strut.force", "leg[5].auxiliary_strut.transverse_force", "leg[5].footpad.z"),
)


@pytest.fixture(scope="module")
def unpacked(space_fmu, tmp_path_factory) -> tuple[Any, Path]:
    """Description and files of the FMU."""
    folder = Path(fmpy.extract(str(space_fmu), str(tmp_path_factory.mktemp("unpacked"))))
    return fmpy.read_model_description(str(space_fmu)), folder


@pytest.fixture
def instance(unpacked) -> Iterator[Instance]:
    made = Instance(*unpacked)
    yield made
    made.free()


@pytest.fixture
def instance3(space_fmu3, tmp_path) -> Iterator[Instance3]:
    folder = Path(fmpy.extract(str(space_fmu3), str(tmp_path / "fmu")))
    description = fmpy.read_model_description(str(space_fmu3))
    made = Instance3(description, folder, event_mode=True, early_return=True)
    yield made
    made.free()


def test_its_variables_are_the_table_of_its_interface(space_fmu, space_fmu3):
    description = fmpy.read_model_description(str(space_fmu))
    assert "in space: six degrees of freedom" in description.description
    variables = {v.name: v for v in description.modelVariables}
    groups = {
        "parameter": tuple(parameters_of("space").values()),
        "input": SPACE.inputs,
        "output": SPACE.outputs,
        "local": (*STATISTIC_QUANTITIES, *SPACE.peak_quantities),
    }
    assert list(variables) == [q.name for group in groups.values() for q in group]
    for causality, group in groups.items():
        for q in group:
            v = variables[q.name]
            assert (v.causality, v.description) == (causality, q.meaning)
            assert v.unit == ((q.unit or "1") if q.kind == "real" else None)
    vehicle = five_legs()
    assert float(variables["vehicle.cg_offset_z"].start) == vehicle["vehicle.cg_offset_z"]
    of_fmi3 = {v.name: v for v in fmpy.read_model_description(str(space_fmu3)).modelVariables}
    assert set(of_fmi3) == {whole_name(name) for name in variables} | {"time"}
    assert [int(d.start) for d in of_fmi3["leg.footpad.z"].dimensions] == [5]


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_fmpy_lands_it_to_the_very_digits_of_landing(fmi, space_fmu, space_fmu3):
    names = list(SPACE.output_names)
    wanted = names if fmi == "2" else list(dict.fromkeys(map(whole_name, names)))
    found = fmpy.simulate_fmu(
        str(space_fmu if fmi == "2" else space_fmu3),
        stop_time=0.4,
        output_interval=2e-3,
        output=wanted,
    )
    history = Landing(five_legs()).run(0.4, 2e-3)
    assert history["leg[1].main_strut.force"].min() < -2000.0
    for name in names:
        column = found[name] if fmi == "2" else found[whole_name(name)]
        if column.ndim == 2:
            column = column[:, int(name[4]) - 1]
        assert np.array_equal(column, history[name]), name


def test_a_deck_that_moves_in_all_directions_acts_as_in_landing_and_a_state_holds_it(instance):
    landing = Landing(five_legs(), inputs=DECK)
    instance.start(**DECK)
    vrs = [instance.vr[name] for name in SEEN]
    assert instance.slave.getReal(vrs) == [landing.get(name) for name in SEEN]

    def go(first: int, last: int) -> list[float]:
        for k in range(first, last):
            instance.set("ground.surge", 1e-3 * k)
            instance.set("ground.yaw", 1e-4 * k)
            instance.steps(k, k + 1)
        return instance.slave.getReal(vrs)

    go(0, 150)
    state = instance.slave.serializeFMUstate(instance.slave.getFMUState())
    ended = go(150, 300)
    for k in range(300):
        landing.set_inputs({"ground.surge": 1e-3 * k, "ground.yaw": 1e-4 * k})
        landing.advance_to(k * 1e-3 + 1e-3)
    assert ended == [landing.get(name) for name in SEEN]
    peaks, extremes = SPACE.peaks, landing.extremes()
    assert instance.slave.getReal([instance.vr[p.value.name] for p in peaks]) == [
        extremes[p.output].minimum if p.side == "min" else extremes[p.output].maximum for p in peaks
    ]
    instance.slave.setFMUState(instance.slave.deSerializeFMUstate(state))
    assert instance.slave.getReal(vrs) != ended
    assert go(150, 300) == ended


def test_events_of_all_five_legs_are_found_where_landing_finds_them(instance3):
    instance3.start()
    instance3.slave.enterStepMode()
    found, now = [], 0.0
    while now < 0.5:
        status, event, early, now = instance3.step(now, 0.5 - now)
        assert status == OK
        if early:
            found.append(now)
        if event:
            instance3.slave.enterEventMode()
            instance3.slave.enterStepMode()
    landing, times = Landing(five_legs()), []
    while landing.time < 0.5:
        if landing.advance_within_step(0.5, 0.5, to_event=True):
            times.append(landing.time)
    assert found == times
    touched = [0.0] * 5
    scan = Landing(five_legs())
    for before, after in pairwise([*times, 0.5]):
        scan.advance_to(0.5 * (before + after))
        touched = [max(t, scan.get(f"leg[{leg}].contact.active")) for t, leg in zip(touched, LEGS)]
    assert touched == [1.0] * 5


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("drop.mode", "2-2", "drop.mode = 2-2 has other inputs and outputs than this FMU"),
        ("vehicle.legs", 4.0, "vehicle.legs = 4 has other outputs than this FMU, which is of 5"),
        ("drop.tilt", radians(-170.0), "drop.tilt"),
    ],
)
def test_what_it_cannot_land_is_refused_in_one_line_and_another_value_taken(
    instance, name, value, reason
):
    instance.slave.setupExperiment(startTime=0.0)
    instance.slave.enterInitializationMode()
    if isinstance(value, str):
        was = instance.slave.getString([instance.vr[name]])[0]
        instance.slave.setString([instance.vr[name]], [value])
    else:
        was = instance.get(name)
        instance.set(name, value)
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert reason in instance.reason()
    assert "\n" not in instance.reason()
    if isinstance(was, bytes):
        texts = (c_char_p * 1)(was)
        assert instance.status("fmi2SetString", refs(instance.vr[name]), 1, texts) == OK
    else:
        instance.set(name, was)
    assert instance.status("fmi2ExitInitializationMode") == OK


def test_the_planar_fmu_refuses_a_landing_in_space_in_one_line(fmu, tmp_path):
    folder = Path(fmpy.extract(str(fmu), str(tmp_path / "fmu")))
    instance = Instance(fmpy.read_model_description(str(fmu)), folder)
    instance.slave.setupExperiment(startTime=0.0)
    instance.slave.enterInitializationMode()
    instance.slave.setString([instance.vr["drop.mode"]], ["space"])
    assert instance.status("fmi2ExitInitializationMode") == ERROR
    assert "drop.mode = space has other inputs and outputs than this FMU" in instance.reason()
    instance.free()
