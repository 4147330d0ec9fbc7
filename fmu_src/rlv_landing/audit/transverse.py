"""The energy that the transverse load at the auxiliary struts' joints creates in a landing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..errors import LandingError
from ..history import History
from ..landing import Landing
from ..parameters import Parameters

NAME = "vehicle.transverse_load_at"
JOINT = "joint"
# how long a nominal landing is followed after its first contact [s]
AFTER_CONTACT = 1.0


def joint_warning(
    vehicles: Iterable[Parameters], inputs: Mapping[str, Any] | None = None
) -> str | None:
    """A warning with the energy that the load at the joint creates in a landing of a vehicle.

    It is the first of `vehicles` that has it; None where all have the load at the footpad. The
    landing is made here, from the first contact on.

    Args:
        vehicles: Parameters, each for their landing mode.
        inputs: Constant inputs by name [SI].
    """
    parameters = next((own for own in vehicles if own[NAME] == JOINT), None)
    if parameters is None:
        return None
    try:
        landing = Landing(parameters.with_values({"drop.contact_time": 0.0}), inputs=inputs)
        return warning_of(landing.run(AFTER_CONTACT))
    except LandingError as e:
        return _line("energy, an unknown amount, for a nominal landing of it fails: " + str(e))


def warning_of(history: History) -> str | None:
    """The warning for a landing that was made; None where the load acts at the footpad."""
    own = history.parameters
    if own is None or own[NAME] != JOINT:
        return None
    created = float(history["energy.work_transverse"][-1])
    dissipated = float(history["energy.dissipated"][-1])
    after = float(history.time[-1]) - own.drop.contact_time
    until = f"{after:.3g} s after" if after >= 0.0 else f"{-after:.3g} s before"
    return _line(
        f"{created:.3g} J beside {dissipated:.3g} J dissipated in a {own.drop.mode} landing "
        f"until {until} its first contact"
    )


def study_warning(
    parameters: Parameters, columns: Mapping[str, Any], inputs: Mapping[str, Any]
) -> str | None:
    """As `joint_warning`, for landings of a vehicle with other values in `columns` by name."""
    varied = columns.get(NAME)
    values = [parameters[NAME]] if varied is None else sorted(set(varied.tolist()))
    return joint_warning([parameters.with_values({NAME: value}) for value in values], inputs)


def _line(what: str) -> str:
    return (
        f"{NAME} = {JOINT}, the paper's assumption C, creates {what}; "
        f"stability boundaries come out too wide by it; set {NAME} = footpad"
    )
