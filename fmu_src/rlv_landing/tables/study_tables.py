"""The tables of a validation and of an audit."""

from __future__ import annotations

from collections.abc import Iterable

from ..audit.audit import Audit
from ..audit.bounds import BOUNDS, Check
from ..audit.convergence import Errors
from ..validation.paper import Comparison
from ..validation.validate import Validation
from .landing import (
    counts_line,
    decimals,
    near_zero_note,
    number,
    other_vehicle_note,
    percent,
    sampling_note,
)
from .rendering import new_table, render


def validation_tables(found: Validation) -> str:
    """Every printed scalar, the dampers' measures, RRMS of measured curves, and the counts."""
    parts = [
        _scalar_table(found.all_comparisons),
        near_zero_note(found.all_comparisons),
        sampling_note(found.histories[found.modes[0]]),
        "the largest stroke of all is the landing's, between samples too\n",
        other_vehicle_note(found.parameters),
        measure_table(found),
    ]
    if found.curves:
        parts.append(_curve_table(found))
    parts.append(
        f"within 5 / 10 / 20 % of the paper's simulation: {counts_line(found.counts)}\n"
        "within 5 / 10 / 20 % of the paper's tests:      "
        f"{counts_line(found.counts_against_test)}\n"
        "the same, read through the tests' sensor chain: "
        f"{counts_line(found.counts_against_test_sensed)}\n"
        "the paper's own simulation of its tests:        "
        f"{counts_line(found.paper_counts_against_test)}\n"
    )
    return "".join(parts)


def _scalar_table(comparisons: Iterable[Comparison]) -> str:
    table = new_table(
        "every scalar that Yue, Lin, Zheng, Du (2022) print in section 5; "
        "errors on the printed simulation's scale",
        ("id", "event"),
        (
            "simulation",
            "test",
            "ours",
            "unit",
            "ours - simulation",
            "ours - test",
            "simulation - test",
        ),
    )
    for c in comparisons:
        s = c.scalar
        mark = "*" if s.near_zero else ""
        table.add_row(
            s.id,
            f"{s.quantity.replace('_', ' ')} {s.leg or ''}: {s.event}".replace(" :", ":"),
            number(s.simulation, s.unit),
            number(s.test, s.unit),
            number(c.ours, s.unit),
            s.unit,
            percent(c.error) + mark,
            percent(c.error_test) + (mark if s.test == s.test else ""),
            percent(s.paper_error_test) + (mark if s.test == s.test else ""),
        )
    return render(table, 170)


def measure_table(found: Validation) -> str:
    """Each damper's work in its first compression and rebound.

    Discrepancies are given where the user measured the work.
    """
    table = new_table(
        "first compression and rebound of every damper",
        ("mode", "leg"),
        (
            "Fmax [kN]",
            "Smax [mm]",
            "at [s]",
            "largest of all [mm]",
            "at [s]",
            "absorbed [J]",
            "dissipated [J]",
            "efficiency",
            "of measured: absorbed",
            "of measured: dissipated",
        ),
    )
    for mode, work in found.work.items():
        for leg, w in work.items():
            off = found.discrepancies(mode, leg)
            table.add_row(
                mode,
                str(leg),
                decimals(w.force_max and w.force_max / 1e3, 2),
                decimals(w.stroke_max and w.stroke_max * 1e3, 2),
                decimals(w.top, 3),
                f"{w.largest * 1e3:.2f}",
                f"{w.largest_time:.3f}",
                decimals(w.absorbed, 1),
                decimals(w.dissipated, 1),
                decimals(w.efficiency, 3),
                *(_off(percentage) for percentage in off),
            )
    return render(table, 170) + "".join(f"{line}\n" for line in found.notes)


def _off(percentage: float | None) -> str:
    return "-" if percentage is None else f"{percentage:.1f} % off"


def _curve_table(found: Validation) -> str:
    table = new_table(
        "beside the measured curves: rms(landing - test)/rms(test)",
        ("mode", "curve"),
        ("RRMS", "RRMS through the sensor chain"),
    )
    for c in found.curves:
        table.add_row(
            c.mode,
            c.column.replace("[", r"\["),
            f"{100.0 * c.rrms:.1f} %",
            f"{100.0 * c.rrms_sensors:.1f} %",
        )
    return render(table)


def audit_tables(audits: Iterable[Audit]) -> str:
    """Energies by term, convergence, and every check with its bound and reason, case by case."""
    return "".join(
        _energy_table(a) + _convergence_table(a) + _check_table(a) + _rest_line(a) for a in audits
    )


def _landed(found: Audit) -> str:
    """The mode, and the case where it is not the vehicle as it is."""
    return found.mode if found.convergence is not None else f"{found.mode}, {found.case}"


def _energy_table(found: Audit) -> str:
    table = new_table(
        f"{_landed(found)}: energies [J], at 0 s and 1 s after first contact, rtol 1e-8",
        ("term",),
        ("start", "end", "change"),
    )
    sums = [0.0, 0.0]
    for term, (start, end) in found.energy.items():
        sign = -1.0 if term.startswith("work") else 1.0
        sums = [sums[0] + sign * start, sums[1] + sign * end]
        name = term.replace("_", " ")
        table.add_row(
            f"less: {name}" if sign < 0.0 else name,
            f"{start:.6f}",
            f"{end:.6f}",
            f"{end - start:+.6f}",
        )
    table.add_section()
    table.add_row(
        "sum, which must not change",
        f"{sums[0]:.6f}",
        f"{sums[1]:.6f}",
        f"{sums[1] - sums[0]:+.1e}",
    )
    return render(table)


def _convergence_table(found: Audit) -> str:
    c = found.convergence
    if c is None:
        return ""
    table = new_table(
        f"{_landed(found)}: error against a run at rtol {c.reference:g}, "
        "of the largest strut force and stroke",
        (),
        ("rtol", "steps on the arc", "force", "stroke", "steps of the landing", "force", "stroke"),
    )

    def cells(e: Errors) -> tuple[str, str, str]:
        return str(e.steps), f"{e.force:.1e}", f"{e.stroke:.1e}"

    for smooth, whole in zip(c.smooth, c.contacts):
        table.add_row(f"{smooth.rtol:.0e}", *cells(smooth), *cells(whole))
    return render(table) + (
        f"smooth arc: {c.start:.4f} to {c.end:.4f} s, from one and the same state; "
        f"the error falls by {c.smooth_slope:.2f} decades a decade of tolerance.\n"
        f"Across the landing's contacts: {c.contacts_slope:.2f}; there the instant of a contact "
        "carries the error, so the force is off most.\n\n"
    )


def _check_table(found: Audit) -> str:
    table = new_table(
        f"{_landed(found)}: audit", ("check",), ("value", "bound"), ("", "why this bound")
    )
    for check in found.checks:
        b = BOUNDS[check.id]
        table.add_row(
            b.what,
            f"{check.value:.2g} {b.unit}".rstrip(),
            f"{b.side} {b.limit:g} {b.unit}".rstrip(),
            _verdict(check),
            b.reason,
        )
    return render(table, 200)


def _verdict(check: Check) -> str:
    return "does not apply" if not check.applies else "ok" if check.passed else "MISSED"


def _rest_line(found: Audit) -> str:
    r = found.rest
    settled = (
        f"settled from {r['settled_since']:.2f} s on"
        if r["settled_since"] == r["settled_since"]
        else "not settled"
    )
    strokes = ", ".join(f"{1e3 * r[name]:.2f}" for name in r if name.startswith("stroke_"))
    return (
        f"{_landed(found)} at rest: {settled}; "
        f"pitch {r['pitch'] * 57.29577951308232:+.3f} deg, strokes {strokes} mm, "
        f"stability margin {r['stability_margin']:.3f} m\n\n"
    )


def missed_lines(audits: Iterable[Audit]) -> list[str]:
    """A line for every bound that was missed."""
    lines = []
    for found in audits:
        for check in found.missed:
            b = BOUNDS[check.id]
            lines.append(
                f"{_landed(found)}: {b.what}: {check.value:.3g} {b.unit}".rstrip()
                + f", {b.side} {b.limit:g} {b.unit}".rstrip()
                + " is required"
            )
    return lines
