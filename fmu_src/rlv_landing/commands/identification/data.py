"""Free numbers, scalars, curves and conditions by the options of `rlv-landing identify`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...choices import split_pair
from ...errors import LandingError
from ...text.files import pipes_kept
from ..options import choose_symmetric

if TYPE_CHECKING:
    from ...identification.measured.series import Series
    from ...identification.objective import Objective
    from ...identification.targets import Wanted
    from ...parameters import Parameters


def objective_of(options: dict[str, Any]) -> Objective:
    """The free numbers, scalars, curves and conditions that the options of `identify` choose.

    Raises:
        LandingError: An option names what does not exist, cannot be, or fits no other.
    """
    from ...identification.conditions import CONDITIONS
    from ...identification.free_numbers import FreeNumbers
    from ...identification.objective import Objective
    from ...identification.origins import with_origins

    changed = [split_pair(pair, "--set")[0] for pair in options["pairs"]]
    with pipes_kept():
        parameters, modes, _ = choose_symmetric(
            options["preset"], options["file"], options["mode"], options["pairs"]
        )
        parameters = with_origins(parameters, options["preset"], options["file"], changed)
    wanted, curves = _data(options, parameters, modes)
    if options["count"] and not wanted:
        raise LandingError(
            f"--count {options['count']} counts scalars, and there are none; give --targets, "
            "or leave it out"
        )
    present = [m for m in modes if m in {*(t.mode for t in wanted), *(s.mode for s in curves)}]
    names = options["free"].split(",") if options["free"] else None
    numbers = FreeNumbers(parameters, names, dict(map(_bound, options["bounds"])), present)
    conditions = options["conditions"]
    if conditions is None:
        conditions = not (options["targets"] or curves)
    sensors = options["scalars"] == "tests"
    return Objective(numbers, wanted, curves, CONDITIONS if conditions else (), sensors=sensors)


def _data(
    options: dict[str, Any], parameters: Parameters, modes: tuple[str, ...]
) -> tuple[list[Wanted], list[Series]]:
    """The scalars and curves to reach: the user's, or the paper's for the paper's vehicle."""
    from ...identification.measured.series import Series
    from ...identification.measured.target_file import read_targets
    from ...identification.targets import paper_targets, targets_of_tests
    from ...validation.curves import read_curves
    from ...validation.paper import other_vehicle

    only = modes[0] if len(modes) == 1 else None
    pairs = [split_pair(pair, "--series") for pair in options["series"]]
    curves = [Series(mode, read_curves(path)) for mode, path in pairs]
    for s in curves:
        if s.mode not in modes:
            raise LandingError(
                f"--series {s.mode} is another landing than --mode {only}; leave one"
            )
    if options["targets"]:
        return read_targets(options["targets"], only, parameters), curves
    if curves:
        return [], curves
    if others := other_vehicle(parameters):
        raise LandingError(
            f"this is another vehicle than the paper's ({others[0]}), whose scalars are no targets "
            "for it; give its own by --targets or --series"
        )
    printed = targets_of_tests() if options["scalars"] == "tests" else paper_targets()
    return [t for t in printed if t.mode in modes], curves


def _bound(text: str) -> tuple[str, tuple[float, float]]:
    from ...identification.priors import quantity
    from ...text.values import check_together, to_si

    name, value = split_pair(text, "--bound")
    lo, dots, hi = (part.strip() for part in value.partition(".."))
    if not dots:
        raise LandingError(
            f"--bound {text}: write NAME=LO..HI, for example ground.friction=0.1..0.5, "
            'or with units, main_strut.stroke_max="30 mm..60 mm"'
        )
    q = quantity(name)
    bounds = to_si(q, lo), to_si(q, hi)
    check_together(q, (lo, hi))
    return name, bounds
