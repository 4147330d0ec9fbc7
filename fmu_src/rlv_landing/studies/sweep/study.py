"""A study: which landings to make and what to take off each.

Read from TOML, checked before anything runs.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ...choices import choose_parameters
from ...errors import LandingError, unknown
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...presets import to_toml
from ...quantities import MODES, Quantity
from .. import toml_keys
from ..outcome import DEFAULT_SLIDE, LIMITS
from .design import LARGEST, Design, drawn, grid
from .factors import VARIABLES, Factor, read_factor
from .responses import expand
from .states_table import read_states

METHODS = ("grid", "lhs", "sobol", "table")
TABLES = ("study", "set", "limits", "factor")
NUMBERS = {
    q.name: q
    for q in (
        Quantity(
            "s", "end of each landing", 1e-6, 3600.0, name="until", default=1.0, display_unit="s"
        ),
        Quantity(
            "s", "time between samples", 1e-6, 3600.0, name="every", default=1e-3, display_unit="s"
        ),
        Quantity(
            "", "relative tolerance of the integrator", 1e-12, 1e-2, name="rtol", default=1e-4
        ),
        Quantity(
            "m",
            "what a footpad may move and has not slid",
            0.0,
            1e3,
            name="slide",
            default=DEFAULT_SLIDE,
        ),
    )
}
KEYS = (
    "name",
    "method",
    "samples",
    "seed",
    "table",
    "ignore",
    "preset",
    "parameters",
    "modes",
    "responses",
    *NUMBERS,
)


@dataclass(frozen=True)
class Study:
    """A study as it is run; values in SI.

    `fixed` are set in every landing, `factors` varied, `table` holds touchdown states. `modes` are
    landed for each sample; none where the mode is varied.
    """

    name: str
    method: str
    samples: int
    seed: int
    parameters: Parameters
    modes: tuple[str, ...]
    until: float
    every: float
    rtol: float
    slide: float
    responses: tuple[str, ...]
    limits: Mapping[str, float]
    fixed: Mapping[str, float | str]
    factors: tuple[Factor, ...]
    table: Design | None = field(default=None, compare=False)
    text: str = ""

    @cached_property
    def design(self) -> Design:
        """The points of the sweep, one row a sample."""
        if self.method == "grid":
            return grid(self.factors)
        if self.table is not None:
            varied = drawn(self.factors, "lhs", len(self.table), self.seed)
            return Design({**self.table.columns, **varied.columns}, len(self.table))
        return drawn(self.factors, self.method, self.samples, self.seed)

    @property
    def notes(self) -> list[str]:
        """What a user should know of this study before running it."""
        if self.method != "sobol" or self.samples & (self.samples - 1) == 0:
            return []
        below = 1 << (self.samples.bit_length() - 1)
        return [
            f"Sobol points are balanced where their number is a power of 2: {below} or {2 * below}, not {self.samples}"
        ]

    def record(self) -> dict[str, Any]:
        """All that decides a row, the points apart: for the fingerprint."""
        return {
            "method": self.method, "samples": self.samples, "seed": self.seed, "modes": list(self.modes), "until": self.until,
            "every": self.every, "rtol": self.rtol, "slide": self.slide, "responses": list(self.responses), "limits": dict(self.limits),
            "set": dict(self.fixed), "factors": [f.record() for f in self.factors], "parameters": to_toml(self.parameters, comments=False),
        }  # fmt: skip


def read_study(path: Path) -> Study:
    """A study from a TOML file; `docs/studies.md` has every key. Files that it names lie beside it.

    Raises LandingError: missing file, TOML syntax, unknown keys or names, values out of bounds, an
        empty range, a bad table.
    """
    document, text = toml_keys.read(path)
    try:
        return _study(document, path, text)
    except LandingError as e:
        raise LandingError(f"{path}: {e}") from None


def _study(document: dict[str, Any], path: Path, text: str) -> Study:
    toml_keys.only(document, TABLES, "table")
    told = toml_keys.table(document, "study")
    toml_keys.only(told, KEYS, "key of [study]")
    method = toml_keys.text(told, "method", "table" if "table" in told else "none")
    if method not in METHODS:
        raise unknown("method", method, METHODS)
    fixed = toml_keys.values(toml_keys.table(document, "set"), VARIABLES, "quantity in [set]")
    factors = tuple(read_factor(entry) for entry in toml_keys.tables(document, "factor"))
    given = [*fixed, *(f.name for f in factors)]
    for name in given:
        if given.count(name) > 1:
            raise LandingError(f"{name} is given twice, in [set] or as a [[factor]]; leave one")
    table = _states(told, method, path, given)
    if table is None and not factors:
        raise LandingError(
            'the study varies nothing; add a [[factor]], or method = "table" with table = "FILE.csv"'
        )
    samples = _samples(told, method)
    if method == "grid":
        grid(factors)
    parameters = _parameters(told, path, fixed)
    numbers = {name: toml_keys.number(told, q) for name, q in NUMBERS.items()}
    if numbers["every"] > numbers["until"]:
        raise LandingError(
            f"every = {numbers['every']:g} s is above until = {numbers['until']:g} s; no landing would have a second sample"
        )
    limits = {
        name: float(v)
        for name, v in toml_keys.values(
            toml_keys.table(document, "limits"), LIMITS, "limit"
        ).items()
    }
    name = toml_keys.text(told, "name", path.stem)
    if Path(name).name != name:
        raise LandingError(f"name = {name!r} names a folder; take one without '/'")
    return Study(
        name=name,
        method=method,
        samples=samples,
        seed=toml_keys.whole(told, "seed", 1, 0, 2**31 - 1),
        parameters=parameters,
        modes=_modes(told, parameters, {*given, *(table.columns if table is not None else ())}),
        responses=expand(toml_keys.texts(told, "responses")),
        limits=limits,
        fixed=fixed,
        factors=factors,
        table=table,
        text=text,
        **numbers,
    )


def _states(
    told: Mapping[str, Any], method: str, path: Path, given: Collection[str]
) -> Design | None:
    if method != "table":
        for key in ("table", "ignore"):
            if key in told:
                raise LandingError(
                    f'{key} = {told[key]!r} belongs to method = "table"; this study\'s is {method!r}'
                )
        return None
    if "table" not in told:
        raise LandingError('method = "table" needs table = "FILE.csv", the touchdown states')
    return read_states(
        path.parent / toml_keys.text(told, "table", ""),
        toml_keys.texts(told, "ignore") or (),
        given,
    )


def _parameters(
    told: Mapping[str, Any], path: Path, fixed: Mapping[str, float | str]
) -> Parameters:
    preset = toml_keys.text(told, "preset", "") if "preset" in told else None
    file = path.parent / toml_keys.text(told, "parameters", "") if "parameters" in told else None
    parameters = choose_parameters(preset, file)
    return parameters.with_values(
        {name: value for name, value in fixed.items() if name in PARAMETER_QUANTITIES}, "study"
    )


def _modes(
    told: Mapping[str, Any], parameters: Parameters, given: Collection[str]
) -> tuple[str, ...]:
    modes = toml_keys.texts(told, "modes")
    if "drop.mode" in given:
        if modes is not None:
            raise LandingError(
                "drop.mode is given as a factor, in [set] or in the table, and modes in [study]; leave one"
            )
        return ()
    for mode in modes or ():
        if mode not in MODES:
            raise unknown("landing mode", mode, MODES)
    return tuple(modes) if modes is not None else (parameters.drop.mode,)


def _samples(told: Mapping[str, Any], method: str) -> int:
    if method in ("grid", "table"):
        if "samples" in told:
            raise LandingError(
                f'samples = {told["samples"]!r} belongs to "lhs" and "sobol"; a {method} has as many as its points are'
            )
        return 0
    if "samples" not in told:
        raise LandingError(f"{method} needs samples = N, the number of points")
    return toml_keys.whole(told, "samples", 0, 1, LARGEST)
