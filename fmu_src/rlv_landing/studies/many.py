"""`land_many`: a batch of landings in threads, as arrays."""

from __future__ import annotations

import warnings
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..audit.transverse import study_warning
from ..errors import LandingError, unknown
from ..parameters import Parameters, check_value
from ..quantities import Quantity
from ..text.values import number_in_si, split_heading, unit_of
from ..workers import default_workers
from .landed import interface_for
from .limits import check_limits
from .outcome import SLIDE
from .study_effort import check_landings
from .sweep.design import Design
from .sweep.factors import column
from .sweep.responses import JUDGED, LEGS_PEAKS, expand, known_responses, suited
from .sweep.study import ENDS, NUMBERS, UNTIL
from .sweep.sweep import threads
from .sweep.sweep_row import MODE, Plan
from .variables import check_variables, variable
from .whole_landing import check_samples

if TYPE_CHECKING:
    import pandas

# the columns of a batch where none are asked for: outcome, margins and peaks
PEAKS = (
    *JUDGED,
    *LEGS_PEAKS,
    "leg[*].main_strut.force.min",
    "leg[*].main_strut.stroke.max",
    "leg[*].auxiliary_strut.force.abs_max",
    "leg[*].contact.force_y.max",
    "body.top_axial_acceleration.max",
    "rhs_calls",
)
# peaks do not depend on the samples' distance; sliding and rest are found to it [s]
EVERY = 1e-2
RTOL = 1e-4
STATES = "give columns by name, or a sequence of mappings"


@dataclass(frozen=True)
class Landings:
    """The responses of a batch of landings, in the order of its states.

    `landings["margin.stability_min"]` is an array (n,): numbers in SI, NaN where a landing has
    none; of texts such as `outcome`, and of legs, objects, None where there is none.

    Attributes:
        columns: The responses by name.
        errors: For each landing why it could not be made; None where it was.
        quantities: The responses' units and meanings, by name.
    """

    columns: Mapping[str, NDArray[Any]]
    errors: tuple[str | None, ...]
    quantities: Mapping[str, Quantity]

    def __len__(self) -> int:
        return len(self.errors)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise unknown("response", name, self.columns)
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def to_pandas(self) -> pandas.DataFrame:
        """A table with a row for each landing; `attrs["units"]` has the units.

        Raises:
            LandingError: pandas is not installed.
        """
        try:
            library = import_module("pandas")
        except ImportError as e:
            raise LandingError(f"pandas is not installed ({e}); pip install pandas") from None
        frame: pandas.DataFrame = library.DataFrame({**self.columns, "error": list(self.errors)})
        frame.attrs["units"] = {name: q.unit for name, q in self.quantities.items()}
        return frame


def land_many(  # noqa: PLR0913  the options of a study, by name
    parameters: Parameters,
    states: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]],
    *,
    responses: Sequence[str] | None = None,
    limits: Mapping[str, float] | None = None,
    until: float | None = None,
    every: float = EVERY,
    rtol: float = RTOL,
    slide: float = float(SLIDE.default),
    end: str = "stands",
    workers: int | None = None,
    progress: Callable[[int], object] | None = None,
) -> Landings:
    """Land once from each of the `states`, in threads.

    With `vehicle.transverse_load_at = joint` it warns (UserWarning) of the energy that it creates.

    The numbers are those of `Landing`, whatever the number of threads. A landing that cannot be
    made is a row with its error, and ends none of the others. Ctrl-C raises KeyboardInterrupt when
    the landings under way are done.

    Args:
        parameters: The vehicle, its ground, and what the states leave out; `drop.mode` is the mode
            of all.
        states: Columns by name, each as long as the others, as a mapping or data frame; or a
            sequence of mappings with the same names. Names are those of parameters and of inputs,
            which are constant, and `drop.speed` and `drop.direction`; numbers are in SI, or in the
            unit of a name such as `drop.tilt [deg]`.
        responses: Names and patterns of responses, see docs/studies.md [outcome, margins, peaks].
        limits: Limits by name in `rlv_landing.studies.limits.LIMITS` [SI].
        until: End of each landing [s]; None: when it is decided, see `whole_landing`.
        every: Time between samples [s]; peaks do not depend on it.
        rtol: Relative tolerance of the integrator.
        slide: Largest distance that a footpad may move without having slid [m].
        end: Without `until`, where a landing ends that does not topple: where the vehicle `stands`
            and its outcome and peaks are decided, or where it `rests`, twice as late.
        workers: Threads [all cores that this process may use].
        progress: Called with the number of landings done so far.

    Raises:
        LandingError: A name or unit is unknown or belongs to another mode, columns have different
            lengths, an argument is out of bounds, or there is not the memory for it.
    """
    mode = parameters.drop.mode
    design = _design(states, mode)
    interface = interface_for([mode], parameters, design.columns)
    names = expand(suited(PEAKS, interface) if responses is None else responses, interface)
    _check_numbers(until, every, rtol, slide, workers)
    count = workers or default_workers()
    if len(design):
        check_landings(len(design), count, until, every, decided=until is None)
    if end not in ENDS:
        raise unknown("end", end, ENDS)
    checked = check_limits(limits or {})
    plan = Plan(
        parameters, {}, {}, until, every, rtol, names, checked, float(slide), end == "stands"
    )
    joint = study_warning(parameters, design.columns, {})
    if joint is not None:
        warnings.warn(joint, stacklevel=2)
    rows = _landed(plan, design, count, progress)
    known = known_responses(interface)
    taken = zip(*(row[2:] for row in rows)) if rows else ([] for _ in names)
    columns = {name: _column(known[name], values) for name, values in zip(names, taken)}
    errors = tuple(row[1] for row in rows)
    return Landings(columns, errors, {name: known[name] for name in names})


def _landed(
    plan: Plan, design: Design, workers: int, progress: Callable[[int], object] | None
) -> list[list[Any]]:
    rows: list[list[Any]] = []
    with threads(plan, workers) as engine:
        waiting: deque[Any] = deque()

        def take() -> None:
            rows.extend(engine.result(waiting.popleft()))
            if progress is not None:
                progress(len(rows))

        for first in range(0, len(design), engine.rows):
            given = design.rows(first, min(first + engine.rows, len(design)))
            waiting.append(engine.submit(given))
            while len(waiting) >= engine.capacity():
                take()
        while waiting:
            take()
    return rows


def _design(states: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]], mode: str) -> Design:
    """The states as columns in SI; a value that is no number stays, and is its row's error."""
    if isinstance(states, Sequence):
        states = _transposed(states)
    elif not hasattr(states, "keys"):
        raise LandingError(f"the states are a {type(states).__name__}; {STATES}")
    columns: dict[str, NDArray[Any]] = {}
    for heading in states:
        name, unit = split_heading(str(heading))
        q = variable(name, "quantity of the states")
        if name == MODE:
            raise LandingError(f"{MODE} is the same for all states; give it in the parameters")
        if name in columns:
            raise LandingError(f"the states have two columns of {name}; leave one")
        own = None if q.choices else unit_of(q, unit)
        columns[name] = column(
            number_in_si(q, float(v), own) if own is not None and _is_real(v) else _kept(v)
            for v in _values(str(heading), states[heading])
        )
    check_variables([*columns], [mode])
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        few, many = min(lengths, key=lengths.__getitem__), max(lengths, key=lengths.__getitem__)
        raise LandingError(
            f"the states have {lengths[few]} values of {few} and {lengths[many]} of {many}; "
            "give every column one for each landing"
        )
    return Design(columns, max(lengths.values(), default=0))


def _transposed(states: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    if isinstance(states, str) or not all(isinstance(state, Mapping) for state in states):
        raise LandingError(f"the states are no mappings; {STATES}")
    names = list(states[0]) if states else []
    for number, state in enumerate(states):
        if set(state) != set(names):
            odd = sorted(set(state) ^ set(names))
            raise LandingError(
                f"state {number} and state 0 do not have the same names ({odd[0]}); "
                "give every state all of them"
            )
    return {name: [state[name] for state in states] for name in names}


def _values(heading: str, given: Any) -> list[Any]:
    try:
        return list((given,) if isinstance(given, str) else given)
    except TypeError:
        raise LandingError(f"{heading} = {given!r} is one value; {STATES}") from None


def _kept(value: Any) -> Any:
    """A value that is no number, so that its landing is refused: as an array's entry it may be."""
    return value if isinstance(value, str) or value is None else repr(value)


def _is_real(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def _check_numbers(
    until: float | None, every: float, rtol: float, slide: float, workers: int | None
) -> None:
    for name, value in (("every", every), ("rtol", rtol), ("slide", slide)):
        check_value(NUMBERS[name], value)
    if until is not None:
        check_value(UNTIL, until)
    check_samples(every, until)
    if workers is None:
        return
    if isinstance(workers, bool) or not isinstance(workers, (int, np.integer)) or workers < 1:
        raise LandingError(f"workers = {workers!r} must be a whole number of 1 or more")


def _column(q: Quantity, values: Sequence[Any]) -> NDArray[Any]:
    if q.kind == "real":
        return np.array([np.nan if v is None else v for v in values], dtype=float)
    found = np.empty(len(values), dtype=object)
    found[:] = values
    return found
