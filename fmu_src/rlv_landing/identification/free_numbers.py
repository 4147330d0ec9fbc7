"""The numbers that an identification varies, as points of the unit cube."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..quantities import MODES
from .priors import ANNULUS, BORE, PRIORS, ROD_AREA, Prior, with_bounds


class FreeNumbers:
    """The numbers that are free, on the unit cube: from a point `z` to parameters and back.

    Args:
        base: Parameters whose other values stay.
        names: The free ones; default: all that have a prior.
        bounds: Other bounds by name, (lo, hi), SI.
        modes: The landing modes whose drops are free.

    Raises:
        LandingError: A name has no prior and no bounds, or bounds are empty or outside the
            parameter's own.
    """

    def __init__(
        self,
        base: Parameters,
        names: Sequence[str] | None = None,
        bounds: Mapping[str, tuple[float, float]] | None = None,
        modes: Sequence[str] = tuple(MODES),
    ) -> None:
        self.base = base
        priors = {p.name: p for p in PRIORS}
        for name, (lo, hi) in (bounds or {}).items():
            priors[name] = with_bounds(name, lo, hi, priors.get(name))
        chosen = list(names) if names else list(priors)
        for name in chosen:
            if name in priors:
                continue
            if name in PARAMETER_QUANTITIES:
                raise LandingError(
                    f"{name} has no bounds to be identified between; "
                    f"give them: --bound {name}=LO..HI"
                )
            raise unknown("parameter", name, [*priors, *PARAMETER_QUANTITIES])
        self.columns: list[tuple[Prior, str | None]] = []
        for p in (priors[name] for name in chosen):
            self.columns += [(p, mode) for mode in modes] if p.by_mode else [(p, None)]

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def labels(self) -> list[str]:
        """A name for each number; `2-2: drop.tilt` for those of one mode."""
        return [p.name if mode is None else f"{mode}: {p.name}" for p, mode in self.columns]

    def numbers(self, z: Sequence[float]) -> list[float]:
        """The free numbers, SI, at `z`; outside the unit cube as at `folded(z)`."""
        return [p.value(x) for (p, _), x in zip(self.columns, folded(z).tolist())]

    def start(self) -> list[float]:
        """The base's own values on the cube, clipped to the bounds."""
        place = []
        for p, mode in self.columns:
            own = self.base.for_mode(mode) if mode is not None else self.base
            value = (
                own.main_strut.area_lower - own.main_strut.area_upper
                if p.name == ROD_AREA
                else float(own[p.name])
            )
            place.append(p.place(value))
        return place

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


def folded(z: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """`z` inside the unit cube: what lies beyond a face is mirrored at it.

    A search may so step over the cube's faces.
    """
    turned = np.abs(np.asarray(z, dtype=float)) % 2.0
    inside: NDArray[np.float64] = np.where(turned > 1.0, 2.0 - turned, turned)
    return inside
