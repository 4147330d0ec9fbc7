"""Dependencies of a landing in space, compared with what the model does.

What is declared may be more than what one vehicle shows, for few outputs.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping

import pytest
from five_legs import DECK, FIVE_LEGS

from fmu_build.dependencies import IN_SPACE, dependencies_of
from rlv_landing import Landing, Parameters
from rlv_landing.parameters import parameters_of, terrain_of
from rlv_landing.quantities import Interface, interface_of

SPACE = interface_of("space", 5)
KIND = "leg.kind"
TURNS = ("roll", "yaw", "tilt")
# texts that say something else than the vehicle's own
TEXTS = {
    "vehicle.leg_azimuths": ["0.1 1.3 2.6 3.9 5.0"],
    "vehicle.body_points": ["0 -1.9 0; 0.3 -1.9 0.3", "0 -2.6 0"],
    "ground.terrain": [
        terrain_of((-3.0, 3.0), (-3.0, 3.0), ((0.2, 0.2), (0.25, 0.2))),
    ],
    # the deck follows the waves' surface
    "sea.operators": ["frequencies 0 9 directions -3 3 operators " + ("1 0 " * 3 + "0 0 " * 3) * 4],
    "vehicle.leg_overrides": [
        "leg[2].main_strut.length = 1.44; leg[3].vehicle.footpad_mass = 6.0",
        "leg[1].ground.step = 0.001; leg[4].main_strut.charge_pressure = 1.5e6",
    ],
}
MOVED = FIVE_LEGS | {
    "vehicle.inertia_xy": 20.0,
    "vehicle.inertia_xz": 15.0,
    "vehicle.inertia_yz": -10.0,
    "vehicle.cg_offset_x": 0.1,
    "vehicle.cg_offset_z": -0.08,
    "drop.tilt": 0.1,
    "drop.pitch_rate": 0.5,
    "drop.roll_rate": 0.6,
    "drop.yaw_rate": -0.8,
    "drop.vertical_velocity": -3.0,
    "drop.contact_time": 0.15,
    "main_strut.charge_pressure": 2e6,
    "auxiliary_strut.play_tension": 5e-3,
    "sea.wave_height": 1.0,
    "sea.direction": 0.7,
    "sea.time": 12.0,
    "sea.seed": 5.0,
    "sea.deck_x": -3.0,
    "sea.deck_y": 5.0,
    "sea.deck_z": 2.0,
}
# rough ground of a seed, which a table leaves no place for
ROUGH = {"ground.terrain": "", "ground.roughness": 0.02, "ground.roughness_length": 2.0}
OF_ROUGH = ("ground.roughness", "ground.roughness_length", "ground.terrain_seed")
# the deck's place and way count in these through the rigid vehicle's attitude, all but not at all
MORE_DECLARED = {"status.phase", "energy.potential", "body.y", "body.q_w", "contact.force_y"}


def of_any_leg(name: str) -> str:
    return re.sub(r"^leg\[\d+\]\.", "", name)


def step_of(name: str, *, start: bool) -> float:
    """A change of an input, large enough to move a vehicle at rest; at the start it still lands."""
    group, what = name.split(".")
    if group == "external":
        return 1e4 if "force" in what else 1e3
    if not what.endswith("_rate"):
        return 0.05
    return (0.05 if what.startswith(TURNS) else 0.2) if start else 1.0


def changed(before: list[float], after: list[float], interface: Interface = SPACE) -> Iterator[str]:
    """Outputs that differ by more than rounding, those of all legs alike."""
    for q, a, b in zip(interface.outputs, before, after):
        if abs(a - b) > 1e-9 * (q.nominal if q.kind == "real" else 1.0):
            yield of_any_leg(q.name)


def observe_inputs(landing: Landing, found: dict[str, set[str]], *, start: bool) -> None:
    state, before = landing.state(), landing.values()
    for name in SPACE.input_names:
        for sign in (1.0, -1.0):
            landing.restore(state)
            landing.set_inputs({name: sign * step_of(name, start=start)})
            for output in changed(before, landing.values(), landing.interface):
                found.setdefault(output, set()).add(name)
    landing.restore(state)


def compare(found: Mapping[str, set[str]], declared: Mapping[str, frozenset[str]]) -> None:
    assert found.keys() == declared.keys()
    for name, causes in found.items():
        assert causes <= declared[name], (name, causes - declared[name])
        assert name in MORE_DECLARED or causes == declared[name], (name, declared[name] - causes)


def test_outputs_depend_at_once_on_the_inputs_that_are_declared():
    found: dict[str, set[str]] = {}
    landing = Landing(Parameters().with_values(FIVE_LEGS))
    for time in (0.05, 0.12, 0.2, 0.324, 0.35, 0.6, 4.0):
        landing.advance_to(time)
        observe_inputs(landing, found, start=False)
    assert landing.get("status.phase") == 2.0
    compare(found, IN_SPACE.inputs_of)


@pytest.fixture(scope="module")
def at_start() -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """The parameters and the inputs that change an output at time 0."""
    return causes_at_start(Parameters().with_values(MOVED), ({}, DECK))


def causes_at_start(
    base: Parameters, decks: Iterable[dict[str, float]]
) -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """The parameters and the inputs that change an output of a vehicle at time 0."""
    parameters: dict[str, set[str]] = {}
    inputs: dict[str, set[str]] = {}
    # these change the outputs' names
    table = {n: q for n, q in parameters_of("space").items() if n not in ("vehicle.legs", KIND)}
    for own in decks:
        for name, q in table.items():
            if name == "vehicle.transverse_load_at" and base.leg.kind == "tripod":
                continue
            whole = base.with_values(ROUGH) if name in OF_ROUGH else base
            before = Landing(whole, inputs=own).values()
            value = whole[name]
            if isinstance(value, str):
                others = [c for c in q.choices if c != value] or TEXTS.get(name, [])
            else:
                # these count by little in the short flight
                part = 0.8 if "inertia" in name or "offset" in name else 0.99
                others = [value * part + 1e-4 * (value == 0.0)]
                others = [1.0] if name == "ground.terrain_seed" else others
            for other in others:
                after = Landing(whole.with_values({name: other}), inputs=own).values()
                for output in changed(before, after, base.interface):
                    parameters.setdefault(output, set()).add(name)
        observe_inputs(Landing(base, inputs=own), inputs, start=True)
    return parameters, inputs


def test_initial_values_depend_on_the_parameters_that_are_declared(at_start):
    found = at_start[0]
    # a vehicle that stands beyond its feet has another phase: not this one
    compare({"status.phase": set(), **found}, IN_SPACE.parameters_of)


def test_initial_values_depend_on_the_inputs_that_are_declared(at_start):
    compare(at_start[1], IN_SPACE.start_inputs_of)


@pytest.mark.torture
@pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="it is long: make torture")
def test_initial_values_on_tripods_depend_on_no_more_than_is_declared():
    base = Parameters().with_values({**MOVED, KIND: "tripod"})
    known = dependencies_of(base.interface)
    parameters, inputs = causes_at_start(base, ({},))
    for found, declared in ((parameters, known.parameters_of), (inputs, known.start_inputs_of)):
        for name, causes in found.items():
            assert causes <= declared[name], (name, causes - declared[name])
    assert "auxiliary_strut.joint_spread" in parameters["footpad.y"]
    assert "auxiliary_strut.transverse_force" not in parameters
