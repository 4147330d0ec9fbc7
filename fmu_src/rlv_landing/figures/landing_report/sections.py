"""What the report says of landings, as tables of texts; page and PDF show the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...audit.audit import Audit
from ...audit.bounds import BOUNDS
from ...history import History
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...quantities import ENERGY_QUANTITIES, SPACE, shown
from ...studies.outcome import Outcome, outcome, stop_of
from ...summary import summarise, unfinished
from ...tables.landing import decimals, number
from ..plots import drawn_legs
from .loads import COMPONENTS, FOOTPAD, interface_loads, peaks

# of the touchdown, the parameters that are shown
TOUCHDOWN = (
    *("drop.mode", "drop.contact_time", "drop.vertical_velocity", "drop.horizontal_velocity"),
    *("drop.tilt", "drop.pitch_rate", "ground.slope", "ground.friction", "ground.gravity"),
)
# of a landing in space, beside them
TOUCHDOWN_IN_SPACE = (
    *("vehicle.legs", "vehicle.leg_azimuth", "drop.lateral_velocity", "drop.heading", "drop.roll"),
    *("drop.roll_rate", "drop.yaw_rate", "ground.slope_direction"),
)
MARGINS = {
    "stability_min": "least stability margin",
    "stability_end": "stability margin at the end",
    "stroke_left": "stroke left to the stop",
    "slid": "farthest slide of a footpad",
    "joint_clearance": "least height of the body's lowest joints",
}


@dataclass(frozen=True)
class Table:
    """A table of texts.

    Attributes:
        title: The title.
        head: The columns' headings.
        rows: The rows; all cells are texts.
        note: A line below it.
    """

    title: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    note: str = ""


@dataclass(frozen=True)
class Landed:
    """A landing with its name, and the audits of its vehicle, if they were made."""

    label: str
    history: History
    audits: Sequence[Audit] = ()
    outcome: Outcome = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outcome", outcome(self.history))

    @property
    def parameters(self) -> Parameters:
        """The vehicle, its ground and its drop."""
        assert self.history.parameters is not None
        return self.history.parameters

    @property
    def title(self) -> str:
        """Its name and its mode."""
        return f"{self.label}, {self.parameters.drop.mode}"


def side_by_side(landings: Sequence[Landed]) -> Table:
    """The main results, a column for each landing."""
    columns = [_main_results(found) for found in landings]
    rows = [(name, *(column[name] for column in columns)) for name in columns[0]]
    return Table("Results", ("", *(found.title for found in landings)), rows)


def tables_of(found: Landed) -> list[Table]:
    """All tables of one landing."""
    audited = [_audit_table(a) for a in found.audits]
    return [
        _touchdown(found),
        _margins(found),
        _legs(found),
        _loads(found),
        _energies(found),
        *audited,
    ]


def _main_results(found: Landed) -> dict[str, str]:
    s, legs, p = summarise(found.history), found.history.legs, found.parameters
    force = max(-leg["main_strut_force_min"] for leg in s["legs"])
    # of the leg that comes nearest to its stop
    stroke, stop = max(
        ((leg["main_strut_stroke_max"], stop_of(p, leg["leg"])) for leg in s["legs"]),
        key=lambda pair: pair[0] - pair[1],
    )
    ground = max(leg["contact_force_max"] for leg in s["legs"])
    pressure = max(
        found.history.extreme(f"leg[{leg}].main_strut.pressure_{chamber}").maximum
        for leg in legs
        for chamber in ("upper", "lower")
    )
    missed = sum(len(a.missed) for a in found.audits)
    return {
        "outcome": f"{found.outcome.name} at {found.outcome.time:.3f} s",
        "least stability margin": f"{found.outcome.margins['stability_min']:.3f} m",
        "largest main strut force": f"{force / 1e3:.4g} kN",
        "largest force on a footpad": f"{ground / 1e3:.4g} kN",
        "largest stroke": f"{1e3 * stroke:.4g} mm of {1e3 * stop:.4g} mm",
        "highest pressure": f"{pressure / 1e6:.4g} MPa" if _has_liquid(p) else "no liquid",
        "largest acceleration at the top": f"{s['top_axial_acceleration_max']:.4g} m/s²",
        "energy balance": f"within {s['energy_balance_worst']:.1e} J",
        "audit": "not made"
        if not found.audits
        else "all bounds are kept"
        if not missed
        else "1 bound is missed"
        if missed == 1
        else f"{missed} bounds are missed",
    }


def _has_liquid(parameters: Parameters) -> bool:
    return parameters.main_strut.kind == "liquid-spring"


def _touchdown(found: Landed) -> Table:
    rows = []
    in_space = found.parameters.drop.mode == SPACE
    for name in (*TOUCHDOWN, *(TOUCHDOWN_IN_SPACE if in_space else ())):
        q, value = PARAMETER_QUANTITIES[name], found.parameters[name]
        unit, size = shown(q)
        text = value if isinstance(value, str) else f"{float(value) / size:.5g}"
        rows.append((name, text, unit, q.meaning))
    return Table("Touchdown", ("quantity", "value", "unit", "meaning"), rows)


def _margins(found: Landed) -> Table:
    end = found.outcome
    rows = [("outcome", f"{end.name} at {end.time:.3f} s")]
    if end.direction is not None:
        over = f"the edge {end.edge}, towards" if end.edge else "towards"
        rows.append(("toppled over", f"{over} {np.degrees(end.direction):.0f} deg from x to z"))
    rows += [(MARGINS[name], f"{value:.4f} m") for name, value in end.margins.items()]
    if found.parameters.vehicle.body_points:
        least = found.history.extreme("body.clearance").minimum
        rows.append(("least clearance of the body's points", f"{least:.4f} m"))
    return Table(
        "Outcome and margins", ("", ""), rows, " ".join(unfinished(summarise(found.history)))
    )


def _legs(found: Landed) -> Table:
    liquid = _has_liquid(found.parameters)
    head = (
        *("leg", "contact at [s]", "main strut force [kN]", "stroke [mm]"),
        *("auxiliary strut force [kN]", "ground force [kN]"),
        *(("pressure upper [MPa]", "pressure lower [MPa]") if liquid else ()),
        *("absorbed [J]", "dissipated [J]", "efficiency"),
    )
    rows = []
    for leg in summarise(found.history)["legs"]:
        pressures = [
            found.history.extreme(f"leg[{leg['leg']}].main_strut.pressure_{chamber}")
            for chamber in ("upper", "lower")
        ]
        low, high = leg["auxiliary_strut_force_min"], leg["auxiliary_strut_force_max"]
        rows.append(
            (
                str(leg["leg"]),
                number(leg["contact_time"], "s"),
                f"{leg['main_strut_force_min'] / 1e3:.3f}",
                f"{leg['main_strut_stroke_max'] * 1e3:.2f}",
                f"{low / 1e3:.3f} ... {high / 1e3:+.3f}",
                f"{leg['contact_force_max'] / 1e3:.3f}",
                *(
                    f"{e.minimum / 1e6:.3f} ... {e.maximum / 1e6:.3f}"
                    for e in (pressures if liquid else ())
                ),
                decimals(leg["main_strut_absorbed"], 1),
                decimals(leg["main_strut_dissipated"], 1),
                decimals(leg["main_strut_efficiency"], 3),
            )
        )
    note = "Peaks between the samples too; forces negative in compression, strokes positive. "
    note += "Absorbed, dissipated and efficiency are of the first compression and rebound."
    return Table("Legs", head, rows, note)


def _loads(found: Landed) -> Table:
    time, rows = found.history.time, []
    in_space = found.parameters.drop.mode == SPACE
    groups = drawn_legs(found.history)
    for each in interface_loads(found.history):
        legs = next((g for g in groups if each.leg in g), ())
        if legs and each.leg != legs[0]:
            continue
        for peak in peaks(each, time):
            load = (f"{round(value / 1e3, 3) + 0.0:.3f}" for value in peak.load)
            name = f"leg {'/'.join(map(str, legs))}, {each.name}" if legs else each.name
            rows.append((name, COMPONENTS[peak.component], f"{peak.time:.4f}", *load))
    units = ("kN", "kN", "kN", "kN m", "kN m", "kN m")
    head = ("interface", "peak of", "at [s]", *(f"{c} [{u}]" for c, u in zip(COMPONENTS, units)))
    step = 1e3 * float(np.diff(time[:2])[0])
    return Table(
        "Loads at the interfaces",
        head,
        rows,
        "Each row is the largest amount of a component, with the whole load at that time: what "
        f"acts on the body, at the {FOOTPAD} what the ground does to it, at samples {step:.3g} ms "
        "apart. Axes are fixed in the body: radial outward, axial towards the top, tangential = "
        "radial x axial. A component that is zero throughout has no row."
        + ("" if in_space else " Of legs that are mirror images the first is shown."),
    )


def _energies(found: Landed) -> Table:
    rows = []
    for q in ENERGY_QUANTITIES:
        values = found.history[q.name]
        numbers = (float(values[0]), float(values[-1]), found.history.extreme(q.name).maximum)
        if any(numbers):
            rows.append((q.name, *(f"{n:.5g}" for n in numbers), q.meaning))
    return Table("Energies", ("energy", "start [J]", "end [J]", "largest [J]", "meaning"), rows)


def _audit_table(found: Audit) -> Table:
    rows = []
    for check in found.checks:
        b = BOUNDS[check.id]
        verdict = "does not apply" if not check.applies else "ok" if check.passed else "MISSED"
        bound = f"{b.side} {b.limit:g} {b.unit}".rstrip()
        rows.append((b.what, f"{check.value:.2g} {b.unit}".rstrip(), bound, verdict, b.reason))
    head = ("check", "value", "bound", "", "why this bound")
    return Table(f"Audit: {found.mode}, {found.case}", head, rows)
