"""The numbers that an identification varies, as points of the unit cube."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..quantities import MODES
from .priors import ANNULUS, BORE, PRIORS, ROD_AREA, Prior, quantity, with_bounds
from .vehicle_priors import from_preset, priors_of, start_of

_BY_MODE = frozenset(p.name for p in PRIORS if p.by_mode)
# the part of a number by which digits that were cut off may put it outside its bounds
ROUNDED = 1e-6


class FreeNumbers:
    """The numbers that are free, on the unit cube: from a point `z` to parameters and back.

    Args:
        base: Parameters whose other values stay.
        names: The free ones; default: all that have a prior.
        bounds: Other bounds by name, (lo, hi), SI.
        modes: The landing modes whose drops are free.

    Attributes:
        outside: Labels of the numbers whose start is outside their bounds, and for which the
            search begins at the nearest bound: a preset's values, and those that the user bounded
            otherwise.

    Raises:
        LandingError: A name has no prior and no bounds, bounds are empty or outside the
            parameter's own, or a value that the user gave is outside its prior.
    """

    def __init__(
        self,
        base: Parameters,
        names: Sequence[str] | None = None,
        bounds: Mapping[str, tuple[float, float]] | None = None,
        modes: Sequence[str] = tuple(MODES),
    ) -> None:
        self.base = base
        given = {
            name: with_bounds(name, lo, hi, by_mode=name in _BY_MODE)
            for name, (lo, hi) in (bounds or {}).items()
        }
        own = {mode: {**priors_of(base, mode), **given} for mode in modes}
        shared = own[modes[0]]
        self.columns: list[tuple[Prior, str | None]] = []
        for name in names or shared:
            if name not in shared:
                raise _unbounded(name, list(shared))
            if shared[name].by_mode:
                self.columns += [(own[mode][name], mode) for mode in modes]
            else:
                self.columns.append((shared[name], None))
        self.outside = [
            label
            for label, (prior, _), value in zip(self.labels, self.columns, self.starts())
            if not _within_bounds(prior, value)
        ]
        for label, (prior, mode) in zip(self.labels, self.columns):
            if label in self.outside and prior.name not in given:
                self._check_preset(prior, mode)

    def _check_preset(self, prior: Prior, mode: str | None) -> None:
        """Refuse a value that the user gave and that is outside its prior."""
        if from_preset(self.base, prior.name, mode):
            return
        unit, value = quantity(prior.name).unit, start_of(self.base, prior.name, mode)
        where = f" in {mode}" if mode is not None else ""
        lo, hi = min(prior.lo, value), max(prior.hi, value)
        raise LandingError(
            f"{prior.name} = {value:g} {unit}".rstrip()
            + f"{where} is outside its prior, {prior.lo:g} to {prior.hi:g} {unit}".rstrip()
            + "; start from another value, or "
            f"widen it: --bound {prior.name}={lo:g}..{hi:g}"
        )

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def labels(self) -> list[str]:
        """A name for each number; `2-2: drop.tilt` for those of one mode."""
        return [p.name if mode is None else f"{mode}: {p.name}" for p, mode in self.columns]

    def numbers(self, z: Sequence[float]) -> list[float]:
        """The free numbers, SI, at `z`; outside the unit cube as at `folded(z)`."""
        return [p.value(x) for (p, _), x in zip(self.columns, folded(z).tolist())]

    def starts(self) -> list[float]:
        """The base's own values, SI."""
        return [start_of(self.base, p.name, mode) for p, mode in self.columns]

    def start(self) -> list[float]:
        """The base's own values on the cube; those `outside` are at the nearest bound."""
        return [p.place(value) for (p, _), value in zip(self.columns, self.starts())]

    def parameters(self, z: Sequence[float]) -> Parameters:
        """The base with the free numbers at `z`; `Parameters.for_mode` applies those of one mode.

        Raises:
            LandingError: The numbers do not fit together.
        """
        shared: dict[str, Any] = {}
        by_mode: dict[str, dict[str, Any]] = {mode: {} for mode in MODES}
        for (p, mode), value in zip(self.columns, self.numbers(z)):
            (shared if mode is None else by_mode[mode])[p.name] = value
        if ROD_AREA in shared:
            annulus = shared.get(ANNULUS, self.base.main_strut.area_upper)
            shared[BORE] = annulus + shared.pop(ROD_AREA)
        return self.base.with_values(shared, "identified").with_mode_values(by_mode, "identified")


def _within_bounds(prior: Prior, value: float) -> bool:
    """Whether a value is within the bounds, but for its last digits."""
    rounding = ROUNDED * max(abs(prior.lo), abs(prior.hi)) if value else 0.0
    if prior.logarithmic:
        rounding = ROUNDED * abs(value)
    return prior.lo - rounding <= value <= prior.hi + rounding


def _unbounded(name: str, known: list[str]) -> LandingError:
    """The error for a name that has no bounds, or is no parameter."""
    if name in PARAMETER_QUANTITIES or name == ROD_AREA:
        return LandingError(
            f"{name} has no bounds to be identified between; give them: --bound {name}=LO..HI"
        )
    return unknown("parameter", name, [*known, *PARAMETER_QUANTITIES])


def folded(z: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """`z` inside the unit cube: what lies beyond a face is mirrored at it.

    A search may so step over the cube's faces.
    """
    turned = np.abs(np.asarray(z, dtype=float)) % 2.0
    inside: NDArray[np.float64] = np.where(turned > 1.0, 2.0 - turned, turned)
    return inside
