"""The table of the bounds of an identification's numbers."""

from __future__ import annotations

from collections.abc import Iterable

from ..identification.priors import Prior, quantity
from .rendering import new_table, render


def prior_table(priors: Iterable[Prior]) -> str:
    """Every prior with its bounds, unit and reason, a line each where the reason fits."""
    table = new_table("priors", ("name",), ("from", "to"), ("unit", "reason"))
    for p in priors:
        table.add_row(
            p.name,
            f"{p.lo:.4g}",
            f"{p.hi:.4g}",
            quantity(p.name).unit,
            ("each mode; " if p.by_mode else "") + p.reason,
        )
    return render(table, 170)
