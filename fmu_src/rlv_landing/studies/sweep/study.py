"""The study of a sweep: the landings to make and the responses to take from each.

It is read from TOML and checked before anything runs.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ...choices import choose_parameters
from ...effort import duration_text
from ...errors import LandingError, unknown
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...presets import to_toml
from ...quantities import MODES, SPACE, Interface, Quantity
from ...text.files import LARGEST_INTEGER
from .. import toml_keys
from ..landed import interface_for, landed_modes
from ..limits import LIMITS
from ..outcome import SLIDE
from ..variables import VARIABLES, check_variables
from ..whole_landing import check_samples
from .design import LEAST_SECONDS, Design, drawn, grid
from .factors import LARGEST, Factor, read_factor
from .responses import expand
from .states_table import read_states

# where a landing without `until` ends, unless it topples
ENDS = {
    "rests": "the vehicle is at rest",
    "stands": "it stands, and can neither tip over nor be loaded further",
}
METHODS = ("grid", "lhs", "sobol", "table")
TABLES = ("study", "set", "limits", "factor")
UNTIL = Quantity("s", "end of each landing", 1e-6, 3600.0, name="until", display_unit="s")
NUMBERS = {
    q.name: q
    for q in (
        Quantity(
            "s", "time between samples", 1e-6, 3600.0, name="every", default=1e-3, display_unit="s"
        ),
        Quantity(
            "", "relative tolerance of the integrator", 1e-12, 1e-2, name="rtol", default=1e-4
        ),
        SLIDE,
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
    "until",
    "end",
    *NUMBERS,
)


@dataclass(frozen=True)
class Study:
    """A study; values in SI.

    Attributes:
        name: The study's name.
        method: grid, lhs, sobol or table.
        samples: Samples drawn; 0 for a grid or table.
        seed: Seed of the points.
        parameters: The parameters that are not varied.
        modes: Landing modes, each landed for every sample; empty where the mode is varied.
        interface: The outputs of the landings; of legs that are varied, as many as there may be.
        until: End of each landing [s]; None: when it is decided.
        every: Time between samples [s].
        rtol: Relative tolerance of the integrator.
        slide: Largest distance that a footpad may move without having slid [m].
        end: Where a landing without `until` ends: of ENDS.
        responses: Names of the responses.
        limits: Limits by name.
        fixed: Values that are set in every landing, by name.
        factors: The quantities that are varied.
        table: Touchdown states.
        text: The file's text.
    """

    name: str
    method: str
    samples: int
    seed: int
    parameters: Parameters
    modes: tuple[str, ...]
    interface: Interface = field(compare=False)
    until: float | None
    every: float
    rtol: float
    slide: float
    end: str
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
        """Notes for the user before the study is run."""
        if self.method != "sobol" or self.samples & (self.samples - 1) == 0:
            return []
        below = 1 << (self.samples.bit_length() - 1)
        note = (
            "Sobol points are balanced where their number is a power of 2: "
            f"{below} or {2 * below}, not {self.samples}"
        )
        return [note]

    def record(self) -> dict[str, Any]:
        """Everything that decides a row, the points apart, for the fingerprint."""
        return {
            "method": self.method,
            "samples": self.samples,
            "seed": self.seed,
            "modes": list(self.modes),
            "until": self.until,
            "every": self.every,
            "rtol": self.rtol,
            "slide": self.slide,
            "end": self.end,
            "responses": list(self.responses),
            "limits": dict(self.limits),
            "set": dict(self.fixed),
            "factors": [f.record() for f in self.factors],
            "parameters": to_toml(self.parameters, comments=False),
        }


def read_study(path: Path) -> Study:
    """A study from a TOML file; `docs/studies.md` has every key.

    Files that it names lie beside it.

    Raises:
        LandingError: A missing file, TOML syntax, unknown keys or names, values out of bounds, an
            empty range, or a bad table.
    """
    document, text = toml_keys.read(path)
    try:
        return _study(document, path, text)
    except LandingError as e:
        raise LandingError(f"{path}: {e}") from None


def _study(document: dict[str, Any], path: Path, text: str) -> Study:
    """The study of a file's `document` and `text`."""
    toml_keys.refuse_unknown(document, TABLES, "table")
    keys = toml_keys.table(document, "study")
    toml_keys.refuse_unknown(keys, KEYS, "key of [study]")
    if not {"method", "table"} & keys.keys():
        raise LandingError(f"[study] has no method; write one of {', '.join(METHODS)}")
    method = toml_keys.text(keys, "method", "table")
    if method not in METHODS:
        raise unknown("method", method, METHODS)
    fixed = toml_keys.values(toml_keys.table(document, "set"), VARIABLES, "quantity in [set]")
    factors = tuple(read_factor(entry) for entry in toml_keys.tables(document, "factor"))
    given = [*fixed, *(f.name for f in factors)]
    _check_given_once(given)
    # a table says which quantities it has after its mode is known
    parameters = _parameters(keys, path, fixed)
    modes = _modes(keys, parameters, {*given})
    varied = {f.name: f.values or (f.low, f.high) for f in factors}
    landed = landed_modes(modes, parameters, fixed, varied)
    table = _states(keys, method, path, given, in_space=SPACE in landed)
    columns = table.columns if table is not None else {}
    if "drop.mode" in columns:
        modes = _modes(keys, parameters, {*given, *columns})
        landed = landed_modes(modes, parameters, fixed, {**varied, **columns})
    check_variables([*given, *columns], landed)
    if table is None and not factors:
        raise LandingError(
            "the study varies nothing; add a [[factor]], "
            'or method = "table" with table = "FILE.csv"'
        )
    samples = _samples(keys, method)
    set_ = {name: (value,) for name, value in fixed.items()}
    if method == "grid":
        grid(factors)
    numbers = {name: toml_keys.number(keys, q) for name, q in NUMBERS.items()}
    until = toml_keys.number(keys, UNTIL) if "until" in keys else None
    check_samples(numbers["every"], until)
    limits = toml_keys.values(toml_keys.table(document, "limits"), LIMITS, "limit")
    name = toml_keys.folder_name(keys, path.stem)
    return Study(
        name=name,
        method=method,
        samples=samples,
        seed=toml_keys.integer(keys, "seed", 1, 0, 2**31 - 1),
        parameters=parameters,
        modes=modes,
        interface=(interface := interface_for(landed, parameters, {**set_, **varied, **columns})),
        responses=expand(toml_keys.texts(keys, "responses"), interface),
        limits={name: float(v) for name, v in limits.items()},
        fixed=fixed,
        factors=factors,
        table=table,
        text=text,
        until=until,
        end=read_end(keys, "rests"),
        **numbers,
    )


def read_end(keys: Mapping[str, Any], default: str) -> str:
    """Where landings end, of ENDS.

    Raises:
        LandingError: It is none of them, or there is an `until` too.
    """
    end = toml_keys.text(keys, "end", default)
    if end not in ENDS:
        raise unknown("end", end, ENDS)
    if "until" in keys and "end" in keys:
        raise LandingError(
            f"end = {end!r} and until = {keys['until']!r} both say where a landing ends; leave one"
        )
    return end


def _check_given_once(given: list[str]) -> None:
    for name in given:
        if given.count(name) > 1:
            raise LandingError(f"{name} is given twice, in [set] or as a [[factor]]; leave one")


def _states(
    keys: Mapping[str, Any], method: str, path: Path, given: Collection[str], *, in_space: bool
) -> Design | None:
    if method != "table":
        for key in ("table", "ignore"):
            if key in keys:
                raise LandingError(
                    f'{key} = {keys[key]!r} belongs to method = "table"; '
                    f"this study's is {method!r}"
                )
        return None
    if "table" not in keys:
        raise LandingError('method = "table" needs table = "FILE.csv", the touchdown states')
    return read_states(
        path.parent / toml_keys.text(keys, "table", ""),
        toml_keys.texts(keys, "ignore") or (),
        given,
        in_space=in_space,
    )


def _parameters(
    keys: Mapping[str, Any], path: Path, fixed: Mapping[str, float | str]
) -> Parameters:
    preset = toml_keys.text(keys, "preset", "") if "preset" in keys else None
    file = path.parent / toml_keys.text(keys, "parameters", "") if "parameters" in keys else None
    parameters = choose_parameters(preset, file)
    own = {name: value for name, value in fixed.items() if name in PARAMETER_QUANTITIES}
    # only a vehicle in space may have what is set for it
    if keys.get("modes") == [SPACE]:
        parameters = parameters.for_mode(SPACE)
    elif own.get("drop.mode") == SPACE:
        parameters = parameters.for_mode(str(own.pop("drop.mode")))
    return parameters.with_values(own, "study")


def _modes(
    keys: Mapping[str, Any], parameters: Parameters, given: Collection[str]
) -> tuple[str, ...]:
    modes = toml_keys.texts(keys, "modes")
    if "drop.mode" in given:
        if modes is not None:
            raise LandingError(
                "drop.mode is given as a factor, in [set] or in the table, and modes in [study]; "
                "leave one"
            )
        return ()
    for mode in modes or ():
        if mode not in (*MODES, SPACE):
            raise unknown("landing mode", mode, (*MODES, SPACE))
    return tuple(modes) if modes is not None else (parameters.drop.mode,)


def _samples(keys: Mapping[str, Any], method: str) -> int:
    if method in ("grid", "table"):
        if "samples" in keys:
            raise LandingError(
                f'samples = {keys["samples"]!r} belongs to "lhs" and "sobol"; '
                f"a {method} has as many as its points are"
            )
        return 0
    if "samples" not in keys:
        raise LandingError(f"{method} needs samples = N, the number of points")
    samples = toml_keys.integer(keys, "samples", 0, 1, LARGEST_INTEGER)
    if samples > LARGEST:
        raise LandingError(
            f"samples = {samples} is more than {LARGEST}, and would take "
            f"{duration_text(samples * LEAST_SECONDS)} on one core at least; take fewer"
        )
    return samples
