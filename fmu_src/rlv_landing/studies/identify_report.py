"""What an identification came to: the fit, numbers at their bounds, and how well each number is determined."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..parameters import Parameters
from ..quantities import MODES
from .identify import Search, folded
from .objective import TOLERANCE, Fit, Objective, fit_of, landed, paper_targets, targets_of_tests

AT_BOUND = 0.01
# the standard deviation of a uniform prior on [0, 1]: a number not known better than that is not identified
UNINFORMED = 12.0**-0.5
WELL, POORLY = 0.05, 0.15


@dataclass(frozen=True)
class Determination:
    """How well the misfits determine one number: posterior standard deviation as a part of the prior's width, and what moves with it."""

    label: str
    value: float
    lo: float
    hi: float
    z: float
    deviation: float
    partner: str
    correlation: float
    scalar: str

    @property
    def verdict(self) -> str:
        """In words."""
        if self.z < AT_BOUND or self.z > 1.0 - AT_BOUND:
            return "at its bound"
        if self.deviation > 0.8 * UNINFORMED:
            return "not identifiable"
        return "well determined" if self.deviation < WELL else "determined" if self.deviation < POORLY else "poorly determined"


def determinations(search: Search) -> list[Determination]:
    """From the Jacobian at the best point: covariance (J'J/s2 + prior)^-1 with Cauchy's weights, on the unit cube.

    Gaussian approximation, valid near the point only; s2 is 1 or the mean weighted misfit squared, where that is larger.
    """
    z = folded(search.best.z)
    (misfits,) = search.look([z.tolist()])
    jacobian = search.jacobian(z)
    weights = 1.0 / (1.0 + misfits**2)
    spread = max(1.0, float((weights * misfits**2).sum() / weights.sum()))
    information = (jacobian.T * weights) @ jacobian / spread + np.eye(len(z)) / UNINFORMED**2
    covariance = np.linalg.inv(information)
    deviation = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(deviation, deviation)
    np.fill_diagonal(correlation, 0.0)
    labels = search.objective.free.labels
    strongest = np.argmax(np.abs(jacobian) * np.sqrt(weights)[:, None], axis=0)
    found = []
    for i, ((prior, _), value) in enumerate(zip(search.objective.free.columns, search.objective.free.numbers(z.tolist()))):
        j = int(np.argmax(np.abs(correlation[i])))
        found.append(
            Determination(labels[i], value, prior.lo, prior.hi, float(z[i]), float(deviation[i]), labels[j],
                          float(correlation[i, j]), search.objective.labels[int(strongest[i])])
        )  # fmt: skip
    return found


def counted(errors: NDArray[np.float64]) -> str:
    """`36 / 41 / 45 of 48` within 5, 10, 20 %."""
    within = [int((np.abs(errors) <= p).sum()) for p in (0.05, 0.10, 0.20)]
    return f"{within[0]} / {within[1]} / {within[2]} of {len(errors)}"


def counted_both_ways(fits: list[Fit]) -> str:
    """The counts, near-zero scalars on their curve's scale, and by the plain relative error of every scalar."""
    on_scale, plain = (counted(np.array(errors)) for errors in zip(*[(f.error, f.plain_error) for f in fits]))
    return f"**{on_scale}** (near-zero scalars on their curve's scale; by the plain relative error {plain})"


def other_mode_predicted(parameters: Parameters, objective: Objective) -> str:
    """A sentence on the landing mode that was not fitted, with this vehicle and the fitted mode's touchdown state; empty if both were.

    Table 2 gives both drop tests the same state, so that nothing of the other mode enters the prediction.
    """
    if len(objective.modes) != 1:
        return ""
    (fitted,) = objective.modes
    (other,) = (m for m in MODES if m != fitted)
    drop = {name: value for name, value in parameters.for_mode(fitted).items() if name.startswith("drop.") and name != "drop.mode"}
    wanted = [t for t in (targets_of_tests() if objective.sensors else paper_targets()) if t.mode == other]
    predicted = fit_of(parameters.with_mode_values({other: drop}, "identified"), wanted, sensors=objective.sensors)
    return f"Prediction of {other}, none of whose scalars was used, from this vehicle and {fitted}'s touchdown state: " + (
        counted_both_ways(predicted) + "."
    )


def write_report(search: Search, parameters: Parameters) -> str:
    """The report as Markdown."""
    objective, best = search.objective, search.best
    counting = (
        f" {best.counted} of them counted misses: {search.start_missed:.2f} at the start, {best.missed:.2f}." if search.counting else ""
    )
    story = (
        f"rlv-landing {__version__}, seed {best.seed}, {best.evaluations} evaluations of the landings; "
        f"loss {search.start_loss:.2f} at the start, {best.loss:.2f} at the best point (from the {best.stage}).{counting} "
        f"The loss is the sum of ln(1 + misfit^2), a misfit of one being {100 * TOLERANCE:g} % of a scalar."
    )
    lines = ["# Identification", "", story, ""]
    if objective.targets:
        lines += _fit_lines(objective, parameters)
    lines += _determination_lines(search)
    if objective.conditions:
        lines += _condition_lines(objective, parameters)
    return "\n".join(lines) + "\n"


def _fit_lines(objective: Objective, parameters: Parameters) -> list[str]:
    fits = fit_of(parameters, objective.targets, sensors=objective.sensors)
    read = ", read through the tests' sensor chain" if objective.sensors else ""
    lines = [f"{len(objective.free)} free numbers stand beside {len(fits)} scalars{read}: what follows is a fit, not a prediction.", ""]
    lines += [f"Scalars within 5 / 10 / 20 %: {counted_both_ways(fits)}.", ""]
    predicted = other_mode_predicted(parameters, objective)
    lines += [predicted, ""] if predicted else []
    lines += ["## Fit of every scalar", "", "| scalar | wanted | ours | error | plain error |", "|---|---:|---:|---:|---:|"]
    for f in fits:
        lines.append(f"| {f.wanted.id} | {f.wanted.value:g} | {f.ours:.4g} | {100 * f.error:+.1f} % | {100 * f.plain_error:+.1f} % |")
    return [*lines, ""]


def _determination_lines(search: Search) -> list[str]:
    lines = ["## How well each number is determined", ""]
    lines += [
        "Deviation: posterior standard deviation as a part of the bounds' width, by the Jacobian there (0.29: the prior alone).",
        "",
    ]
    lines += ["| number | value | bounds | deviation | verdict | moves with | most sensitive |", "|---|---:|---|---:|---|---|---|"]
    for d in determinations(search):
        moves = f"{d.partner} ({d.correlation:+.2f})"
        lines.append(f"| {d.label} | {d.value:.4g} | {d.lo:g} ... {d.hi:g} | {d.deviation:.3f} | {d.verdict} | {moves} | {d.scalar} |")
    return lines


def _condition_lines(objective: Objective, parameters: Parameters) -> list[str]:
    modes = objective.modes
    histories = [landed(parameters, mode) for mode in modes]
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
