"""The validation as one self-contained HTML page.

It has tables, and the counterparts of the paper's Figs. 7 to 19 as inline SVG.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from .. import __version__
from ..parameters import Parameters
from ..tables.landing import (
    counts_line,
    decimals,
    near_zero_note,
    number,
    other_vehicle_note,
    parameter_records,
    percent,
)
from ..text.durable import unwritable, write_durably
from ..validation.paper import Scalar
from ..validation.validate import Validation
from .plots import inline_svg
from .report_bars import error_figure, measures_figure
from .report_figures import NUMBERS, acceleration_figure, curve_figure, loop_figure
from .report_marks import AUXILIARY, FORCE, STROKE
from .report_movement import movement_figure
from .style import page_css

TEMPLATE = Path(__file__).with_name("report.html.j2")
# of all pages


def write_report(
    found: Validation, parameters: Parameters, path: Path, label: str, phase: str = "zero"
) -> None:
    """Write the page to `path`.

    Args:
        found: The validation.
        parameters: The parameters of its landings.
        path: The file.
        label: The name of the parameters.
        phase: Phase of the sensors' low-pass.

    Raises:
        LandingError: The file cannot be written.
    """
    write_whole(render_report(found, parameters, label, phase), path)


def write_whole(text: str, path: Path) -> None:
    """Write `text` to `path` by a temporary name: the file is then new, or as it was.

    Raises:
        LandingError: The file cannot be written.
    """
    try:
        write_durably(path, text.encode())
    except OSError as e:
        raise unwritable(path, e) from None


def render_report(
    found: Validation, parameters: Parameters, label: str, phase: str = "zero"
) -> str:
    """The page as a text."""
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        css=page_css(),
        label=label,
        version=__version__,
        modes=found.modes,
        phase=phase,
        counts=counts_line(found.counts),
        counts_against_test=counts_line(found.counts_against_test),
        paper_counts_against_test=counts_line(found.paper_counts_against_test),
        scalars=_scalar_rows(found),
        other_vehicle=other_vehicle_note(found.parameters).strip(),
        near_zero=near_zero_note(found.all_comparisons).strip(),
        work=_work_rows(found),
        work_notes=found.notes,
        curves=found.curves,
        figures={mode: _mode_figures(found, mode) for mode in found.modes},
        measures=inline_svg(
            measures_figure(found), "measures", "Energies and efficiency of every damper"
        ),
        errors=inline_svg(error_figure(found), "errors", "Error of every printed scalar"),
        parameters=[
            {**r, "value": r["value"] if isinstance(r["value"], str) else f"{r['value']:.6g}"}
            for r in parameter_records(parameters)
        ],
    )


def _mode_figures(found: Validation, mode: str) -> list[dict[str, str]]:
    numbers = NUMBERS[mode]
    drawn = (
        ("Main strut forces", "negative in compression", curve_figure(found, mode, FORCE)),
        ("Main strut strokes", "positive in compression", curve_figure(found, mode, STROKE)),
        (
            "Force over stroke of the dampers",
            "shaded: absorbed in the first compression; dotted: Fmax Smax",
            loop_figure(found, mode),
        ),
        ("Auxiliary strut forces", "tension positive", curve_figure(found, mode, AUXILIARY)),
        (
            "Axial acceleration at the top",
            "-g in free fall, 0 at rest",
            acceleration_figure(found, mode),
        ),
        ("Movement", "wireframe in the symmetric plane", movement_figure(found, mode)),
    )
    return [
        {
            "title": title,
            "note": note,
            "number": str(n),
            "svg": inline_svg(figure, f"fig{n}", f"{title}, {mode}", tooltips),
        }
        for n, (title, note, (figure, tooltips)) in zip(numbers, drawn)
    ]


def _scalar_rows(found: Validation) -> list[dict[str, Any]]:
    rows = []
    for c in found.all_comparisons:
        s = c.scalar
        mark = "*" if s.near_zero else ""
        rows.append(
            {
                "id": s.id,
                "mode": s.mode,
                "what": _scalar_name(s),
                "unit": s.unit,
                "simulation": number(s.simulation, s.unit),
                "tests": " / ".join(number(v, s.unit) for v in (s.test_a, s.test_b) if v == v)
                or "-",
                "ours": number(c.ours, s.unit),
                "error": percent(c.error) + mark,
                "grade": _grade(c.error),
                "error_test": percent(c.error_test),
                "grade_test": _grade(c.error_test) if c.error_test == c.error_test else "none",
                "paper_error_test": percent(s.paper_error_test),
            }
        )
    return rows


def _scalar_name(s: Scalar) -> str:
    leg = f", leg {s.leg}" if s.leg else ""
    return f"{s.quantity.replace('_', ' ')}{leg}: {s.event}"


def _grade(error: float) -> str:
    if math.isnan(error):
        return "out"
    return next((f"within{p}" for p in (5, 10, 20) if abs(error) <= p / 100.0), "out")


def _work_rows(found: Validation) -> list[dict[str, str]]:
    rows = []
    for mode, work in found.work.items():
        for leg, w in work.items():
            off = found.discrepancies(mode, leg)
            rows.append(
                {
                    "mode": mode,
                    "leg": str(leg),
                    "force": decimals(w.force_max and w.force_max / 1e3, 2),
                    "stroke": decimals(w.stroke_max and w.stroke_max * 1e3, 2),
                    "largest": f"{w.largest * 1e3:.2f} at {w.largest_time:.3f} s",
                    "absorbed": decimals(w.absorbed, 1) + _off(off[0]),
                    "dissipated": decimals(w.dissipated, 1) + _off(off[1]),
                    "efficiency": decimals(w.efficiency, 3),
                }
            )
    return rows


def _off(percentage: float | None) -> str:
    return "" if percentage is None else f" ({percentage:.1f} % off the measured)"
