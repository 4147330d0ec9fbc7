"""Values that landings of the presets give: seconds at most."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TypeVar

import numpy as np
from directions import beyond_symmetric, heading_load, worst_heading
from marks import Value

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_landing.identification.conditions import CONDITIONS
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.targets import Fit, fit_of, paper_targets, targets_of_tests
from rlv_landing.landing import DEFAULT_RTOL
from rlv_landing.outputs import Extreme
from rlv_landing.presets import preset_names
from rlv_landing.quantities import LEGS, MODES, PEAKS
from rlv_landing.sizing import LIKE, leg_geometry, size_damper, size_vehicle
from rlv_landing.studies.envelope.tip_over import RigidBlock
from rlv_landing.studies.montecarlo.run import STEP
from rlv_landing.studies.sweep.responses import expand
from rlv_landing.touchdown import footpad_at_rest
from rlv_landing.validation.paper import LEVELS, paper_counts_against_test, printed_scalars
from rlv_landing.validation.validate import Validation, validate

Compute = TypeVar("Compute", bound=Callable[..., float | str])

FIGURES = "yue2022-figures"
QUICK: dict[str, Value] = {}
# the strut that the auxiliary strut is compared with: aluminium of this cross-section
ALUMINIUM, SECTION = 70e9, 5.91e-4


def quick(compute: Compute) -> Compute:
    """Register a quick value under its name."""
    QUICK[compute.__name__] = Value(compute, slow=False)
    return compute


for of_heading in (heading_load, worst_heading, beyond_symmetric):
    quick(of_heading)


@lru_cache
def found(preset: str = FIGURES, transverse: str = "") -> Validation:
    """The validation of a preset, with `vehicle.transverse_load_at` changed if it is given."""
    parameters = load_preset(preset)
    if transverse:
        parameters = parameters.with_values({"vehicle.transverse_load_at": transverse})
    return validate(parameters)


def landing(mode: str, preset: str = FIGURES) -> History:
    """A preset's drop test of `mode` at 5 kHz."""
    return found(preset).histories[mode]


def largest(column: str) -> float:
    """The largest value of a leg's column in both drop tests."""
    return max(
        float(landing(mode)[f"leg[{leg}].{column}"].max())
        for mode in ("2-2", "1-2-1")
        for leg in LEGS
    )


@quick
def counts(against: str = "simulation", transverse: str = "") -> str:
    """Printed scalars within 5 / 10 / 20 %: of the simulation, the test, or the paper's own."""
    if against == "paper":
        n = paper_counts_against_test()
    else:
        both = found(FIGURES, transverse)
        n = {
            "simulation": both.counts,
            "test": both.counts_against_test,
            "sensed": both.counts_against_test_sensed,
        }[against]
    return f"{n['within_5']} / {n['within_10']} / {n['within_20']}"


@quick
def sized(like: str, what: str, factor: str) -> float:
    """A number of a vehicle's sized damper, times a factor."""
    needs = LIKE[like]
    return float(factor) * float(getattr(size_damper(needs, leg_geometry(needs)), what))


@quick
def landed(like: str, what: str, factor: str) -> float:
    """The largest force or stroke of a sized vehicle's struts, landed level, times a factor."""
    history = Landing(size_vehicle(LIKE[like])).run(3.0)
    return float(factor) * float(np.abs(history[f"leg[1].main_strut.{what}"]).max())


@quick
def responses() -> float:
    """The responses that a sweep has if its study names none."""
    return float(len(expand(None)))


@quick
def montecarlo_step() -> float:
    """The runs of a Monte Carlo after which it is looked whether they are enough."""
    return float(STEP)


@quick
def plain_counts() -> str:
    """Printed scalars within 5 / 10 / 20 % of the simulation by the plain relative error."""
    return within(fit_of(load_preset(FIGURES), paper_targets()), plain=True)


@quick
def counts_of_tests(rule: str = "scale", mode: str = "") -> str:
    """What yue2022-tests reaches of the tests, through the sensors: in both modes, or in one."""
    fits = fit_of(load_preset("yue2022-tests"), targets_of_tests(), sensors=True)
    return within([f for f in fits if mode in ("", f.wanted.mode)], plain=rule == "plain")


def within(fits: Sequence[Fit], *, plain: bool) -> str:
    """Numbers wanted that are within 5 / 10 / 20 %; none that a landing lacks."""
    errors = [abs(f.plain_error if plain else f.error) for f in fits]
    return " / ".join(str(sum(e <= level / 100.0 for e in errors)) for level in LEVELS)


@quick
def free_numbers(*modes: str) -> float:
    """The numbers that an identification with these landing modes varies (both: none named)."""
    return float(len(FreeNumbers(load_preset(FIGURES), modes=modes or tuple(MODES))))


@quick
def value(name: str, mode: str = "2-2", preset: str = FIGURES) -> float:
    """A parameter of a preset [SI]."""
    return float(load_preset(preset, mode)[name])


@quick
def scalars(against: str = "simulation") -> float:
    """The number of printed scalars, or of those with a test."""
    printed = printed_scalars()
    return float(
        len(printed) if against == "simulation" else sum(s.test == s.test for s in printed)
    )


@quick
def scalar(name: str) -> float:
    """Our value of a printed scalar, in its unit."""
    return float(next(c.ours for c in found().all_comparisons if c.scalar.id == name))


@quick
def printed(name: str) -> float:
    """The paper's simulation of a scalar, in its unit."""
    return float(next(s.simulation for s in printed_scalars() if s.id == name))


@quick
def off(name: str) -> float:
    """The magnitude of a scalar's error against the paper's simulation [%]."""
    return next(100.0 * abs(c.error) for c in found().all_comparisons if c.scalar.id == name)


@quick
def early(name: str) -> float:
    """By how much an event comes before the paper's [ms]."""
    return 1e3 * (printed(name) - scalar(name))


@quick
def worse_than(percent: str) -> float:
    """The number of scalars that deviate by more than so many per cent."""
    return float(sum(100.0 * abs(c.error) > float(percent) for c in found().all_comparisons))


@quick
def created(mode: str) -> float:
    """Energy that the transverse load creates in 1 s where it acts at the joint [J]."""
    return float(found(FIGURES, "joint").histories[mode]["energy.work_transverse"][-1])


@quick
def dissipated(mode: str) -> float:
    """Energy that is dissipated in 1 s with the transverse load at the joint [J]."""
    return float(found(FIGURES, "joint").histories[mode]["energy.dissipated"][-1])


@quick
def auxiliary_load() -> float:
    """The auxiliary struts' largest load [N]."""
    return max(
        float(np.abs(landing(mode)[f"leg[{leg}].auxiliary_strut.force"]).max())
        for mode in ("2-2", "1-2-1")
        for leg in LEGS
    )


@quick
def auxiliary_yield() -> float:
    """How far an auxiliary strut yields beyond its joints' play [mm]."""
    (condition,) = (c for c in CONDITIONS if c.name == "auxiliary strut's yield")
    return 1e3 * max(condition.measure(landing(mode)) for mode in ("2-2", "1-2-1"))


@quick
def auxiliary_secant() -> float:
    """The largest load over the largest yield of an auxiliary strut [N/m]."""
    return auxiliary_load() / (1e-3 * auxiliary_yield())


@quick
def softer_than_aluminium() -> float:
    """How many times softer than an aluminium strut an auxiliary strut is at the largest load."""
    return ALUMINIUM * SECTION / load_preset(FIGURES).auxiliary_strut.length / auxiliary_secant()


@quick
def largest_pressure() -> float:
    """The largest pressure of any chamber [MPa]."""
    return 1e-6 * max(largest(f"main_strut.pressure_{c}") for c in ("upper", "lower"))


@quick
def largest_penetration() -> float:
    """The largest penetration of a footpad [mm]."""
    return 1e3 * largest("contact.penetration")


@quick
def over_extension() -> float:
    """The farthest that a damper over-extends [mm]."""
    return -1e3 * min(
        float(landing(mode)[f"leg[{leg}].main_strut.stroke"].min())
        for mode in ("2-2", "1-2-1")
        for leg in LEGS
    )


@quick
def upright() -> float:
    """The time from which on the pitch of both drop tests stays within 0.5 deg of its last [s]."""
    return max(scalar(name) for name in ("22-rest", "121-rest"))


@quick
def interval(preset: str, mode: str, leg: str) -> float:
    """Time from the first contact to that of a leg [ms]."""
    h = landing(mode, preset)
    first, later = (h.time[np.argmax(h[f"leg[{k}].contact.force_y"] > 0.0)] for k in (1, int(leg)))
    return 1e3 * float(later - first)


@quick
def peak_force(mode: str) -> float:
    """The main struts' most negative force, sampled each millisecond [N]."""
    h = Landing(load_preset(FIGURES), mode).run(1.0, 1e-3)
    return min(float(h[f"leg[{leg}].main_strut.force"].min()) for leg in LEGS)


@quick
def height(which: str) -> float:
    """Height of the CG above the feet, of the whole vehicle or of the body alone [m]."""
    p = load_preset(FIGURES)
    return RigidBlock.of(p).height if which == "whole" else -footpad_at_rest(p)[1]


@quick
def loosened(column: str, rtol: str) -> float:
    """How far a leg's curve at the tolerance `rtol` is from that at the default [SI], at most.

    Over both drop tests of the figures' preset.
    """
    far = 0.0
    for mode in MODES:
        usual, loose = (
            Landing(load_preset(FIGURES, mode), rtol=tolerance).run(1.0, 1e-3)
            for tolerance in (DEFAULT_RTOL, float(rtol))
        )
        for leg in LEGS:
            name = f"leg[{leg}].{column}"
            far = max(far, float(np.abs(loose[name] - usual[name]).max()))
    return far


@quick
def peaks_off(rtol: str) -> float:
    """The largest error of a peak at the tolerance `rtol` [%], of all presets and modes."""
    return max(
        100.0
        * max(abs(found.minimum - exact.minimum), abs(found.maximum - exact.maximum))
        / max(abs(exact.minimum), abs(exact.maximum))
        for preset in preset_names()
        for mode in MODES
        for exact, found in zip(extremes(preset, mode, 1e-8), extremes(preset, mode, float(rtol)))
    )


@lru_cache
def extremes(preset: str, mode: str, rtol: float) -> list[Extreme]:
    """The extremes of forces, strokes, pressures and accelerations at a tolerance."""
    landing = Landing(load_preset(preset, mode), rtol=rtol)
    landing.advance_to(1.0)
    outputs = dict.fromkeys(p.output for p in PEAKS if p.output != "status.stability_margin")
    return [landing.extremes()[output] for output in outputs]
