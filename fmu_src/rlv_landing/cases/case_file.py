"""The file of a case: a vehicle, its landing, where the numbers are from, and the numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from ..errors import LandingError, unknown
from ..landing import DEFAULT_RTOL
from ..parameters import GROUPS, Parameters
from ..presets import parameters_of_document
from ..quantities import Interface, Quantity
from ..studies.outcome import SEVERITY
from ..studies.toml_keys import by_dotted_name
from ..text.files import parse_document, read_text
from ..text.values import is_number, parse_value, to_si
from .closed_forms import closed_form

FOLDER = Path(__file__).parent
TIME = Quantity("s", "", 0.0, 1e4, name="time")
RELATIVE = Quantity("", "", 0.0, 10.0, name="relative")
RTOL = Quantity("", "", 1e-12, 1e-2, name="rtol")
OWN = ("title", "source", "page", "differences", "until", "rtol", "closed_form", "inputs", "number")
ABOUT_VEHICLE = ("preset", "complete", "mode", "leg", *GROUPS)
# what a number may be of, and the other keys that it then has
KINDS: dict[str, tuple[str, ...]] = {
    "output": ("at", "since", "peak"),
    "contact": (),
    "outcome": (),
}
COMMON = ("value", "tolerance", "relative", "page")
SIDES = ("min", "max", "abs_max")


@dataclass(frozen=True)
class Number:
    """A number of a case.

    Attributes:
        quantity: What it is a value of: an output, or a time.
        theirs: The case's value [SI].
        tolerance: How far ours may be from it [SI].
        at: The time of the value [s]; None for an extreme, or the time of a contact.
        since: A time whose value is taken off [s].
        peak: Which extreme until the end of the landing; empty for none.
        contact: The leg whose first contact it is the time of; 0 for none.
        page: Where the source has it.
    """

    quantity: Quantity
    theirs: float
    tolerance: float
    at: float | None = None
    since: float | None = None
    peak: str = ""
    contact: int = 0
    page: str = ""

    @property
    def label(self) -> str:
        """What it is, in a few words."""
        if self.contact:
            return f"first contact of leg {self.contact}"
        if self.peak:
            return f"{self.quantity.name} {self.peak}"
        since = f" less that at {self.since:g} s" if self.since is not None else ""
        return f"{self.quantity.name} at {self.at:g} s{since}"


@dataclass(frozen=True)
class Case:
    """A landing to be compared.

    Attributes:
        name: The file's name.
        title: What it is, in a line.
        source: Who has computed or measured it, and where it is printed.
        differences: Why ours may differ.
        parameters: The vehicle, its ground and its drop.
        inputs: Inputs from the start on [SI].
        until: The end of the landing [s].
        rtol: The tolerance to land with.
        numbers: The numbers.
        outcome: The outcome at the end; empty where none is told.
        page: Where the source has it.
    """

    name: str
    title: str
    source: str
    differences: str
    parameters: Parameters
    inputs: Mapping[str, float]
    until: float
    rtol: float
    numbers: tuple[Number, ...]
    outcome: str = ""
    page: str = ""
    closed_form: str = field(default="")


def case_names() -> list[str]:
    """The names of the cases that come with the package."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def find_case(name: str) -> Case:
    """The case of this name, or in the file of this name.

    Raises:
        LandingError: There is none, or its file is wrong.
    """
    if name in case_names():
        return read_case(FOLDER / f"{name}.toml")
    if name.endswith(".toml") or Path(name).exists():
        return read_case(Path(name))
    known = unknown("case", name, [*case_names(), "all"])
    raise LandingError(f"{known}; `rlv-landing validate --case` lists them")


def read_case(path: Path) -> Case:
    """The case in a file.

    Raises:
        LandingError: The file is missing, its TOML syntax is wrong, or a key or a value is.
    """
    text = read_text(path, "case")
    document = parse_document(text, str(path))
    try:
        return _case(path.stem, document, path.parent)
    except LandingError as e:
        raise LandingError(f"{path}: {e}") from None


def _case(name: str, document: dict[str, Any], folder: Path) -> Case:
    for key in document:
        if key not in (*OWN, *ABOUT_VEHICLE):
            raise unknown("key", key, (*OWN, *ABOUT_VEHICLE))
    for key in ("title", "source", "until"):
        if key not in document:
            raise LandingError(f"a case needs {key}; write {key} = ...")
    vehicle = {key: value for key, value in document.items() if key in ABOUT_VEHICLE}
    parameters = parameters_of_document(vehicle, folder)
    interface = parameters.interface
    until = _number(TIME, document["until"])
    listed = document.get("number", [])
    if not isinstance(listed, list) or not all(isinstance(entry, dict) for entry in listed):
        raise LandingError("number must be a list of tables: number = [{ output = ..., ... }]")
    outcomes = [str(entry["outcome"]) for entry in listed if "outcome" in entry]
    for told in outcomes:
        if told not in SEVERITY:
            raise unknown("outcome", told, SEVERITY)
    if len(outcomes) > 1:
        raise LandingError("a landing has one outcome; leave one")
    numbers = [n for k, entry in enumerate(listed, 1) for n in _numbers(k, entry, interface, until)]
    form = _text(document, "closed_form")
    if form:
        for output, at, since, theirs, tolerance in closed_form(form, parameters, until):
            quantity = _output(interface, output)
            numbers.append(Number(quantity, theirs, tolerance, at, since))
    if not numbers and not outcomes:
        raise LandingError("it has no numbers; write number = [{ output = ..., ... }]")
    inputs = document.get("inputs", {})
    if not isinstance(inputs, dict):
        raise LandingError("inputs must be a table: write [inputs]")
    return Case(
        name=name,
        title=_text(document, "title"),
        source=_text(document, "source"),
        differences=_text(document, "differences"),
        parameters=parameters,
        inputs={
            what: _input(interface, what, value) for what, value in by_dotted_name(inputs).items()
        },
        until=until,
        rtol=_number(RTOL, document.get("rtol", DEFAULT_RTOL)),
        numbers=tuple(numbers),
        outcome=outcomes[0] if outcomes else "",
        page=_text(document, "page"),
        closed_form=form,
    )


def _numbers(k: int, entry: dict[str, Any], interface: Interface, until: float) -> Iterator[Number]:
    """The number of an entry of the list, the `k`-th; none for an outcome."""
    kinds = [kind for kind in KINDS if kind in entry]
    if len(kinds) != 1:
        raise LandingError(f"number {k} is of {len(kinds)} things; give one of {', '.join(KINDS)}")
    allowed = (*kinds, *KINDS[kinds[0]], *COMMON)
    for key in entry:
        if key not in allowed:
            raise unknown(f"key of number {k}", key, allowed)
    if kinds[0] == "outcome":
        return
    at = since = None
    peak, contact = str(entry.get("peak", "")), 0
    if kinds[0] == "contact":
        quantity, contact = TIME, entry["contact"]
        if contact not in interface.legs:
            raise LandingError(f"number {k}: contact = {contact!r} is no leg's number")
    else:
        quantity = _output(interface, entry["output"])
        if (peak == "") == ("at" not in entry):
            raise LandingError(f"number {k}: give at = a time, or peak = {' or '.join(SIDES)}")
        if peak and (peak not in SIDES or "since" in entry):
            raise LandingError(f"number {k}: peak = {peak!r} is not one of {', '.join(SIDES)}")
        at, since = (_number(TIME, entry[key]) if key in entry else None for key in ("at", "since"))
        late = max((t for t in (at, since) if t is not None), default=0.0)
        if late > until:
            raise LandingError(f"number {k}: {late:g} s is after the end, until = {until:g} s")
    if "value" not in entry or ("tolerance" in entry) == ("relative" in entry):
        raise LandingError(f"number {k}: give value, and either tolerance or relative")
    theirs = _number(quantity, entry["value"])
    tolerance = (
        _number(quantity, entry["tolerance"])
        if "tolerance" in entry
        else _number(RELATIVE, entry["relative"]) * abs(theirs)
    )
    if not tolerance >= 0.0:
        raise LandingError(f"number {k}: tolerance = {tolerance:g} {quantity.unit} is below 0")
    page = str(entry.get("page", ""))
    yield Number(quantity, theirs, tolerance, at, since, peak, contact, page)


def _output(interface: Interface, name: Any) -> Quantity:
    if name not in interface.output_names:
        raise unknown("output", str(name), interface.output_names)
    return interface.outputs[interface.output_names.index(name)]


def _input(interface: Interface, name: str, value: Any) -> float:
    if name not in interface.input_names:
        raise unknown("input", name, interface.input_names)
    return float(parse_value(interface.inputs_by_name[name], value))


def _number(q: Quantity, value: Any) -> float:
    """A number in SI, from one or a text with a unit."""
    if not is_number(value):
        raise LandingError(
            f"{q.name} = {value!r} is not a number; give it in {q.unit or 'numbers'}"
        )
    if q in (TIME, RELATIVE, RTOL):
        return float(parse_value(q, value))
    number = to_si(q, value)
    if not isfinite(number):
        raise LandingError(f"{q.name} = {value!r} is not finite; give a number")
    return number


def _text(document: Mapping[str, Any], key: str) -> str:
    value = document.get(key, "")
    if not isinstance(value, str):
        raise LandingError(f"{key} = {value!r} must be a text")
    return " ".join(value.split())
