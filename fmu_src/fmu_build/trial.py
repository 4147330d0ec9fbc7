"""The check of a built FMU: FMPy validates it and lands it, and `Landing` must land equally."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import fmpy
from fmpy.validation import validate_fmu

from rlv_landing import Landing
from rlv_landing.errors import reason_of
from rlv_landing.quantities import flat_name, whole_name

from .terminals import faults
from .wanted import Wanted

# the trial's end after the first contact [s], and its communication steps
AFTER_CONTACT, STEPS = 0.11, 200
# by which the FMU's outputs may differ from those of `Landing`, of the value or nominal value
TOLERANCE = 1e-6
FORCE, BALANCE = "leg[1].main_strut.force", "energy.balance"


class Expected(NamedTuple):
    """The outputs of `Landing` by name at the trial's `end` [s]."""

    end: float
    values: dict[str, float]


def expected(wanted: Wanted) -> Expected:
    """What the trial landing of the vehicle ends with.

    Raises:
        LandingError: The vehicle cannot land.
    """
    landing = Landing(wanted.parameters)
    end = wanted.parameters.drop.contact_time + AFTER_CONTACT
    landing.advance_to(end)
    return Expected(end, landing.outputs())


def check(fmu: Path, wanted: Wanted, ends: Expected) -> str:
    """Validate the FMU's description and simulate one landing; return a line with the results.

    Args:
        fmu: The FMU, beside which it is unpacked.
        wanted: The FMU that is wanted.
        ends: What its landing must end with.

    Raises:
        SystemExit: The description is not valid, or the landing is not that of the vehicle.
    """
    problems = validate_fmu(str(fmu)) + (faults(fmu) if wanted.fmi == "3" else [])
    if problems:
        raise SystemExit("error: the FMU is not valid: " + "; ".join(problems))
    names = {q.name: _own_name(q.name, wanted) for q in wanted.interface.outputs}
    try:
        result: Any = fmpy.simulate_fmu(
            fmpy.extract(str(fmu), str(fmu.with_suffix(""))),
            stop_time=ends.end,
            output_interval=ends.end / STEPS,
            output=list(dict.fromkeys(names.values())),
        )
    except Exception as e:
        if isinstance(e.__context__, KeyboardInterrupt):  # it has ended the slave
            raise e.__context__ from None
        raise SystemExit(f"error: the FMU does not land: {reason_of(e)}") from None
    for q in wanted.interface.outputs:
        ours, its = ends.values[q.name], float(_column(result, q.name, names)[-1])
        if not abs(its - ours) <= TOLERANCE * max(abs(ours), q.nominal):
            raise SystemExit(
                f"error: the FMU's trial landing is not that of the vehicle: {q.name} = {its:g} "
                f"{q.unit} at {ends.end:g} s, not {ours:g} {q.unit}"
            )
    return (
        f"valid; trial landing: main strut 1 down to {_column(result, FORCE, names).min():.0f} N, "
        f"energy balance within {abs(result[names[BALANCE]]).max():.1e} J"
    )


def _own_name(name: str, wanted: Wanted) -> str:
    """The name of the FMU's variable that has an output."""
    own = whole_name(name) if wanted.fmi == "3" else name
    return flat_name(own) if wanted.flat_names else own


def _column(result: Any, name: str, names: dict[str, str]) -> Any:
    """The values of an output: a column of the array that the legs have in FMI 3.0."""
    values = result[names[name]]
    return values if values.ndim == 1 else values[:, int(name[name.index("[") + 1]) - 1]
