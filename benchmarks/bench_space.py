"""Time of a landing in space beside the same landing in C, and beside the 1-2-1 landing.

`python benchmarks/bench_space.py`. Core and C take the same steps to the same digits, which is
checked first, so their errors are equal; the times are the least of many, 1 s of landing each.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import radians
from typing import Any

from c_landing import CLanding, core_solver, disagreement
from rich.console import Console
from rich.table import Table
from rows import append_rows, start

from rlv_landing import Parameters, load_preset

UNTIL, RTOL, REPEATS = 1.0, 1e-5, 30
SPACE: dict[str, Any] = {
    "drop.mode": "space",
    "drop.heading": radians(20.0),
    "drop.roll": radians(2.0),
    "drop.lateral_velocity": 0.2,
    "ground.slope": radians(3.0),
    "ground.slope_direction": radians(50.0),
}
PROTOTYPE = load_preset("yue2022-figures")
CASES = {
    "1-2-1": PROTOTYPE.for_mode("1-2-1"),
    "space, 4 legs": PROTOTYPE.with_values(SPACE),
    "space, 8 legs": PROTOTYPE.with_values({**SPACE, "vehicle.legs": 8.0}),
}


def timed(land: Callable[[], Any]) -> float:
    """Processor time of a call [s]."""
    began = time.process_time()
    land()
    return time.process_time() - began


def least(parameters: Parameters) -> tuple[float, float]:
    """The least processor time of the landing in the core and in C [s], taken in turns."""
    core, c = [], []
    for _ in range(REPEATS):
        solver, other = core_solver(parameters, RTOL), CLanding(parameters, RTOL)
        core.append(timed(lambda solver=solver: solver.advance(UNTIL)))
        c.append(timed(lambda other=other: other.advance(UNTIL)))
    return min(core), min(c)


def main() -> None:
    """Check, measure, print, and append rows to `results.jsonl`."""
    start()
    table = Table(title=f"{UNTIL:g} s landings in the core and in C", title_justify="left")
    for heading in ("landing", "core [ms]", "C [ms]", "core to C", "core to the core's 1-2-1"):
        table.add_column(heading, justify="left" if heading == "landing" else "right")
    rows: list[dict[str, Any]] = []
    for name, parameters in CASES.items():
        found = disagreement(core_solver(parameters, RTOL), CLanding(parameters, RTOL), UNTIL)
        if not found <= 1e-9:
            raise SystemExit(
                f"error: the landing in C differs from the core's by {found:.1e}: {name}"
            )
        core, c = least(parameters)
        rows.append({"case": f"{name} core and C", "seconds": core, "seconds_in_c": c})
        own = core / rows[0]["seconds"]
        numbers = (1e3 * core, 1e3 * c, core / c, own)
        table.add_row(name, *(f"{number:.3g}" for number in numbers))
    Console().print(table)
    append_rows(rows)


if __name__ == "__main__":
    main()
