"""True peaks of a landing, as far as they are known, as extremes of its history."""

from __future__ import annotations

from collections.abc import Mapping
from math import nan

from rlv_landing.history import History
from rlv_landing.outputs import Extreme
from rlv_landing.quantities import widest_interfaces

# the outputs that an FMU may give peaks of
OUTPUTS = tuple(dict.fromkeys(p.output for i in widest_interfaces() for p in i.peaks))
# value [SI] and time [s]
Found = tuple[float, float]


def known_extremes(
    found: Mapping[str, Found], history: History | None = None
) -> dict[str, Extreme]:
    """The extremes of the outputs that have a known peak, by output.

    The side that is not known is that of the samples; NaN for an output without a column.

    Args:
        found: Value and time of each peak by `OUTPUT.SIDE`.
        history: The samples; None: what is not known is NaN.
    """
    extremes: dict[str, Extreme] = {}
    for output in OUTPUTS:
        low, high = found.get(f"{output}.min"), found.get(f"{output}.max")
        if low is None and high is None:
            continue
        sampled = Extreme(nan, nan, nan, nan)
        if history is not None and output in history:
            sampled = history.extreme(output)
        extremes[output] = Extreme(*(low or sampled[:2]), *(high or sampled[2:]))
    return extremes
