"""The priors of a vehicle: the prototype's as they are, or another's about its own values.

The bounds in `PRIORS` are those of the paper's prototype. A vehicle that has other masses or
lengths than the paper's Table 1 gets bounds about the values that it starts from, by three rules
[closure]:

- materials and exponents, which do not grow with a vehicle (oil, air, friction): the prototype's
  bounds, where they hold the start;
- the state at touchdown: the start, and half the prototype's width to either side; of a larger
  start as large a part;
- the rest, which grows with a vehicle (areas, volumes, forces, stiffnesses): the start, and the
  root of the prototype's ratio of bounds as a factor to either side.

The state apart, a start of 0 has no size to follow, and so no bounds: a strut without play gets
none by a search that was not given any.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..presets import preset_names
from ..validation.paper import other_vehicle
from .priors import BORE, PRIORS, ROD_AREA, Prior

MATERIALS = frozenset(
    (
        "main_strut.air_fraction",
        "main_strut.air_exponent",
        "main_strut.bulk_modulus",
        "main_strut.bulk_modulus_slope",
        "auxiliary_strut.exponent",
        "auxiliary_strut.play_damping",
        "ground.exponent",
        "ground.friction",
        "ground.stribeck_gain",
    )
)
# the sources of values that come with the package
OF_PACKAGE = frozenset(("paper", "derived", "closure", "identified"))


def start_of(base: Parameters, name: str, mode: str | None) -> float:
    """The value [SI] of a free number in `base`: a parameter's, or the rod's area."""
    own = base.for_mode(mode) if mode is not None else base
    if name == ROD_AREA:
        return own.main_strut.area_lower - own.main_strut.area_upper
    return float(own[name])


def from_preset(base: Parameters, name: str, mode: str | None = None) -> bool:
    """Whether the value of a free number is a preset's, not one that the user gave."""
    own = base.for_mode(mode) if mode is not None else base
    source = own.source(BORE if name == ROD_AREA else name)
    return source in OF_PACKAGE or source.rpartition(", ")[2] in preset_names()


def priors_of(base: Parameters, mode: str | None = None) -> dict[str, Prior]:
    """The priors of the vehicle `base` by name, see this module's docstring.

    Args:
        base: The parameters from which the search starts.
        mode: The landing mode whose state at touchdown counts.
    """
    if not other_vehicle(base):
        return {p.name: p for p in PRIORS}
    own = base.for_mode(mode) if mode is not None else base
    followed = (following(p, start_of(own, p.name, None)) for p in PRIORS)
    return {p.name: p for p in followed if p is not None}


def following(prior: Prior, start: float) -> Prior | None:
    """The prototype's prior moved to another vehicle's start; None where the start has no size."""
    if prior.by_mode:
        larger = abs(start) / max(abs(prior.lo), abs(prior.hi))
        half = 0.5 * (prior.hi - prior.lo) * max(1.0, larger)
        return _within(prior, start - half, start + half, f"the start, {half:.3g} to either side")
    if start <= 0.0:
        return None
    if prior.name in MATERIALS and prior.lo <= start <= prior.hi:
        return prior
    factor = sqrt(prior.hi / prior.lo)
    reason = f"the start, a factor of {factor:.3g} to either side"
    return _within(prior, start / factor, start * factor, reason)


def _within(prior: Prior, lo: float, hi: float, reason: str) -> Prior:
    q = PARAMETER_QUANTITIES[BORE if prior.name == ROD_AREA else prior.name]
    if prior.name != ROD_AREA:
        lo, hi = max(lo, q.lo), min(hi, q.hi)
    return replace(prior, lo=lo, hi=hi, reason=reason)
