"""The counts of scalars within 5, 10 and 20 % of the paper that a validation requires."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from ..errors import LandingError
from .paper import LEVELS

Bounds = tuple[int, int, int]

# the counts that `yue2022-figures` is stated to reach: scalars within 5, 10, 20 % of the paper's
# simulation, by mode
STATED: dict[str, Bounds] = {"2-2": (18, 20, 20), "1-2-1": (21, 27, 28)}

# the counts that `yue2022-tests` is stated to reach of the paper's tests, read through the tests'
# sensor chain, by mode
STATED_OF_TESTS: dict[str, Bounds] = {"2-2": (10, 12, 14), "1-2-1": (12, 14, 19)}


def parse_bounds(text: str) -> Bounds:
    """The least counts within 5, 10 and 20 % from a text such as `42/46/48`.

    Raises:
        LandingError: The text is anything else, or the counts fall.
    """
    match = re.fullmatch(r" *([0-9]{1,6}) */ *([0-9]{1,6}) */ *([0-9]{1,6}) *", text)
    if match is None:
        raise LandingError(
            f"--require {text!r} is not three counts; "
            "write the least within 5, 10 and 20 %: 36/41/45, or none"
        )
    a, b, c = (int(n) for n in match.groups())
    if not a <= b <= c:
        raise LandingError(
            f"--require {text!r} falls: what is within 5 % is within 10 % too; "
            "write them rising, for example 36/41/45"
        )
    return a, b, c


def stated_bounds(modes: Iterable[str], stated: Mapping[str, Bounds] = STATED) -> Bounds:
    """The counts that a preset is stated to reach in `modes` together.

    Args:
        modes: The landing modes.
        stated: The counts by mode; default: those of `yue2022-figures` against the simulation.
    """
    modes = tuple(modes)
    a, b, c = (sum(stated[mode][i] for mode in modes) for i in range(len(LEVELS)))
    return a, b, c


def missed_bounds(
    found: Mapping[str, int], bounds: Bounds, of: str = "the paper's simulation"
) -> list[str]:
    """A line for every count below its bound.

    Args:
        found: The counts, as `counts` gives them.
        bounds: The least counts.
        of: What the scalars were compared with.

    Raises:
        LandingError: A bound is above the number of scalars.
    """
    if bounds[-1] > found["of"]:
        raise LandingError(
            f"--require asks for {bounds[-1]} scalars within 20 %, there are {found['of']}; "
            "ask for at most that"
        )
    return [
        f"within {level} % of {of}: {found[f'within_{level}']} of {found['of']}, "
        f"at least {bound} are required"
        for level, bound in zip(LEVELS, bounds)
        if found[f"within_{level}"] < bound
    ]
