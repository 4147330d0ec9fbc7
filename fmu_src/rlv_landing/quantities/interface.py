"""The inputs and outputs that a landing has, by its mode."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from .inputs import INPUT_QUANTITIES
from .legs import LEGS, MODES, MOST_LEGS, RADIAL, SPACE, TRIPOD
from .outputs import OUTPUT_QUANTITIES
from .peaks import Peak, peaks_of
from .quantity import Quantity
from .space import SPACE_INPUTS, space_outputs

RATE = "_rate"


@dataclass(frozen=True, eq=False)
class Interface:
    """The inputs and outputs of a landing, in the order in which the core has them.

    There is one for each number and kind of legs in space, and one of symmetric landings.

    Attributes:
        in_space: Whether it is that of landings in space.
        inputs: The inputs.
        outputs: The outputs.
        input_names: The inputs' names.
        output_names: The outputs' names.
        legs: The legs' numbers.
        leg_kind: Their kind, `radial` or `tripod`.
        peaks: The extremes that an FMU gives.
        positions: Places of the ground's positions among the inputs.
        position_rates: Places of their rates, in the same order.
    """

    in_space: bool
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    legs: tuple[int, ...]
    leg_kind: str
    peaks: tuple[Peak, ...]
    positions: tuple[int, ...]
    position_rates: tuple[int, ...]

    @property
    def inputs_by_name(self) -> dict[str, Quantity]:
        """The inputs by name."""
        return {q.name: q for q in self.inputs}

    @property
    def peak_quantities(self) -> tuple[Quantity, ...]:
        """Value and time of each of `peaks`, in their order."""
        return tuple(q for p in self.peaks for q in (p.value, p.time))


def interface_of(mode: str, legs: int = len(LEGS), kind: str = RADIAL) -> Interface:
    """The inputs and outputs of a landing of the `mode` on so many `legs` of a kind."""
    return _interface(legs, kind, in_space=mode == SPACE)


def widest_interfaces() -> tuple[Interface, ...]:
    """Interfaces that together have every quantity that a landing may have."""
    in_space = (interface_of(SPACE, MOST_LEGS, kind) for kind in (RADIAL, TRIPOD))
    return (interface_of(min(MODES)), *in_space)


@cache
def _interface(legs: int, kind: str, *, in_space: bool) -> Interface:
    inputs, outputs = INPUT_QUANTITIES, OUTPUT_QUANTITIES
    if in_space:
        inputs, outputs = SPACE_INPUTS, space_outputs(legs, kind)
    names = tuple(q.name for q in inputs)
    rates = [name for name in names if name.endswith(RATE)]
    numbers = tuple(range(1, legs + 1))
    return Interface(
        in_space=in_space,
        inputs=inputs,
        outputs=outputs,
        input_names=names,
        output_names=tuple(q.name for q in outputs),
        legs=numbers,
        leg_kind=kind,
        peaks=peaks_of(outputs, numbers),
        positions=tuple(names.index(name.removesuffix(RATE)) for name in rates),
        position_rates=tuple(names.index(name) for name in rates),
    )
