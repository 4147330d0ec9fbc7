"""A log's record of the landing's true peaks, which its messages lack between their times.

It is a metadata record at the log's end. For each of the landing's `Interface.peaks` it has, by the
output's name with `.min` or `.max`, a JSON object of `value` and `unit` (SI, the FMU's axes) and
`time` [s]. `until` is the time [s] until which they hold.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite

from rlv_landing import Landing
from rlv_landing.errors import LandingError
from rlv_landing.quantities import widest_interfaces

from ..fmu.peaks import Found

RECORD = "rlv_landing_peaks"
UNTIL = "until"
# name of a peak's variable -> `OUTPUT.SIDE` and unit, of any landing
KNOWN = {
    p.value.name: (f"{p.output}.{p.side}", p.value.unit)
    for interface in widest_interfaces()
    for p in interface.peaks
}


def peak_texts(found: Mapping[str, Found], until: float) -> dict[str, str]:
    """The record's texts by name.

    Args:
        found: value and time of each peak by the FMU's variable name.
        until: the time until which they hold [s].
    """
    texts = {UNTIL: repr(until)}
    for variable, (value, time) in found.items():
        name, unit = KNOWN[variable]
        texts[name] = json.dumps({"value": value, "unit": unit, "time": time})
    return texts


def landing_peaks(landing: Landing) -> dict[str, Found]:
    """Value and time of each peak of a landing until now, by the FMU's variable names."""
    extremes = landing.extremes()
    return {
        p.value.name: extremes[p.output][:2] if p.side == "min" else extremes[p.output][2:]
        for p in landing.interface.peaks
    }


def read_peaks(texts: Mapping[str, str], where: str) -> tuple[dict[str, Found], float]:
    """Value and time of each peak by `OUTPUT.SIDE`, and the time until which they hold.

    Peaks of other versions that this one does not know are left out.

    Args:
        texts: the record.
        where: the log's name, for errors.

    Raises:
        LandingError: a text is not what the record's layout says.
    """
    found = {}
    name = UNTIL
    try:
        until = _finite(json.loads(texts[UNTIL]))
        for name, _ in KNOWN.values():
            if name in texts:
                record = json.loads(texts[name])
                found[name] = _finite(record["value"]), _finite(record["time"])
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        raise LandingError(
            f"{where}: its record of peaks has {name} = {texts.get(name)!r}, "
            "which is not its layout; it was changed"
        ) from None
    return found, until


def _finite(number: float) -> float:
    if not isfinite(number):
        raise ValueError
    return float(number)
