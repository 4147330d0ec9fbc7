"""The modes that a study lands with, and the outputs that all of its landings have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from ..errors import LandingError
from ..parameters import Parameters
from ..quantities import MODES, MOST_LEGS, SPACE, Interface, interface_of
from .variables import check_legs

MODE, LEGS, KIND = "drop.mode", "vehicle.legs", "leg.kind"


def landed_modes(
    modes: Collection[str],
    parameters: Parameters,
    fixed: Mapping[str, float | str],
    varied: Mapping[str, Iterable[Any]],
) -> set[str]:
    """The modes that a study lands with, all symmetric, or all in space.

    Args:
        modes: Those that it names, if it does.
        parameters: The parameters that are not varied.
        fixed: What is set in every landing, by name.
        varied: Values that a quantity may have, by name.

    Raises:
        LandingError: Landings of both kinds, which have other responses.
    """
    given: set[Any] = {*modes}
    if not modes:
        given.update({fixed[MODE]} if MODE in fixed else ())
        given.update(varied.get(MODE, ()))
    known = {mode for mode in given if mode in (*MODES, SPACE)} or {parameters.drop.mode}
    if SPACE in known and len(known) > 1:
        raise LandingError(
            f"a study lands with {', '.join(sorted(known))}, and landings in space have other "
            "responses than symmetric ones; make a study of each"
        )
    return known


def interface_for(
    modes: Collection[str], parameters: Parameters, varied: Mapping[str, Iterable[Any]]
) -> Interface:
    """The outputs of landings, on as many legs as one of them may have; else as `landed_modes`.

    Raises:
        LandingError: Landings on legs of different kinds, which have other responses; what is
            varied is of a leg that no landing has.
    """
    kinds = sorted({str(kind) for kind in varied.get(KIND, ())}) or [parameters.leg.kind]
    if len(kinds) > 1:
        raise LandingError(
            f"a study lands on {' and '.join(kinds)} legs ({KIND}), which have other responses "
            "each; make a study of each"
        )
    given = [parameters.vehicle.legs, *(v for v in varied.get(LEGS, ()) if isinstance(v, float))]
    most = int(max(v for v in given if v <= MOST_LEGS))
    check_legs(varied, most)
    return interface_of(min(modes), most, kinds[0])
