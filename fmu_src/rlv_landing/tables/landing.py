"""The tables of a landing and of parameters, and numbers in tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..errors import one_line
from ..history import History
from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..quantities import Quantity
from ..summary import dampers_of, summarise, unfinished
from ..validation.paper import Comparison, compare, counts, other_vehicle
from .rendering import new_table, render

# a parameter that is a list, in characters
LONGEST_VALUE = 60
FIRST_STROKE = "absorbed, dissipated and efficiency are of a damper's first compression and rebound"


def number(value: float | None, unit: str) -> str:
    """A number in its unit: N without decimals, s with three, others with two.

    None and NaN are a dash.
    """
    if value is None or math.isnan(value):
        return "-"
    return f"{value:.0f}" if unit == "N" else f"{value:.3f}" if unit == "s" else f"{value:.2f}"


def decimals(value: float | None, digits: int) -> str:
    """A number with so many decimals; a dash for None."""
    return "-" if value is None else f"{value:.{digits}f}"


def comparison_table(history: History, mode: str) -> str:
    """Our numbers beside the paper's simulation and tests, and the counts of `mode`.

    There is a line for each printed scalar; the counts are those within 5, 10 and 20 %.
    """
    comparisons: list[Comparison] = compare(history, mode)
    table = new_table(
        f"{mode} drop test: this landing beside Yue, Lin, Zheng, Du (2022), section 5",
        ("quantity", "leg", "event"),
        ("ours", "simulation", "test", "unit", "ours - simulation"),
    )
    for c in comparisons:
        s = c.scalar
        tests = (
            " / ".join(number(v, s.unit) for v in (s.test_a, s.test_b) if not math.isnan(v)) or "-"
        )
        table.add_row(
            s.quantity.replace("_", " "),
            str(s.leg or ""),
            s.event,
            number(c.ours, s.unit),
            number(s.simulation, s.unit),
            tests,
            s.unit,
            percent(c.error) + ("*" if s.near_zero else ""),
        )
    return (
        render(table)
        + f"within 5 / 10 / 20 % of the paper's simulation: {counts_line(counts(comparisons))}\n"
        + near_zero_note(comparisons)
        + sampling_note(history)
        + other_vehicle_note(history.parameters)
    )


def sampling_note(history: History) -> str:
    """Note on the interval of the samples that numbers are read from; empty for a single one."""
    if len(history) < 2:
        return ""
    step = 1e3 * float(np.median(np.diff(history.time)))
    return f"samples are {step:.3g} ms apart; a peak between them is not seen\n"


def peaks_note(history: History) -> str:
    """Note on the source of a summary's peaks."""
    if history.extremes is None:
        return sampling_note(history).strip()
    return "peaks are those of the landing at the integrator's steps, between samples too"


def other_vehicle_note(parameters: Parameters | None) -> str:
    """Note on comparing a vehicle other than the paper's; empty for the paper's."""
    differences = [] if parameters is None else other_vehicle(parameters)
    if not differences:
        return ""
    more = f" and {len(differences) - 2} more" if len(differences) > 2 else ""
    return (
        f"this is not the paper's vehicle ({', '.join(differences[:2])}{more}): compression, "
        "rebound and rest are found in its curves, windows after a contact grow with its "
        "compression; a dash where the landing does not show an event\n"
    )


def percent(fraction: float) -> str:
    """A signed fraction in per cent; a dash for none."""
    return "-" if math.isnan(fraction) else f"{100.0 * fraction:+.1f} %"


def counts_line(n: dict[str, int]) -> str:
    """Counts within 5, 10 and 20 % as text."""
    return f"{n['within_5']} / {n['within_10']} / {n['within_20']} of {n['of']}"


def near_zero_note(comparisons: Iterable[Comparison]) -> str:
    """The note on the asterisk behind an error, with the scales; empty without such errors."""
    marked = [c.scalar for c in comparisons if c.scalar.near_zero]
    if not marked:
        return ""
    scales = ", ".join(
        f"{number(s.simulation, s.unit)} on {number(s.scale, s.unit)} {s.unit}" for s in marked
    )
    return (
        "* near zero, so judged on the scale of its curve, "
        f"the largest that the paper prints of it: {scales}\n"
    )


def summary_table(history: History, title: str, outcome: str = "") -> str:
    """The peaks of every leg and its damper's first compression and rebound; the outcome below.

    A log's history lacks the outcome: name it.
    """
    s = summarise(history)
    table = new_table(
        title,
        ("leg",),
        (
            "contact at [s]",
            "main strut force [kN]",
            "at [s]",
            "stroke [mm]",
            "at [s]",
            "auxiliary strut force [kN]",
            "ground force [kN]",
            "at [s]",
            "absorbed [J]",
            "dissipated [J]",
            "efficiency",
        ),
    )
    for leg in s["legs"]:
        table.add_row(*_leg_row(leg))
    notes = [*unfinished(s), FIRST_STROKE, peaks_note(history)]
    return render(table, 190) + "\n".join([*_outcome_lines(s, outcome), *notes]) + "\n"


def _leg_row(leg: Mapping[str, Any]) -> tuple[str, ...]:
    """The cells of a leg in the table of peaks."""
    low, high = leg["auxiliary_strut_force_min"], leg["auxiliary_strut_force_max"]
    return (
        str(leg["leg"]),
        number(leg["contact_time"], "s"),
        f"{leg['main_strut_force_min'] / 1e3:.2f}",
        f"{leg['main_strut_force_min_time']:.3f}",
        f"{leg['main_strut_stroke_max'] * 1e3:.2f}",
        f"{leg['main_strut_stroke_max_time']:.3f}",
        f"{low / 1e3:.2f} ... {high / 1e3:+.2f}",
        f"{leg['contact_force_max'] / 1e3:.2f}",
        f"{leg['contact_force_max_time']:.3f}",
        decimals(leg["main_strut_absorbed"], 1),
        decimals(leg["main_strut_dissipated"], 1),
        decimals(leg["main_strut_efficiency"], 3),
    )


def _outcome_lines(summary: Mapping[str, Any], outcome: str) -> list[str]:
    """How a landing ended, as lines; `outcome` is taken where the summary has none."""
    s = summary
    ended = (
        f"after {s['end_time']:.3f} s: {s.get('outcome', outcome) or 'outcome not known'}; "
        f"top acceleration up to {s['top_axial_acceleration_max']:.2f} m/s2 "
        f"at {s['top_axial_acceleration_max_time']:.3f} s"
    )
    lines = [ended]
    known = []
    if "stability_margin_min" in s:
        known.append(f"stability margin at least {s['stability_margin_min']:.3f} m")
    if "energy_balance_worst" in s:
        known.append(f"energy balance within {s['energy_balance_worst']:.1e} J")
    if known:
        lines.append("; ".join(known))
    if s.get("body_strike_time") is not None:
        lines.append(
            f"BODY STRIKE: the body met the ground first at {s['body_strike_time']:.3f} s; at most "
            f"{-1e3 * s['body_clearance_min']:.1f} mm deep"
        )
    if s.get("bottomed_out"):
        lines.append(
            f"BOTTOMED OUT: {dampers_of(s['bottomed_out'])} met "
            f"{'its' if len(s['bottomed_out']) == 1 else 'their'} compression stop"
        )
    return lines


def parameter_table(parameters: Parameters) -> str:
    """Every parameter with value, unit, bounds, source and meaning."""
    table = new_table(
        "parameters", ("name",), ("value",), ("unit", "bounds or choices", "source", "meaning")
    )
    for name, value in parameters.items():
        q = PARAMETER_QUANTITIES[name]
        bounds = " | ".join(q.choices) if q.kind == "string" else f"[{q.lo:g}, {q.hi:g}]"
        table.add_row(
            name,
            _told(value),
            q.unit,
            bounds,
            parameters.source(name),
            q.meaning.replace("[", r"\["),
        )
    return render(table, 200)


def _told(value: float | str) -> str:
    """A parameter's value for people; of a long text its ends."""
    if isinstance(value, str):
        return one_line(value, LONGEST_VALUE).replace("[", r"\[")
    return f"{value:.6g}"


def origin_table(parameters: Parameters, origins: Mapping[str, str]) -> str:
    """Every parameter with value, unit, source, and the file or preset that it comes from."""
    table = new_table("parameters", ("name",), ("value",), ("unit", "source", "comes from"))
    for name, value in parameters.items():
        table.add_row(
            name,
            _told(value),
            PARAMETER_QUANTITIES[name].unit,
            parameters.source(name),
            origins[name],
        )
    return render(table, 200)


def quantity_table(title: str, quantities: Iterable[Quantity]) -> str:
    """Names, units and meanings of inputs or outputs."""
    table = new_table(title, ("name", "unit", "meaning"), ())
    for q in quantities:
        table.add_row(q.name.replace("[", r"\["), q.unit, q.meaning)
    return render(table)


def parameter_records(parameters: Parameters) -> list[dict[str, Any]]:
    """Every parameter as a record for JSON; an infinite bound is null."""
    records = []
    for name, value in parameters.items():
        q = PARAMETER_QUANTITIES[name]
        lo, hi = (b if math.isfinite(b) else None for b in (q.lo, q.hi))
        records.append(
            {
                "name": name,
                "value": value,
                "unit": q.unit,
                "min": lo,
                "max": hi,
                "choices": list(q.choices),
                "source": parameters.source(name),
                "meaning": q.meaning,
            }
        )
    return records
