"""What an identification came to: the fit, numbers at their bounds, and how well each number is
determined.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..parameters import Parameters
from .identify import Search, folded
from .objective import TOLERANCE, fit_of

AT_BOUND = 0.01
# the standard deviation of a uniform prior on [0, 1]: a number not known better than that is not
# identified
UNINFORMED = 12.0**-0.5
WELL, POORLY = 0.05, 0.15


@dataclass(frozen=True)
class Determination:
    """How well the misfits determine one number: posterior standard deviation as a part of the
    prior's width, and what moves with it.
    """

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
        return (
            "well determined"
            if self.deviation < WELL
            else "determined"
            if self.deviation < POORLY
            else "poorly determined"
        )


def determinations(search: Search) -> list[Determination]:
    """From the Jacobian at the best point: covariance (J'J/s2 + prior)^-1 with Cauchy's weights, on
    the unit cube.

    Gaussian approximation, valid near the point only; s2 is 1 or the mean weighted misfit squared,
    where that is larger.
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
    for i, ((prior, _), value) in enumerate(
        zip(search.objective.free.columns, search.objective.free.numbers(z.tolist()))
    ):
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


def write_report(search: Search, parameters: Parameters) -> str:
    """The report as Markdown."""
    fit = fit_of(parameters)
    known = determinations(search)
    best = search.best
    story = (
        f"rlv-landing {__version__}, seed {best.seed}, {best.evaluations} evaluations of both landings; "
        f"loss {search.start_loss:.2f} at the start, {best.loss:.2f} at the best point (from the {best.stage}). "
        f"The loss is the sum of ln(1 + misfit^2), a misfit of one being {100 * TOLERANCE:g} % of a scalar."
    )
    lines = ["# Identification", "", story, ""]
    lines += [
        f"The paper's printed simulation scalars within 5 / 10 / 20 %: **{counted(np.array([e for *_, e in fit]))}**.",
        "",
    ]
    lines += [
        "## Fit of every printed scalar",
        "",
        "| scalar | paper | ours | error |",
        "|---|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {wanted:g} | {ours:.4g} | {100 * error:+.1f} % |"
        for name, wanted, ours, error in fit
    ]
    lines += ["", "## How well each number is determined", ""]
    lines += [
        "Deviation: posterior standard deviation as a part of the bounds' width, by the Jacobian there (0.29: the prior alone).",
        "",
    ]
    lines += [
        "| number | value | bounds | deviation | verdict | moves with | most sensitive |",
        "|---|---:|---|---:|---|---|---|",
    ]
    for d in known:
        moves = f"{d.partner} ({d.correlation:+.2f})"
        lines.append(
            f"| {d.label} | {d.value:.4g} | {d.lo:g} ... {d.hi:g} | {d.deviation:.3f} | {d.verdict} | {moves} | {d.scalar} |"
        )
    if search.objective.conditions:
        lines += ["", "## Conditions", "", "| condition | at most | because |", "|---|---|---|"]
        lines += [
            f"| {c.name} | {c.limit:g} {c.unit} | {c.reason} |" for c in search.objective.conditions
        ]
    return "\n".join(lines) + "\n"
