"""Dependencies of outputs and initial values in the description.

They are compared with what the model does when an input or a parameter changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise, product
from zipfile import ZipFile

from lxml import etree

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.quantities import INPUT_QUANTITIES, MODES, OUTPUT_NAMES, OUTPUT_QUANTITIES

# of the symmetric landings
TABLE = parameters_of(min(MODES))
FIGURES = "yue2022-figures"
SCALE = {q.name: q.nominal if q.kind == "real" else 1.0 for q in OUTPUT_QUANTITIES}
# large enough to move a vehicle at rest
STEPS = dict(zip((q.name for q in INPUT_QUANTITIES), (1e4, 1e4, 1e3, 0.05, 1.0, 0.05, 1.0)))
# small enough that the vehicle can still land on the moving ground
START_STEPS = {**STEPS, "ground.heave_rate": 0.2, "ground.tilt_rate": 0.05}
# charged struts, and a flight in which each of its parameters counts
MOVED = {
    "drop.tilt": 0.1,
    "drop.pitch_rate": 0.5,
    "drop.contact_time": 0.05,
    "ground.slope": 0.09,
    "main_strut.charge_pressure": 2e6,
    "auxiliary_strut.play_tension": 5e-3,
}
LOADS_AND_GROUND = {
    "external.force_x": 500.0,
    "external.force_y": -300.0,
    "external.moment": 50.0,
    "ground.heave": 0.1,
    "ground.heave_rate": 0.3,
    "ground.tilt": 0.03,
    "ground.tilt_rate": 0.05,
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


def observe_inputs(
    landing: Landing, found: dict[str, set[str]], steps: dict[str, float] = STEPS
) -> None:
    """Change one input after the other, without a step, and record which outputs change."""
    state, before = landing.state(), landing.values()
    for name, sign in product(steps, (1.0, -1.0)):
        landing.restore(state)
        landing.set_inputs({name: sign * steps[name]})
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
    return Landing(Parameters().with_values(values), inputs=inputs).values()


def others(name: str, value: float | str) -> list[float | str]:
    """Values of a parameter near `value`, or its other choices."""
    q = TABLE[name]
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
    for name in TABLE:
        for value in others(name, base[name]):
            record_changes(name, changed(before, start({**values, name: value}, inputs)))


def at_the_limit_of_standing(values: dict[str, float | str]) -> dict[str, float | str]:
    """The `values` with a pitch just below that at which the vehicle's CG is beyond its footpads.

    The CG is at most 1 um short of its outermost footpad.
    """
    index = OUTPUT_NAMES.index("status.stability_margin")
    stands, topples = 0.1, 1.4
    while topples - stands > 1e-7:
        middle = 0.5 * (stands + topples)
        margin = start({**values, "drop.tilt": middle}, {})[index]
        stands, topples = (middle, topples) if margin > 0.0 else (stands, middle)
    return {**values, "drop.tilt": stands}


def test_initial_values_depend_on_the_parameters_and_inputs_that_are_declared_and_on_no_other(
    description,
):
    found: dict[str, set[str]] = {name: set() for name in OUTPUT_NAMES}
    for mode, where in product(MODES, PARAMETER_QUANTITIES["vehicle.transverse_load_at"].choices):
        choice: dict[str, float | str] = {"drop.mode": mode, "vehicle.transverse_load_at": where}
        for values in ({**MOVED, **choice}, at_the_limit_of_standing({**MOVED, **choice})):
            for inputs in ({}, LOADS_AND_GROUND):
                observe_parameters(
                    values, inputs, lambda name, outputs: record(found, name, outputs)
                )
                landing = Landing(Parameters().with_values(values), inputs=inputs)
                observe_inputs(landing, found, START_STEPS)
    assert [u.variable.name for u in description.initialUnknowns] == list(OUTPUT_NAMES)
    assert declared(description.initialUnknowns) == found


def test_dependencies_stand_in_ascending_order(fmu):
    for text in etree.fromstring(ZipFile(fmu).read("modelDescription.xml")).xpath(
        "//Unknown/@dependencies"
    ):
        assert all(a < b for a, b in pairwise(int(number) for number in text.split()))
