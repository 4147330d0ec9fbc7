"""The report of a Monte Carlo as one self-contained HTML page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ... import __version__
from ...quantities import shown
from ...studies.criteria import CRITERIA
from ...studies.montecarlo.study import MonteCarlo
from ...studies.montecarlo.summary import Load, Summary, read_rows
from ...studies.sweep.factors import value_text
from ...studies.sweep.responses import every_response
from ...tables.montecarlo_tables import number, rate_text
from ..plots import inline_svg
from ..report import write_whole
from ..style import page_css
from .pictures import pictures

TEMPLATE = Path(__file__).with_name("page.html.j2")


def write(found: Summary, study: MonteCarlo, results: Path, again: str, path: Path) -> None:
    """Write the report to `path`, whole or not at all.

    Args:
        found: The summary.
        study: The study.
        results: Its results file.
        again: The command that lands a run again, its number apart.
        path: The file.

    Raises:
        LandingError: The results are damaged, or the file cannot be written.
    """
    write_whole(page(found, study, results, again), path)


def page(found: Summary, study: MonteCarlo, results: Path, again: str) -> str:
    """The page as a text."""
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    drawn = pictures(found, study, read_rows(results, study))
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        css=page_css(),
        version=__version__,
        name=found.name,
        runs=found.runs,
        seed=found.seed,
        mode=study.sweep.parameters.drop.mode,
        rate=rate_text(found.rate, found.interval, found.level),
        lost=f"{found.runs - found.successes} of {found.runs}",
        criterion=CRITERIA[study.criterion],
        counts=[
            {"title": title, "rows": _counts(counts, found.runs)}
            for title, counts in (
                ("Outcomes", found.outcomes),
                ("Causes of loss", found.causes),
                ("Grades", found.grades),
            )
            if counts
        ],
        pictures=[
            {
                "title": p.title,
                "note": p.note,
                "svg": inline_svg(p.figure, f"f{i}", f"{p.title}, {found.name}"),
            }
            for i, p in enumerate(drawn)
        ],
        percents=[f"{p:g} %" for p in study.percentiles],
        level=f"{100.0 * found.level:g}",
        loads=[_load(load) for load in found.loads],
        again=again,
        varied=_varied(study),
        settings=[(name, value_text(name, v)) for name, v in study.sweep.fixed.items()],
        failures=found.failures,
    )


def _counts(counts: Any, runs: int) -> list[tuple[str, int, str]]:
    return [(name, count, f"{100.0 * count / runs:.2f}") for name, count in counts.items()]


def _load(load: Load) -> dict[str, Any]:
    q = every_response()[load.name]
    return {
        "name": load.name,
        "word": load.word,
        "unit": shown(q)[0] or "1",
        "percentiles": [
            (number(q, p.value), *("-" if v is None else number(q, v) for v in (p.low, p.high)))
            for p in load.percentiles
        ],
        "worst": [(run, number(q, value)) for run, value in load.worst],
    }


def _varied(study: MonteCarlo) -> list[tuple[str, str]]:
    """What varies, and how, in words."""
    d = study.dispersions
    found = []
    if d.table is not None:
        how = "drawn at random" if d.table.at_random else "in order"
        words = f"{len(d.table.design)} rows of the table, {how}"
        found += [(name, words) for name in d.table.design.columns]
    if d.correlated is not None:
        c = d.correlated
        for i, (name, mean) in enumerate(zip(c.names, c.mean)):
            found.append((name, f"{_normal(name, mean, c.matrix[i][i] ** 0.5)}, correlated"))
    for f in d.factors:
        if f.distribution == "choice":
            how = f"one of {', '.join(value_text(f.name, v) for v in f.values)}"
        elif f.distribution == "normal":
            how = _normal(f.name, f.mean, f.deviation)
        else:
            how = f"uniform, {value_text(f.name, f.low)} to {value_text(f.name, f.high)}"
        found.append((f.name, how))
    return found


def _normal(name: str, mean: float, deviation: float) -> str:
    return f"normal, mean {value_text(name, mean)}, deviation {value_text(name, deviation)}"
