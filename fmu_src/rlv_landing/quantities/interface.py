"""The inputs and outputs that a landing has, by its mode."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from .inputs import INPUT_QUANTITIES
from .legs import LEGS, SPACE
from .outputs import OUTPUT_QUANTITIES
from .quantity import Quantity
from .space import SPACE_INPUTS, space_outputs

RATE = "_rate"


@dataclass(frozen=True)
class Interface:
    """The inputs and outputs of a landing, in the order in which the core has them.

    Attributes:
        inputs: The inputs.
        outputs: The outputs.
        input_names: The inputs' names.
        output_names: The outputs' names.
        legs: The legs' numbers.
        positions: Places of the ground's positions among the inputs.
        position_rates: Places of their rates, in the same order.
    """

    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    legs: tuple[int, ...]
    positions: tuple[int, ...]
    position_rates: tuple[int, ...]


@cache
def interface_of(mode: str, legs: int = len(LEGS)) -> Interface:
    """The inputs and outputs of a landing of the `mode` on so many `legs`."""
    inputs, outputs = INPUT_QUANTITIES, OUTPUT_QUANTITIES
    if mode == SPACE:
        inputs, outputs = SPACE_INPUTS, space_outputs(legs)
    names = tuple(q.name for q in inputs)
    rates = [name for name in names if name.endswith(RATE)]
    return Interface(
        inputs=inputs,
        outputs=outputs,
        input_names=names,
        output_names=tuple(q.name for q in outputs),
        legs=tuple(range(1, legs + 1)),
        positions=tuple(names.index(name.removesuffix(RATE)) for name in rates),
        position_rates=tuple(names.index(name) for name in rates),
    )
