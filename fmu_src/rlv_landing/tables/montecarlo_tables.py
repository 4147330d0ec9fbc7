"""The tables of a Monte Carlo, and of the difference of two."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan

from ..quantities import Quantity, shown
from ..studies.montecarlo.difference import SHOWN, Difference
from ..studies.montecarlo.summary import Load, Percentile, Summary
from ..studies.sweep.responses import every_response
from .rendering import new_table, render


def rate_text(rate: float, interval: Sequence[float], level: float) -> str:
    """A rate of success with its interval, in words."""
    low, high = interval
    return (
        f"{100.0 * rate:.2f} % succeed, {100.0 * low:.2f} to {100.0 * high:.2f} % "
        f"({100.0 * level:g} %, Wilson)"
    )


def montecarlo_tables(found: Summary, again: str) -> str:
    """Rate of success, causes of loss, grades, percentiles of loads, worst landings.

    Args:
        found: The summary.
        again: The command that lands a run again, its number apart.
    """
    rate = rate_text(found.rate, found.interval, found.level)
    parts = [
        f"{found.name}: {found.runs} runs of seed {found.seed}, {rate}\n",
        _counts("outcomes", "outcome", found, found.outcomes),
        _counts("causes of loss", "cause", found, found.causes) if found.causes else "",
        _counts("grades", "grade", found, found.grades) if found.grades else "",
        _percentiles(found),
        _worst(found),
    ]
    if found.loads and any(load.worst for load in found.loads):
        parts.append(f"land one again: {again}RUN\n")
    if found.failures:
        run, error = found.failures[0]
        parts.append(f"run {run} could not be made: {error}\n")
    return "".join(parts)


def _counts(title: str, what: str, found: Summary, counts: Mapping[str, int]) -> str:
    table = new_table(title, (what,), ("runs", "%"))
    for name, count in counts.items():
        table.add_row(name, str(count), f"{100.0 * count / found.runs:.2f}")
    return render(table)


def _percentiles(found: Summary) -> str:
    percents = sorted({p.percent for load in found.loads for p in load.percentiles})
    table = new_table(
        f"loads: what so many % of the landings do not go beyond, with the {100.0 * found.level:g} "
        "% interval of order statistics",
        ("load", "unit"),
        (f"{percent:g} %" for percent in percents),
    )
    for load in found.loads:
        q = every_response()[load.name]
        table.add_row(load.name, shown(q)[0] or "1", *(_percentile(q, p) for p in load.percentiles))
    return render(table, 160)


def _percentile(q: Quantity, p: Percentile) -> str:
    ends = (p.low, p.high)
    return f"{number(q, p.value)} ({', '.join('-' if v is None else number(q, v) for v in ends)})"


def number(q: Quantity, value: float) -> str:
    """A response's value in the unit that people read."""
    return f"{value / shown(q)[1]:.4g}"


def _worst(found: Summary) -> str:
    most = max((len(load.worst) for load in found.loads), default=0)
    if not most:
        return ""
    table = new_table(
        "worst landings: value and run", ("load", "unit"), (f"{i + 1}." for i in range(most))
    )
    for load in found.loads:
        q = every_response()[load.name]
        table.add_row(f"{load.word} {load.name}", shown(q)[0] or "1", *worst_texts(load))
    return render(table, 160)


def worst_texts(load: Load) -> list[str]:
    """The worst landings of a load: value, and run."""
    q = every_response()[load.name]
    return [f"{number(q, value)} (run {run})" for run, value in load.worst]


def difference_tables(found: Difference) -> str:
    """What differs between two studies."""
    parts = []
    for word, side in zip(("before", "after"), found.sides):
        rate, low, high = side.interval
        parts.append(
            f"{word}: {side.path}, {len(side.rows)} runs, "
            f"{rate_text(rate, (low, high), side.level)}\n"
        )
    parts += [f"{name}: {before} -> {after}\n" for name, before, after in found.settings]
    if found.paired:
        parts.append(
            f"{found.paired} runs are the same in both: {len(found.newly_lost)} newly lost"
            f"{_first(found.newly_lost)}, {len(found.saved)} saved{_first(found.saved)}, "
            f"{len(found.outcomes)} with another outcome{_first(found.outcomes)}\n"
        )
    else:
        parts.append("the dispersions are others, so no run is the same in both\n")
    table = new_table(
        "loads",
        ("load", "unit"),
        ("median before", "after", "worst before", "after ", "largest change [%]", "of run"),
    )
    for load in found.loads:
        q = every_response()[load.name]
        change = "-" if isnan(load.largest) else f"{100.0 * load.largest:.3g}"
        table.add_row(
            load.name,
            shown(q)[0] or "1",
            *(number(q, v) for v in (*load.medians, *load.extremes)),
            change,
            "-" if load.run is None else str(load.run),
        )
    parts.append(render(table, 160))
    verdict = "the same" if found.same else "not the same"
    parts.append(f"{verdict}, to {100.0 * found.tolerance:g} % of each load's largest magnitude\n")
    return "".join(parts)


def _first(runs: Sequence[int]) -> str:
    if not runs:
        return ""
    more = ", ..." if len(runs) > SHOWN else ""
    return f" ({', '.join(map(str, runs[:SHOWN]))}{more})"
