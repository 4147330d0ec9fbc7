"""Dependencies of outputs and initial values in the description.

They are compared with what the model does when an input or a parameter changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from itertools import pairwise, product
from zipfile import ZipFile

import numpy as np
from lxml import etree

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import INPUT_QUANTITIES, LEGS, MODES, OUTPUT_NAMES, OUTPUT_QUANTITIES

FIGURES = "yue2022-figures"
SCALE = {q.name: q.nominal if q.kind == "real" else 1.0 for q in OUTPUT_QUANTITIES}
# large enough to lift footpads off the ground or put them on it, and to move a vehicle at rest
STEPS = dict(zip((q.name for q in INPUT_QUANTITIES), (1e4, 1e4, 1e3, 0.05, 1.0, 0.05, 1.0)))
# charged struts, a deep damping layer, and a flight in which each of its parameters counts
MOVED = {
    "drop.tilt": 0.1,
    "drop.pitch_rate": 0.5,
    "drop.contact_time": 0.05,
    "ground.slope": 0.09,
    "ground.damping_depth": 0.05,
    "ground.stick_damping": 100.0,
    "main_strut.charge_pressure": 2e6,
}
LOADS = {
    "external.force_x": 500.0,
    "external.force_y": -300.0,
    "external.moment": 50.0,
    "ground.heave_rate": 0.3,
    "ground.tilt_rate": 0.05,
}
# standing on the ground at less than 2 mm/s
STANDING = {
    **MOVED,
    "drop.contact_time": 1e-4,
    "drop.pitch_rate": 1e-4,
    "drop.vertical_velocity": -1e-3,
    "drop.horizontal_velocity": 5e-4,
}


def declared(unknowns) -> dict[str, set[str]]:
    """Names that each unknown depends on; a missing attribute would mean all of them."""
    assert all(u.dependencies is not None for u in unknowns)
    return {u.variable.name: {d.name for d in u.dependencies} for u in unknowns}


def changed(before: list[float], after: list[float]) -> set[str]:
    """Outputs that differ by more than rounding: a billionth of their nominal value."""
    return {
        name for name, a, b in zip(OUTPUT_NAMES, before, after) if abs(a - b) > 1e-9 * SCALE[name]
    }


def record(found: dict[str, set[str]], cause: str, outputs: Iterable[str]) -> None:
    for name in outputs:
        found[name].add(cause)


def observe_inputs(landing: Landing, found: dict[str, set[str]]) -> None:
    """Change one input after the other, without a step, and record which outputs change."""
    state, before = landing.state(), landing.values()
    for name, sign in product(STEPS, (1.0, -1.0)):
        landing.restore(state)
        landing.set_inputs({name: sign * STEPS[name]})
        record(found, name, changed(before, landing.values()))
    landing.restore(state)


def test_outputs_depend_at_once_on_the_inputs_that_are_declared_and_on_no_other(description):
    """From free flight to rest: a landing at rest is where a load changes the phase at once."""
    found: dict[str, set[str]] = {name: set() for name in OUTPUT_NAMES}
    for mode in MODES:
        landing = Landing(load_preset(FIGURES, mode))
        for time in (0.05, 0.12, 0.2, 0.35, 0.6, 3.0):
            landing.advance_to(time)
            observe_inputs(landing, found)
        assert landing.get("status.phase") == 2.0
    assert [u.variable.name for u in description.outputs] == list(OUTPUT_NAMES)
    assert declared(description.outputs) == found


def start(values: dict[str, float | str], inputs: dict[str, float]) -> list[float]:
    """The outputs at time 0."""
    landing = Landing(Parameters().with_values(values))
    landing.set_inputs(inputs)
    return landing.values()


def others(name: str, value: float | str) -> list[float | str]:
    """Values of a parameter near `value`, or its other choices."""
    q = PARAMETER_QUANTITIES[name]
    if isinstance(value, str):
        return [c for c in q.choices if c != value]
    near = [value * 1.01 + (1e-4 if value == 0.0 else 0.0), value * 0.99]
    return [v for v in near if q.lo <= v <= q.hi]


def observe_parameters(
    values: dict[str, float | str],
    inputs: dict[str, float],
    record_changes: Callable[[str, set[str]], None],
) -> None:
    """Change one parameter after the other and record which outputs change at time 0."""
    base, before = Parameters().with_values(values), start(values, inputs)
    for name in PARAMETER_QUANTITIES:
        for value in others(name, base[name]):
            record_changes(name, changed(before, start({**values, name: value}, inputs)))


def raised(values: dict[str, float | str], leg: int, depth: float) -> dict[str, float]:
    """The lift of the ground [m] at which the footpad of `leg` is `depth` [m] in it at time 0."""
    landing = Landing(Parameters().with_values(values))
    slope = landing.parameters.ground.slope
    return {
        "ground.heave": (landing.get(f"leg[{leg}].contact.penetration") - depth) / -math.cos(slope)
    }


def deepest(values: dict[str, float | str]) -> dict[str, float]:
    """The lift of the ground [m] at which every footpad is at least 5 mm in it."""
    return {"ground.heave": max(raised(values, leg, 5e-3)["ground.heave"] for leg in LEGS)}


def loads_at_the_limit_of_rest(values: dict[str, float | str]) -> dict[str, float]:
    """Inputs at which the body's accelerations are just below the limit of a vehicle at rest.

    In sum they are below 0.05 by 5e-11.
    """
    names = ("external.force_x", "external.force_y", "external.moment")
    lifted = deepest(values)

    def accelerations(loads: Iterable[float]) -> np.ndarray:
        out = dict(zip(OUTPUT_NAMES, start(values, {**lifted, **dict(zip(names, loads))})))
        return np.array([out["body.ax"], out["body.ay"], out["body.pitch_acceleration"]])

    target, loads = np.array([0.02, 0.02, 0.01 - 5e-11]), np.zeros(3)
    for _ in range(2):
        now = accelerations(loads)
        gains = np.array(
            [(accelerations(loads + 100.0 * row) - now) / 100.0 for row in np.eye(3)]
        ).T
        loads = loads + np.linalg.solve(gains, target - now)
    return {**lifted, **dict(zip(names, loads.tolist()))}


def test_initial_values_depend_on_the_parameters_and_inputs_that_are_declared_and_on_no_other(
    description,
):
    found: dict[str, set[str]] = {name: set() for name in OUTPUT_NAMES}
    for mode, where in product(MODES, PARAMETER_QUANTITIES["vehicle.transverse_load_at"].choices):
        choice: dict[str, float | str] = {"drop.mode": mode, "vehicle.transverse_load_at": where}
        values = {**MOVED, **choice}
        observe_parameters(
            values, {**LOADS, **deepest(values)}, lambda name, outputs: record(found, name, outputs)
        )
        standing = {**STANDING, **choice}
        loaded = loads_at_the_limit_of_rest(standing)
        assert dict(zip(OUTPUT_NAMES, start(standing, loaded)))["status.phase"] == 2.0
        observe_parameters(
            standing, loaded, lambda name, outputs: record(found, name, outputs & {"status.phase"})
        )
        for leg in LEGS:
            active = f"leg[{leg}].contact.active"
            just = {**LOADS, **raised(values, leg, 1e-11)}
            observe_parameters(
                values,
                just,
                lambda name, outputs, active=active: record(found, name, outputs & {active}),
            )
        for values_at_start, inputs in (
            (values, {}),
            (values, deepest(values)),
            (standing, loaded),
        ):
            landing = Landing(Parameters().with_values(values_at_start))
            landing.set_inputs(inputs)
            observe_inputs(landing, found)
    assert [u.variable.name for u in description.initialUnknowns] == list(OUTPUT_NAMES)
    assert declared(description.initialUnknowns) == found


def test_dependencies_stand_in_ascending_order(fmu):
    for text in etree.fromstring(ZipFile(fmu).read("modelDescription.xml")).xpath(
        "//Unknown/@dependencies"
    ):
        assert all(a < b for a, b in pairwise(int(number) for number in text.split()))
