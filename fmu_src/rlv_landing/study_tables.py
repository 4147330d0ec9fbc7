"""What the studies found, as people read it in a terminal."""

from __future__ import annotations

from collections.abc import Iterable

from .paper import Comparison
from .studies.audit import Audit, Check
from .studies.bounds import BOUNDS
from .studies.convergence import Errors
from .studies.validate import Validation
from .tables import counts_line, near_zero_note, new_table, number, percent, render


def validation_tables(found: Validation) -> str:
    """Every printed scalar, the dampers' measures, RRMS where the user gave curves, and the counts."""
    parts = [_scalar_table(found.all_comparisons), near_zero_note(found.all_comparisons), measure_table(found)]
    if found.curves:
        parts.append(_curve_table(found))
    parts.append(
        f"within 5 / 10 / 20 % of the paper's simulation: {counts_line(found.counts)}\n"
        f"within 5 / 10 / 20 % of the paper's tests:      {counts_line(found.counts_against_test)}\n"
        f"the same, read through the tests' sensor chain: {counts_line(found.counts_against_test_sensed)}\n"
        f"the paper's own simulation of its tests:        {counts_line(found.paper_counts_against_test)}\n"
    )
    return "".join(parts)


def _scalar_table(comparisons: Iterable[Comparison]) -> str:
    table = new_table(
        "every scalar that Yue, Lin, Zheng, Du (2022) print in section 5; errors on the printed simulation's scale",
        ("id", "event"),
        ("simulation", "test", "ours", "unit", "ours - simulation", "ours - test", "simulation - test"),
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
    """Each damper's work in its first compression and rebound; discrepancies beside measured work."""
    table = new_table(
        "first compression and rebound of every damper",
        ("mode", "leg"),
        ("Fmax [kN]", "Smax [mm]", "absorbed [J]", "dissipated [J]", "efficiency", "of measured: absorbed", "dissipated"),
    )
    for mode, work in found.work.items():
        for leg, w in work.items():
            off = found.discrepancies(mode, leg)
            table.add_row(
                mode,
                str(leg),
                f"{w.force_max / 1e3:.2f}",
                f"{w.stroke_max * 1e3:.2f}",
                f"{w.absorbed:.1f}",
                f"{w.dissipated:.1f}",
                f"{w.efficiency:.3f}",
                *((f"{off[0]:.1f} % off", f"{off[1]:.1f} % off") if off else ("-", "-")),
            )
    return render(table)


def _curve_table(found: Validation) -> str:
    table = new_table(
        "beside the measured curves: rms(landing - test)/rms(test)", ("mode", "curve"), ("RRMS", "RRMS through the sensor chain")
    )
    for c in found.curves:
        table.add_row(c.mode, c.column.replace("[", r"\["), f"{100.0 * c.rrms:.1f} %", f"{100.0 * c.rrms_sensors:.1f} %")
    return render(table)


def audit_tables(audits: Iterable[Audit]) -> str:
    """Energies by term, convergence, and every check with its bound and reason, mode by mode."""
    return "".join(_energy_table(a) + _convergence_table(a) + _check_table(a) + _rest_line(a) for a in audits)


def _energy_table(found: Audit) -> str:
    table = new_table(f"{found.mode}: energies [J], rtol 1e-8", ("term",), ("start", "end", "change"))
    sums = [0.0, 0.0]
    for term, (start, end) in found.energy.items():
        sign = -1.0 if term.startswith("work") else 1.0
        sums = [sums[0] + sign * start, sums[1] + sign * end]
        name = term.replace("_", " ")
        table.add_row(f"less: {name}" if sign < 0.0 else name, f"{start:.6f}", f"{end:.6f}", f"{end - start:+.6f}")
    table.add_section()
    table.add_row("sum, which must not change", f"{sums[0]:.6f}", f"{sums[1]:.6f}", f"{sums[1] - sums[0]:+.1e}")
    return render(table)


def _convergence_table(found: Audit) -> str:
    c = found.convergence
    table = new_table(
        f"{found.mode}: error against a run at rtol {c.reference:g}, of the largest strut force and stroke",
        (),
        ("rtol", "steps on the arc", "force", "stroke", "steps of the landing", "force", "stroke"),
    )

    def cells(e: Errors) -> tuple[str, str, str]:
        return str(e.steps), f"{e.force:.1e}", f"{e.stroke:.1e}"

    for smooth, whole in zip(c.smooth, c.contacts):
        table.add_row(f"{smooth.rtol:.0e}", *cells(smooth), *cells(whole))
    return render(table) + (
        f"smooth arc: {c.start:.4f} to {c.end:.4f} s, from one and the same state; the error falls by {c.smooth_slope:.2f} decades a "
        f"decade of tolerance.\nAcross the landing's contacts: {c.contacts_slope:.2f}; there the instant of a contact carries the error, "
        "so the force is off most.\n\n"
    )


def _check_table(found: Audit) -> str:
    table = new_table(f"{found.mode}: audit", ("check",), ("value", "bound"), ("", "why this bound"))
    for check in found.checks:
        b = BOUNDS[check.id]
        table.add_row(b.what, f"{check.value:.2g} {b.unit}".rstrip(), f"{b.side} {b.limit:g} {b.unit}".rstrip(), _verdict(check), b.reason)
    return render(table, 200)


def _verdict(check: Check) -> str:
    return "not held to it" if not check.applies else "ok" if check.passed else "MISSED"


def _rest_line(found: Audit) -> str:
    r = found.rest
    settled = f"settled from {r['settled_since']:.2f} s on" if r["settled_since"] == r["settled_since"] else "not settled"
    strokes = ", ".join(f"{1e3 * r[f'stroke_{leg}']:.2f}" for leg in (1, 2, 3, 4))
    return (
        f"{found.mode} at rest: {settled}; pitch {r['pitch'] * 57.29577951308232:+.3f} deg, strokes {strokes} mm, "
        f"stability margin {r['stability_margin']:.3f} m\n\n"
    )


def missed_lines(audits: Iterable[Audit]) -> list[str]:
    """A line for every bound that was missed."""
    lines = []
    for found in audits:
        for check in found.missed:
            b = BOUNDS[check.id]
            lines.append(
                f"{found.mode}: {b.what}: {check.value:.3g} {b.unit}".rstrip()
                + f", {b.side} {b.limit:g} {b.unit}".rstrip()
                + " is required"
            )
    return lines
