"""The study of a Monte Carlo: what varies and how, what is lost, and when it is enough.

It is read from TOML and checked before anything lands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...choices import choose_parameters
from ...errors import LandingError, unknown
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...quantities import SPACE, Interface, Quantity
from ...text.files import LARGEST_INTEGER
from ...text.values import parse_value
from .. import toml_keys
from ..criteria import CRITERIA
from ..landed import interface_for
from ..limits import LIMITS
from ..outcome import SLIDE
from ..sweep.factors import LARGEST, read_factor
from ..sweep.responses import LEGS_PEAKS, expand, known_responses, suited
from ..sweep.states_table import read_states
from ..sweep.study import UNTIL, Study, read_end
from ..variables import VARIABLES, check_variables
from ..whole_landing import check_samples
from .covariance import read_correlated
from .dispersions import Dispersions, Table
from .grades import Grade, read_grades

TABLES = ("montecarlo", "set", "limits", "factor", "covariance", "table", "grade")
NUMBERS = {
    q.name: q
    for q in (
        Quantity("s", "time between samples", 1e-5, 1.0, name="every", default=1e-2),
        Quantity(
            "", "relative tolerance of the integrator", 1e-12, 1e-2, name="rtol", default=1e-4
        ),
        SLIDE,
    )
}
LEVEL = Quantity("", "confidence of the intervals", 0.5, 0.9999, name="level", default=0.95)
WIDTH = Quantity("", "width of the interval of the rate of success", 1e-5, 1.0, name="width")
KEYS = (
    *(
        "name",
        "samples",
        "seed",
        "preset",
        "parameters",
        "mode",
        "until",
        "end",
        "criterion",
        "width",
    ),
    *("level", "responses", "loads", "percentiles", "worst", *NUMBERS),
)
# what every study takes from its landings
ALWAYS = ("outcome", "outcome.*", "margin.*")
# what is ranked and has percentiles where the study names nothing
LOADS = (
    *LEGS_PEAKS,
    "body.top_axial_acceleration.max",
    "margin.stability_min",
    "margin.stroke_left",
    "margin.slid",
    "margin.joint_clearance",
)
DRAWS = ("in order", "at random")
SAMPLES = 1000


@dataclass(frozen=True)
class MonteCarlo:
    """A Monte Carlo study; values in SI.

    Attributes:
        sweep: What its landings share with those of a sweep: vehicle, responses, limits.
        dispersions: What varies.
        samples: The most runs.
        criterion: Which landings are lost.
        level: Confidence of the intervals.
        width: The runs end where the interval of the rate of success is no wider; None: never.
        loads: Responses that are ranked and have percentiles.
        percentiles: Percentages of landings.
        worst: How many of the worst landings of each load are named.
        grades: The grades, the best first.
    """

    sweep: Study
    dispersions: Dispersions
    samples: int
    criterion: str
    level: float
    width: float | None
    loads: tuple[str, ...]
    percentiles: tuple[float, ...]
    worst: int
    grades: tuple[Grade, ...]

    @property
    def interface(self) -> Interface:
        """The outputs of its landings."""
        return self.sweep.interface

    def record(self) -> dict[str, Any]:
        """Everything that decides a row, for the fingerprint: the number of runs is not in it."""
        shared = self.sweep.record()
        for key in ("samples", "factors"):
            del shared[key]
        return {**shared, "dispersions": self.dispersions.record()}


def read_montecarlo(path: Path) -> MonteCarlo:
    """A study from a TOML file; `docs/montecarlo.md` has every key.

    Raises:
        LandingError: A missing file, TOML syntax, unknown keys or names, values out of bounds, a
            covariance that is none, or nothing that varies.
    """
    document, text = toml_keys.read(path)
    try:
        return _montecarlo(document, path, text)
    except LandingError as e:
        raise LandingError(f"{path}: {e}") from None


def _montecarlo(document: Mapping[str, Any], path: Path, text: str) -> MonteCarlo:
    toml_keys.refuse_unknown(document, TABLES, "table")
    keys = toml_keys.table(document, "montecarlo")
    toml_keys.refuse_unknown(keys, KEYS, "key of [montecarlo]")
    fixed = toml_keys.values(toml_keys.table(document, "set"), VARIABLES, "quantity in [set]")
    parameters = _parameters(keys, path, fixed)
    mode = parameters.drop.mode
    dispersions = _dispersions(document, keys, path, mode, fixed)
    check_variables([*fixed, *dispersions.names], [mode])
    samples = _samples(keys, dispersions)
    varied: dict[str, Any] = dict.fromkeys(dispersions.names, ())
    varied.update({f.name: f.values or (f.low, f.high) for f in dispersions.factors})
    if dispersions.table is not None:
        varied.update(dispersions.table.design.columns)
    interface = interface_for([mode], parameters, varied)
    loads = expand(toml_keys.texts(keys, "loads") or suited(LOADS, interface), interface)
    grades = read_grades(toml_keys.tables(document, "grade"), known_responses(interface))
    limits = toml_keys.values(toml_keys.table(document, "limits"), LIMITS, "limit")
    criterion = toml_keys.text(keys, "criterion", "toppled")
    if criterion not in CRITERIA:
        raise unknown("criterion", criterion, CRITERIA)
    if criterion == "limit" and not limits:
        raise LandingError('criterion = "limit" needs [limits]; add for example main_strut.force')
    numbers = {name: toml_keys.number(keys, q) for name, q in NUMBERS.items()}
    until = toml_keys.number(keys, UNTIL) if "until" in keys else None
    check_samples(numbers["every"], until)
    _check_numbers(loads, interface)
    bounded = [name for g in grades for name in (*g.most, *g.least)]
    asked = expand(toml_keys.texts(keys, "responses") or (), interface)
    always = expand(ALWAYS, interface)
    name = toml_keys.folder_name(keys, path.stem)
    sweep = Study(
        name=name,
        method="montecarlo",
        samples=0,
        seed=dispersions.seed,
        parameters=parameters,
        modes=(mode,),
        interface=interface,
        until=until,
        responses=tuple(dict.fromkeys((*always, *loads, *bounded, *asked))),
        limits={name: float(v) for name, v in limits.items()},
        fixed=fixed,
        factors=dispersions.factors,
        text=text,
        every=numbers["every"],
        rtol=numbers["rtol"],
        slide=numbers["slide"],
        end=read_end(keys, "stands"),
    )
    return MonteCarlo(
        sweep=sweep,
        dispersions=dispersions,
        samples=samples,
        criterion=criterion,
        level=toml_keys.number(keys, LEVEL),
        width=toml_keys.number(keys, WIDTH) if "width" in keys else None,
        loads=loads,
        percentiles=_percentiles(keys),
        worst=toml_keys.integer(keys, "worst", 3, 0, 100),
        grades=grades,
    )


def _parameters(
    keys: Mapping[str, Any], path: Path, fixed: Mapping[str, float | str]
) -> Parameters:
    preset = toml_keys.text(keys, "preset", "") if "preset" in keys else None
    file = path.parent / toml_keys.text(keys, "parameters", "") if "parameters" in keys else None
    mode = toml_keys.text(keys, "mode", "") if "mode" in keys else None
    if mode is not None and "drop.mode" in fixed:
        raise LandingError("drop.mode is given in [set], and mode in [montecarlo]; leave one")
    own = {name: value for name, value in fixed.items() if name in PARAMETER_QUANTITIES}
    return choose_parameters(preset, file, mode, own)


def _dispersions(
    document: Mapping[str, Any],
    keys: Mapping[str, Any],
    path: Path,
    mode: str,
    fixed: Mapping[str, Any],
) -> Dispersions:
    factors = tuple(read_factor(entry) for entry in toml_keys.tables(document, "factor"))
    correlated = read_correlated(toml_keys.table(document, "covariance"))
    given = [*fixed, *(f.name for f in factors), *(correlated.names if correlated else ())]
    for name in given:
        if given.count(name) > 1:
            raise LandingError(
                f"{name} is given twice, in [set], as a [[factor]] or in [covariance]; leave one"
            )
        if name == "drop.mode" and name not in fixed:
            raise LandingError("drop.mode does not vary in a Monte Carlo; give mode = ...")
    table = _table(toml_keys.table(document, "table"), path, given, in_space=mode == SPACE)
    if table is None and correlated is None and not factors:
        raise LandingError("the study varies nothing; add a [[factor]], [covariance] or [table]")
    seed = toml_keys.integer(keys, "seed", 1, 0, 2**31 - 1)
    return Dispersions(seed, factors, correlated, table)


def _table(
    keys: Mapping[str, Any], path: Path, given: Sequence[str], *, in_space: bool
) -> Table | None:
    if not keys:
        return None
    toml_keys.refuse_unknown(keys, ("file", "ignore", "draw"), "key of [table]")
    if "file" not in keys:
        raise LandingError('[table] has no file; write file = "states.csv"')
    draw = toml_keys.text(keys, "draw", DRAWS[0])
    if draw not in DRAWS:
        raise unknown("draw of [table]", draw, DRAWS)
    file = path.parent / toml_keys.text(keys, "file", "")
    ignored = toml_keys.texts(keys, "ignore") or ()
    design = read_states(file, ignored, given, in_space=in_space)
    if "drop.mode" in design.columns:
        raise LandingError(f"{file}: drop.mode does not vary in a Monte Carlo; give mode = ...")
    return Table(design, draw == "at random")


def _samples(keys: Mapping[str, Any], dispersions: Dispersions) -> int:
    table = dispersions.table
    rows = LARGEST if table is None or table.at_random else len(table.design)
    samples = toml_keys.integer(keys, "samples", min(SAMPLES, rows), 1, LARGEST_INTEGER)
    if samples > rows:
        remedy = "take fewer" if rows == LARGEST else 'take fewer, or draw = "at random"'
        what = "is possible" if rows == LARGEST else "the table has rows"
        raise LandingError(f"samples = {samples} is more than {what}, {rows}; {remedy}")
    return samples


def _percentiles(keys: Mapping[str, Any]) -> tuple[float, ...]:
    given = keys.get("percentiles", [50.0, 95.0, 99.0])
    if not isinstance(given, list) or not given:
        raise LandingError(f"percentiles = {given!r} must be a list of numbers from 0 to 100")
    q = Quantity("", "percentage of landings", 0.0, 100.0, name="percentiles")
    return tuple(sorted({float(parse_value(q, v)) for v in given}))


def _check_numbers(loads: Sequence[str], interface: Interface) -> None:
    known = known_responses(interface)
    for name in loads:
        if known[name].kind != "real":
            raise LandingError(f"loads: {name} is no real number, and has no percentiles; leave it")


def low_is_bad(name: str) -> bool:
    """Whether small values of a response are the bad ones: of a margin, or the least of an output.

    What slid is no margin that is used up.
    """
    return name.endswith(".min") or (name.startswith("margin.") and name != "margin.slid")


def severity(name: str, value: float) -> float:
    """A response's value so that the worst landing has the greatest."""
    return -value if low_is_bad(name) else value
