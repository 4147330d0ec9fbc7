"""The report of an identification: the fit, the free numbers, and the conditions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..parameters import Parameters
from ..quantities import MODES
from ..validation.paper import LEVELS
from .counting.soft_count import TOLERANCE
from .determination import determinations
from .identify import Search
from .measured.series import CurveFit
from .objective import Objective
from .search_folder import Best
from .targets import Fit, fit_of, paper_targets, targets_of_tests


def write_report(search: Search, parameters: Parameters) -> str:
    """The report as Markdown; `parameters` are those of the best point.

    Raises:
        LandingError: A landing cannot be run or read.
    """
    objective = search.objective
    lines = ["# Identification", "", _search_text(search.best), ""]
    if objective.targets:
        lines += _fit_lines(objective, parameters)
    if objective.series:
        lines += _curve_lines(objective, parameters)
    lines += _determination_lines(search)
    if objective.conditions:
        lines += _condition_lines(objective, parameters)
    return "\n".join(lines) + "\n"


def short_report(objective: Objective, parameters: Parameters) -> list[str]:
    """The fit in a line for all scalars, and one for each curve.

    Raises:
        LandingError: A landing cannot be run or read.
    """
    lines = []
    if objective.targets:
        fits = fit_of(parameters, objective.targets, sensors=objective.sensors)
        within = _counted(np.array([f.error for f in fits]))
        lines.append(f"scalars within 5 / 10 / 20 %: {within}")
    lines += [
        f"{c.mode}: {c.name}: RMS {c.rms:.4g} {c.unit}".rstrip() + f" ({100 * c.relative:.1f} %)"
        for c in _curve_fits(objective, parameters)
    ]
    return lines


def _search_text(best: Best) -> str:
    text = (
        f"rlv-landing {__version__}, seed {best.seed}, {best.evaluations} evaluations of the "
        f"landings; loss {best.start_loss:.2f} at the start, {best.loss:.2f} at the best point "
        f"(from the {best.stage})."
    )
    if best.counting:
        text += (
            f" {best.counted} of them counted misses: {best.start_missed:.2f} at the start, "
            f"{best.missed:.2f} at the best point."
        )
    return (
        f"{text} The loss is the sum of ln(1 + misfit^2), a misfit of one being "
        f"{100 * TOLERANCE:g} % of a scalar, or an RMS of so much of a curve's own."
    )


def _fit_lines(objective: Objective, parameters: Parameters) -> list[str]:
    fits = fit_of(parameters, objective.targets, sensors=objective.sensors)
    through = ", read through the tests' sensor chain" if objective.sensors else ""
    beside = (
        f"{len(objective.free)} free numbers stand beside {len(fits)} scalars{through}: "
        "what follows is a fit, not a prediction."
    )
    lines = [beside, "", f"Scalars within 5 / 10 / 20 %: {counted_both_ways(fits)}.", ""]
    if predicted := _other_mode_predicted(parameters, objective):
        lines += [predicted, ""]
    lines += [
        "## Fit of every scalar",
        "",
        "| scalar | unit | wanted | ours | residual | error | plain error | weight |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {f.wanted.label} | {f.wanted.unit} | {f.wanted.value:g} | {f.ours:.4g} "
        f"| {f.ours - f.wanted.value:+.3g} | {100 * f.error:+.1f} % "
        f"| {100 * f.plain_error:+.1f} % | {f.wanted.weight:g} |"
        for f in fits
    ]
    return [*lines, ""]


def _curve_fits(objective: Objective, parameters: Parameters) -> list[CurveFit]:
    return [
        fit
        for s in objective.series
        for fit in s.fits(objective.landing(parameters, s.mode).history)
    ]


def _curve_lines(objective: Objective, parameters: Parameters) -> list[str]:
    lines = [
        "## Fit of every curve",
        "",
        "Differences are ours - measured, over all samples; relative is to the curve's own RMS.",
        "",
        "| curve | unit | samples | RMS | largest | relative |",
        "|---|---|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {c.mode}: {c.name} | {c.unit} | {c.samples} | {c.rms:.4g} | {c.largest:.4g} "
        f"| {100 * c.relative:.1f} % |"
        for c in _curve_fits(objective, parameters)
    ]
    return [*lines, ""]


def counted_both_ways(fits: list[Fit]) -> str:
    """The counts on the scalars' scales, and by the plain relative error of every scalar."""
    on_scale = _counted(np.array([f.error for f in fits]))
    plain = _counted(np.array([f.plain_error for f in fits]))
    printed = all(f.wanted.printed for f in fits)
    scale = "near-zero scalars on their curve's scale" if printed else "on their scales"
    return f"**{on_scale}** ({scale}; by the plain relative error {plain})"


def _counted(errors: NDArray[np.float64]) -> str:
    """`36 / 41 / 45 of 48` within 5, 10, 20 %."""
    within = (int((np.abs(errors) <= level / 100.0).sum()) for level in LEVELS)
    return f"{' / '.join(map(str, within))} of {len(errors)}"


def _other_mode_predicted(parameters: Parameters, objective: Objective) -> str:
    """A sentence on the paper's other landing mode; empty if both or other numbers were fitted.

    It lands with this vehicle and the fitted mode's touchdown state. Table 2 gives both drop tests
    the same state, so that nothing of the other mode enters the prediction.
    """
    if len(objective.modes) != 1 or not objective.of_paper:
        return ""
    (fitted,) = objective.modes
    (other,) = (m for m in MODES if m != fitted)
    drop = {
        name: value
        for name, value in parameters.for_mode(fitted).items()
        if name.startswith("drop.") and name != "drop.mode"
    }
    printed = targets_of_tests() if objective.sensors else paper_targets()
    fits = fit_of(
        parameters.with_mode_values({other: drop}, "identified"),
        [t for t in printed if t.mode == other],
        sensors=objective.sensors,
    )
    return (
        f"Prediction of {other}, none of whose scalars was used, from this vehicle and "
        f"{fitted}'s touchdown state: {counted_both_ways(fits)}."
    )


def _determination_lines(search: Search) -> list[str]:
    deviation = (
        "Deviation: posterior standard deviation as a part of the bounds' width, "
        "by the Jacobian there"
    )
    lines = [
        "## How well each number is determined",
        "",
        f"{deviation} (0.29: the prior alone).",
        "",
        "| number | unit | value | bounds | deviation | verdict | moves with | most sensitive |",
        "|---|---|---:|---|---:|---|---|---|",
    ]
    for d in determinations(search):
        moves = f"{d.partner} ({d.correlation:+.2f})"
        lines.append(
            f"| {d.label} | {d.unit} | {d.value:.4g} | {d.lo:g} ... {d.hi:g} | {d.deviation:.3f} "
            f"| {d.verdict} | {moves} | {d.scalar} |"
        )
    return lines


def _condition_lines(objective: Objective, parameters: Parameters) -> list[str]:
    modes = objective.modes
    histories = [objective.landing(parameters, mode).history for mode in modes]
    lines = [
        "",
        "## Conditions",
        "",
        f"| condition | at most | {' | '.join(modes)} | because |",
        "|---|---|" + "---|" * len(modes) + "---|",
    ]
    for c in objective.conditions:
        found = " | ".join(f"{c.measure(h):.3g} {c.unit}".rstrip() for h in histories)
        lines.append(f"| {c.name} | {c.limit:g} {c.unit} | {found} | {c.reason} |")
    return lines
