"""The variables of FMI 3.0: those of FMI 2.0, with the legs' as one array.

`leg[1].contact.force`, `leg[2].contact.force` ... are the elements of `leg.contact.force`, with
flat names `leg1_contact_force`, `leg2_contact_force` ... those of `leg_contact_force`. The value
reference of a variable is that of its first element in FMI 2.0; `time`, which FMI 2.0 does not
have, comes after all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import (
    STATISTIC_QUANTITIES,
    flat_name,
    whole_name,
    widest_interfaces,
)

TIME = "time"
# the quantities of all interfaces that have other names where names are flat
STRUCTURED = {
    flat_name(name): name
    for interface in widest_interfaces()
    for name in (
        *PARAMETER_QUANTITIES,
        *interface.input_names,
        *interface.output_names,
        *(q.name for q in (*STATISTIC_QUANTITIES, *interface.peak_quantities)),
    )
}


@dataclass(frozen=True)
class Variable:
    """A variable of FMI 3.0.

    Attributes:
        name: Its name.
        reference: Its value reference.
        elements: The quantities that it has; one if it is no array.
        stride: How far apart their value references are.
    """

    name: str
    reference: int
    elements: tuple[str, ...]
    stride: int = 0


def whole_meaning(meaning: str) -> str:
    """What an array means, of whose first element this is the meaning."""
    return "of each leg: " + meaning.replace("leg 1, ", "").replace("leg[1]", "leg")


def variables(names: list[str]) -> list[Variable]:
    """The variables of FMI 3.0 without `time`, in order.

    Args:
        names: Names in FMI 2.0, in the order of their value references 0, 1, 2, ...

    Raises:
        SystemExit: Value references of an array's elements are not equally far apart.
    """
    quantities = [STRUCTURED.get(name, name) for name in names]
    found: dict[str, list[int]] = {}
    for reference, (name, quantity) in enumerate(zip(names, quantities)):
        whole = whole_name(quantity)
        found.setdefault(whole if name == quantity else flat_name(whole), []).append(reference)
    made = []
    for whole, references in found.items():
        strides = {b - a for a, b in pairwise(references)} or {0}
        if len(strides) > 1:
            raise SystemExit(
                f"error: the value references of {whole} are {references}; the front needs them "
                "equally far apart"
            )
        elements = tuple(quantities[i] for i in references)
        made.append(Variable(whole, references[0], elements, strides.pop()))
    return made
