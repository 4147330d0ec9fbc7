"""The responses of a study: the numbers and texts that are taken from each landing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

from ...errors import LandingError, unknown
from ...history import History
from ...outputs import Extreme
from ...quantities import (
    LEG_QUANTITIES,
    MODES,
    SPACE,
    TRIPOD,
    Interface,
    Quantity,
    groups_of,
    interface_of,
    leg_quantities_in_space,
    widest_interfaces,
)
from ...validation.first_contact import first_contact
from ...validation.measures import leg_work
from ..outcome import TOPPLED, Outcome, judged

Reduction = Callable[[Extreme], float]
# what is taken of an output's extremes
EXTREMES: dict[str, tuple[str, Reduction]] = {
    "min": ("smallest", lambda e: e.minimum),
    "max": ("largest", lambda e: e.maximum),
    "abs_max": ("largest magnitude of", lambda e: max(e.maximum, -e.minimum)),
    "min_time": ("time of the smallest", lambda e: e.minimum_time),
    "max_time": ("time of the largest", lambda e: e.maximum_time),
}
REDUCTIONS = {name: words for name, (words, _) in EXTREMES.items()} | {"final": "last"}
OVER_LEGS: dict[str, Callable[[Iterable[float]], float]] = {"min": min, "max": max, "abs_max": max}
WORK = {"absorbed": "J", "dissipated": "J", "efficiency": ""}
MARGINS = ("stability_min", "stability_end", "stroke_left", "slid", "joint_clearance")
OUTCOME = (
    Quantity(
        "",
        "toppled, body strike, bottomed out, slid, moving, standing or settled",
        name="outcome",
        kind="string",
    ),
    Quantity("s", "time of the outcome", name="outcome.time"),
    Quantity("", "the leg that bottomed out first", name="outcome.leg", kind="integer"),
    Quantity(
        "", "the limit of [limits] that was passed first", name="outcome.first_limit", kind="string"
    ),
    Quantity("s", "time at which it was passed", name="outcome.first_limit_time"),
    *(
        Quantity(
            "m", f"{name.replace('_', ' ')}, see Outcome", name=f"margin.{name}", display_unit="mm"
        )
        for name in MARGINS
    ),
)
OUTCOME_IN_SPACE = (
    Quantity(
        "", "legs of the edge over which the vehicle toppled", name="outcome.edge", kind="string"
    ),
    Quantity(
        "rad",
        "direction in which it toppled, from inertial x towards z",
        name="outcome.direction",
        display_unit="deg",
    ),
)
RHS_CALLS = Quantity(
    "", "calls of the right-hand side that the landing took", name="rhs_calls", kind="integer"
)
# outcome and margins, and the peaks over all legs: what each kind of study tells first
JUDGED = ("outcome", "outcome.*", "margin.*")
LEGS_PEAKS = (
    "legs.main_strut.force.min",
    "legs.main_strut.stroke.max",
    "legs.auxiliary_strut.force.abs_max",
    "legs.contact.force_y.max",
)
DEFAULT = (
    *JUDGED,
    *LEGS_PEAKS,
    "legs.main_strut.absorbed",
    "legs.main_strut.dissipated",
    "leg[*].contact.time",
    "leg[*].main_strut.force.min",
    "leg[*].main_strut.force.min_time",
    "leg[*].main_strut.stroke.max",
    "leg[*].main_strut.stroke.max_time",
    "leg[*].main_strut.stroke.final",
    "leg[*].main_strut.pressure_lower.max",
    "leg[*].auxiliary_strut.force.min",
    "leg[*].auxiliary_strut.force.max",
    "leg[*].contact.force_y.max",
    "leg[*].main_strut.absorbed",
    "leg[*].main_strut.dissipated",
    "leg[*].main_strut.efficiency",
    "leg[*].main_strut.first_stroke",
    "body.top_axial_acceleration.max",
    "body.pitch.abs_max",
    "body.pitch.final",
    "body.x.final",
    "energy.dissipated.final",
    "energy.dissipated_orifice.final",
    "energy.dissipated_seal.final",
    "energy.dissipated_friction.final",
    "energy.dissipated_contact.final",
    "energy.balance.abs_max",
    "rhs_calls",
)


DEFAULT_IN_SPACE = (
    *DEFAULT,
    "body.roll.abs_max",
    "body.roll.final",
    "body.heading.final",
    "body.z.final",
    "leg[*].auxiliary_strut.transverse_force.abs_max",
)
# of symmetric landings
IN_A_PLANE = interface_of(min(MODES))


@cache
def every_response() -> Mapping[str, Quantity]:
    """The responses of landings of any mode, on any legs, by name."""
    found: dict[str, Quantity] = {}
    for interface in reversed(widest_interfaces()):
        found |= known_responses(interface)
    return found


@cache
def known_responses(interface: Interface = IN_A_PLANE) -> Mapping[str, Quantity]:
    """Every response by name, of landings with these outputs.

    - `OUTPUT.min`, `.max`, `.abs_max`, `.final`, `.min_time`, `.max_time` of every output; `legs.…`
      is the extreme over all legs. Extremes are those of the landing, between its samples too.
    - `leg[N].main_strut.absorbed`, `.dissipated`, `.efficiency` are of a damper's first compression
      and rebound, found in its stroke's curve; `legs.…` is their sum over the legs.
    - `leg[N].main_strut.first_stroke` says how far the landing shows them: `complete`,
      `in compression` or `in rebound` at its end, or `not compressed`.
    - `leg[N].contact.time` is the first time at which the ground pushes on a footpad.
    - `outcome`, `outcome.…` and `margin.…` are those of `Outcome`.
    """
    of_space = OUTCOME_IN_SPACE if interface.in_space else ()
    found = {q.name: q for q in (*OUTCOME, *of_space)}
    for q in interface.outputs:
        for name, words in REDUCTIONS.items():
            full = f"{q.name}.{name}"
            found[full] = replace(of_kind(q), meaning=f"{words} {q.meaning}", name=full)
            if name.endswith("time"):
                found[full] = replace(found[full], unit="s", display_unit="")
    in_space = leg_quantities_in_space(interface.leg_kind)
    for q in in_space if interface.in_space else LEG_QUANTITIES:
        for name in OVER_LEGS:
            full = f"legs.{q.name}.{name}"
            meaning = f"{REDUCTIONS[name]} of all legs: {q.meaning}"
            found[full] = replace(of_kind(q), meaning=meaning, name=full)
    for what, unit in WORK.items():
        for leg in interface.legs:
            full = f"leg[{leg}].main_strut.{what}"
            found[full] = Quantity(
                unit, f"leg {leg}'s damper, first compression and rebound: {what}", name=full
            )
        if unit:
            found[f"legs.main_strut.{what}"] = Quantity(
                unit, f"{what} by all dampers together", name=f"legs.main_strut.{what}"
            )
    for leg in interface.legs:
        full = f"leg[{leg}].main_strut.first_stroke"
        found[full] = Quantity(
            "",
            f"leg {leg}'s damper: its first compression and rebound, how far they are known",
            name=full,
            kind="string",
        )
        full = f"leg[{leg}].contact.time"
        found[full] = Quantity(
            "s", f"leg {leg}: first time at which the ground pushes on the footpad", name=full
        )
    found[RHS_CALLS.name] = RHS_CALLS
    return found


def of_kind(q: Quantity) -> Quantity:
    """A number of the unit of an output, without its bounds."""
    return Quantity(q.unit, "", display_unit=q.display_unit)


def suited(names: Sequence[str], interface: Interface) -> tuple[str, ...]:
    """The names of a default set that landings with this interface have.

    Where legs have a second auxiliary strut, it is named after the first one.
    """
    if interface.leg_kind != TRIPOD:
        return tuple(names)
    found = []
    for name in names:
        if "transverse_force" not in name:
            found.append(name)
            if "auxiliary_strut." in name:
                found.append(name.replace("auxiliary_strut.", "auxiliary_strut_2."))
    return tuple(found)


def expand(names: Sequence[str] | None, interface: Interface = IN_A_PLANE) -> tuple[str, ...]:
    """Names of responses in the order given, with patterns expanded.

    `leg[*]` stands for each leg, a trailing `.*` for all names below. None is the default set.

    Args:
        names: Names and patterns.
        interface: The outputs of the landings.

    Raises:
        LandingError: A response does not exist (the message names the nearest), or is named twice.
    """
    known = known_responses(interface)
    default = suited(DEFAULT_IN_SPACE if interface.in_space else DEFAULT, interface)
    found: list[str] = []
    for name in default if names is None else names:
        if name.endswith(".*"):
            matching = [k for k in known if k.startswith(name[:-1])]
        else:
            matching = (
                [name.replace("[*]", f"[{leg}]") for leg in interface.legs]
                if "[*]" in name
                else [name]
            )
        for one in matching or [name]:
            if one not in known:
                raise unknown("response", one, known)
            if one in found:
                raise LandingError(f"response {one} is named twice; leave one")
            found.append(one)
    return tuple(found)


class Measure:
    """Takes the responses `names` from histories; `limits` and `slide` are those of `outcome`."""

    def __init__(
        self,
        names: Sequence[str],
        limits: Mapping[str, float] | None = None,
        slide: float | None = None,
    ) -> None:
        self.names = tuple(names)
        self._slide = {} if slide is None else {"slide": slide}
        self._limits = dict(limits or {})
        self._reductions = [_reduction_of(name) for name in names]
        self._with_outcome = any(name.partition(".")[0] in ("outcome", "margin") for name in names)
        self._with_work = any(
            name.rpartition(".")[2] in (*WORK, "first_stroke") and "main_strut" in name
            for name in names
        )

    def __call__(self, history: History, rhs_calls: int) -> list[Any]:
        """The responses in the order of `names`.

        The motion after toppling does not count, the stability margins apart.

        Args:
            history: The landing's columns over time.
            rhs_calls: Calls of the right-hand side that the landing took.

        Returns:
            The values; None where a landing has none: an efficiency without compression, a
            work that is not known when the landing ends, no limit passed.
        """
        others: dict[str, Any] = {"rhs_calls": rhs_calls}
        toppled = history["status.phase"][-1] == TOPPLED
        if self._with_outcome or toppled:
            found, history = judged(history, self._limits or None, **self._slide)
            others.update(_outcome_values(found))
        if self._with_work:
            others.update(_work_values(history))
        values: list[Any] = []
        for name, taken in zip(self.names, self._reductions):
            if taken is None:
                values.append(others[name] if name in others else _contact_time(history, name))
                continue
            output, reduction = taken
            if output.startswith("legs."):
                own = [output.replace("legs.", f"leg[{n}].", 1) for n in history.legs]
                numbers = (_reduced(history, one, reduction) for one in own)
                values.append(OVER_LEGS[reduction](numbers))
            else:
                values.append(_reduced(history, output, reduction) if output in history else None)
        return values


def _reduction_of(name: str) -> tuple[str, str] | None:
    """The output of a response and its reduction; None for other responses."""
    output, _, reduction = name.rpartition(".")
    if reduction not in REDUCTIONS or output.partition(".")[0] in ("outcome", "margin"):
        return None
    return output, reduction


def _reduced(history: History, output: str, reduction: str) -> float:
    if reduction == "final":
        return float(history[output][-1])
    return EXTREMES[reduction][1](history.extreme(output))


def _outcome_values(found: Outcome) -> dict[str, Any]:
    limit = found.first_limit
    leg = "" if limit is None or limit.leg is None else f"leg[{limit.leg}]."
    return {
        "outcome": found.name,
        "outcome.time": found.time,
        "outcome.leg": found.leg,
        "outcome.first_limit": None if limit is None else leg + limit.name,
        "outcome.first_limit_time": None if limit is None else limit.time,
        "outcome.edge": found.edge,
        "outcome.direction": found.direction,
        **{f"margin.{name}": value for name, value in found.margins.items()},
    }


def _contact_time(history: History, name: str) -> float | None:
    leg = int(name.removeprefix("leg[").partition("]")[0])
    contact = first_contact(history, leg) if leg in history.legs else None
    return None if contact is None else contact.time


def _work_values(history: History) -> dict[str, Any]:
    """The dampers' work; it is calculated once for legs that are mirror images.

    A sum over the legs is None where one of its terms is not known; a damper that was not
    compressed takes up nothing.
    """
    assert history.parameters is not None
    values: dict[str, Any] = {}
    mode = history.parameters.drop.mode
    groups: list[tuple[int, ...]] = [(leg,) for leg in history.legs]
    if mode != SPACE:
        groups = [tuple(leg for leg, _ in group.legs) for group in groups_of(mode)]
    found = leg_work(history, [group[0] for group in groups])
    for group in groups:
        work = found.get(group[0])
        for leg in group:
            name = f"leg[{leg}].main_strut"
            values[f"{name}.first_stroke"] = "not compressed" if work is None else work.state
            for what in WORK:
                values[f"{name}.{what}"] = None if work is None else getattr(work, what)
    for what in (what for what, unit in WORK.items() if unit):
        terms = [
            0.0
            if values[f"leg[{leg}].main_strut.first_stroke"] == "not compressed"
            else values[f"leg[{leg}].main_strut.{what}"]
            for leg in history.legs
        ]
        values[f"legs.main_strut.{what}"] = None if None in terms else sum(terms)
    return values
