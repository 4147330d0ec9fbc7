"""Compares the quasi-3D core with a full 3-D Newton-Euler model of the vehicle at equal error.

The 3-D model is that of `tests/independent/vehicle_3d.py`: numpy over four legs, no symmetry used,
45 states, 18 linear equations per call. scipy's RK45 integrates it: the core's method
`dormand-prince`, with the core's scales of error. The error of either is the largest difference of
any main strut stroke from its own landing at a far tighter tolerance. Both run at several
tolerances. Interpolation between them gives the calls of the right-hand side at equal error, and
seconds are calls times seconds per call.

Seconds compare languages as much as models: a compiled core, a plain Python one, numpy. So the work
of one right-hand side is counted too. Both models run on numbers that count their operations, at
the same moment of the landing: + - * / sqrt on one hand, powers, exp, sin, cos, tanh on the other.
The core's work includes its energy accounts, which the 3-D model has not. The 3-D model's is given
with and without its dense elimination, because a specialised one would cost less. Compiled like the
core, the 3-D model would be slower by about the ratio of the work. Prints a table and appends one
row per case to `results.jsonl`.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from array import array
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from rows import append_rows, start
from scipy.integrate import solve_ivp

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.assembly import new_solver, planar_system
from rlv_landing.core.bodies.planar import Planar
from rlv_landing.landing import DEFAULT_RTOL

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests" / "independent"))
from vehicle_3d import LEGS, SCALE, Vehicle3D  # noqa: E402

PRESET = "yue2022-figures"
# the files of the core that do arithmetic in a right-hand side
PARTS = (
    "bodies.planar_legs", "bodies.planar_motion", "leg", "struts.liquid_spring",
    "struts.end_stops", "struts.fluid", "struts.elastic", "ground.normal", "ground.paper_friction",
)  # fmt: skip
STROKES = [f"leg[{leg}].main_strut.stroke" for leg in (1, 2, 3, 4)]
BODY = ("x", "y", "pitch", "vx", "vy", "pitch_rate")
METHOD = "dormand-prince"
UNTIL = 0.5
TIMES = np.arange(501) * 1e-3
MOMENT = 0.3  # s; the work is counted here, after all footpads have landed
TARGETS = (3e-7, 1e-8)  # m
TOLERANCES = (1e-5, 1e-6, 1e-7, 1e-8, 3e-9)
REPEATS = 5
PURE = """
import json, sys, time
from rlv_landing import Landing, load_preset
landing = Landing(load_preset("yue2022-figures"), sys.argv[1], method="dormand-prince")
start = time.perf_counter()
landing.advance_to(float(sys.argv[2]))
print((time.perf_counter() - start) / landing.statistics["rhs_calls"])
"""

Runs = list[tuple[float, int]]  # (error [m], calls) at each tolerance


class Count:
    """A number that counts the operations done with it."""

    operations = 0
    functions = 0

    def __init__(self, value: float) -> None:
        self.value = float(value)

    def __float__(self) -> float:
        return self.value

    def __neg__(self) -> Count:
        return Count(-self.value)

    def __abs__(self) -> Count:
        return Count(abs(self.value))


def _operator(name: str, *, function: bool) -> None:
    def apply(self: Count, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        Count.functions += function
        Count.operations += not function
        return Count(getattr(float, name)(self.value, float(other)))

    setattr(Count, name, apply)


def _comparison(name: str) -> None:
    setattr(Count, name, lambda self, other: getattr(float, name)(self.value, float(other)))


def _hypot(self: Count, other: Any) -> Count:
    # two products, a sum and a root
    Count.operations += 4
    return Count(math.hypot(self.value, float(other)))


def _method(name: str) -> None:
    def apply(self: Count) -> Count:
        Count.functions += name != "sqrt"
        Count.operations += name == "sqrt"
        return Count(getattr(math, name)(self.value))

    setattr(Count, name, apply)


for _name in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv"):
    _operator(f"__{_name}__", function=False)
for _name in ("pow", "rpow"):
    _operator(f"__{_name}__", function=True)
for _name in ("lt", "le", "gt", "ge"):
    _comparison(f"__{_name}__")
for _name in ("sqrt", "exp", "sin", "cos", "tanh"):
    _method(_name)
setattr(Count, "hypot", _hypot)  # noqa: B010


# each number of an array as one that counts
COUNTED = np.frompyfunc(lambda v: v if isinstance(v, Count) else Count(v), 1, 1)


class Counted3D(Vehicle3D):
    """The 3-D model; counts its linear solution as 2/3 n^3 + 2 n^2 operations."""

    elimination = 2 * 18**3 // 3 + 2 * 18**2

    def exp(self, x: Any) -> Any:
        """Exponentials of floats, too, which bounds put in the place of a Count."""
        return np.exp(COUNTED(x))

    def solve(self, A: Any, b: Any) -> Any:
        """Solve the 18 equations with floats, so that their operations are not counted here."""
        return np.array(
            [Count(v) for v in np.linalg.solve(A.astype(float), b.astype(float))], dtype=object
        )


def count(work: Any) -> tuple[int, int]:
    """(operations, functions) of one call of `work`."""
    Count.operations = Count.functions = 0
    work()
    return Count.operations, Count.functions


def work_of_core(parameters: Parameters, time: float) -> tuple[int, int]:
    """Work of one right-hand side of the plain core at `time` [s] of a landing."""
    replaced = []
    for part in PARTS:
        module = import_module(f"rlv_landing.core.{part}")
        for name in ("sin", "cos", "sqrt", "exp", "tanh", "fabs", "pow"):
            if hasattr(module, name):
                replaced.append((module, name, getattr(module, name)))
                special = {
                    "fabs": abs,
                    "pow": lambda a, b: (a if isinstance(a, Count) else Count(a)) ** b,
                }
                setattr(
                    module,
                    name,
                    special.get(
                        name,
                        lambda a, name=name: getattr(
                            a if isinstance(a, Count) else Count(a), name
                        )(),
                    ),
                )
    system, solver = planar_system(parameters, Planar), new_solver(parameters, DEFAULT_RTOL)
    state = array("d", bytes(8 * solver.n))
    solver.advance(time)
    solver.interpolate(time, state)
    y: list[Any] = [Count(v) for v in state]
    u: list[Any] = [Count(0.0) for _ in range(system.inputs)]
    try:
        return count(lambda: system.rhs(y, u, [0.0] * len(y)))
    finally:
        for module, name, function in replaced:
            setattr(module, name, function)


def core(mode: str, rtol: float) -> tuple[np.ndarray, int, float]:
    """Strokes, calls, and best seconds per call of the compiled core."""
    best = math.inf
    for _ in range(REPEATS):
        landing = Landing(load_preset(PRESET), mode, rtol, METHOD)
        start = time.perf_counter()
        landing.advance_to(UNTIL)
        best = min(best, time.perf_counter() - start)
    calls = landing.statistics["rhs_calls"]
    history = Landing(load_preset(PRESET), mode, rtol, METHOD).run(UNTIL, 1e-3)
    return np.array([history[n] for n in STROKES]), calls, best / calls


def space(
    mode: str, rtol: float, method: str = "RK45"
) -> tuple[np.ndarray, int, float, np.ndarray]:
    """Strokes, calls, seconds per call and states of the 3-D model."""
    landing = Landing(load_preset(PRESET), mode)
    model = Vehicle3D(landing.parameters)
    y0 = model.start([landing.get(f"body.{n}") for n in BODY])
    start = time.perf_counter()
    done = solve_ivp(
        model, (0.0, UNTIL), y0, method, TIMES, rtol=rtol, atol=rtol * SCALE, max_step=2e-3
    )
    seconds = time.perf_counter() - start
    r, h = done.y[LEGS : LEGS + 4], done.y[LEGS + 4 : LEGS + 8]
    m = landing.parameters.main_strut
    return (
        m.length - np.hypot(r - m.joint_radius, h + m.joint_depth),
        model.calls,
        seconds / model.calls,
        done.y,
    )


def pure(mode: str) -> float:
    """Seconds per call of the uncompiled core, in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", PURE, mode, str(UNTIL)],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "RLV_LANDING_PURE": "1"},
    )
    return float(done.stdout)


def calls_at(runs: Runs, error: float) -> float:
    """Calls at which `error` [m] would be met, by interpolation in logarithms."""
    errors, calls = np.log(np.array(sorted(runs))).T
    if not errors[0] <= math.log(error) <= errors[-1]:
        raise SystemExit(
            f"error: {error:g} m is outside the errors found, "
            f"{np.exp(errors[0]):.1e} to {np.exp(errors[-1]):.1e} m"
        )
    return float(np.exp(np.interp(math.log(error), errors, calls)))


def measure(mode: str) -> list[dict[str, Any]]:
    """Rows of one landing mode."""
    exact_core, exact_space = core(mode, 1e-11)[0], space(mode, 1e-10, "DOP853")[0]
    print(f"{mode}: references differ by {1e3 * np.abs(exact_core - exact_space).max():.1e} mm")
    ours: Runs = []
    full: Runs = []
    for rtol in TOLERANCES:
        strokes, calls, core_seconds = core(mode, rtol)
        ours.append((float(np.abs(strokes - exact_core).max()), calls))
        strokes, calls, space_seconds, states = space(mode, rtol)
        full.append((float(np.abs(strokes - exact_space).max()), calls))
        print(
            f"{mode} rtol {rtol:.0e}: core {ours[-1][0]:.1e} m in {ours[-1][1]} calls, "
            f"3-D {full[-1][0]:.1e} m in {full[-1][1]} calls"
        )
    pure_seconds = pure(mode)
    parameters = load_preset(PRESET, mode)
    core_work = work_of_core(parameters, MOMENT)
    counted = Counted3D(parameters)
    state = np.array([Count(v) for v in states[:, round(MOMENT * 1e3)]], dtype=object)
    space_work = count(lambda: counted(MOMENT, state))

    rows = []
    for error in TARGETS:
        cases = (
            ("compiled core", calls_at(ours, error), core_seconds, core_work, 0),
            ("pure core", calls_at(ours, error), pure_seconds, core_work, 0),
            ("3-D, numpy", calls_at(full, error), space_seconds, space_work, Counted3D.elimination),
        )
        for case, calls, seconds, (operations, functions), elimination in cases:
            rows.append(
                {
                    "case": f"quasi3d {mode} {case}",
                    "error": error,
                    "rhs_calls": round(calls),
                    "seconds_per_call": seconds,
                    "seconds": calls * seconds,
                    "operations": operations,
                    "elimination": elimination,
                    "functions": functions,
                }
            )
    return rows


def work_ratios(row: dict[str, Any], base: dict[str, Any]) -> list[float]:
    """The work of a row over that of the row `base`, without and with the dense elimination.

    Work is calls times operations, of which a function counts as 20.
    """
    return [
        row["rhs_calls"] * (row["operations"] + extra + 20 * row["functions"])
        / (base["rhs_calls"] * (base["operations"] + 20 * base["functions"]))
        for extra in (0, row["elimination"])
    ]  # fmt: skip


def work_table(rows: list[dict[str, Any]]) -> Table:
    """The table of the rows, with their `work_ratio`."""
    table = Table(title=f"Landing to {UNTIL} s at equal error of the strokes", title_justify="left")
    for name in (
        "case",
        "error [mm]",
        "rhs calls",
        "us a call",
        "seconds",
        "+-*/ a call",
        "elimination",
        "functions",
        "work to core",
    ):
        table.add_column(name, justify="left" if name == "case" else "right")
    for row in rows:
        ratio = row["work_ratio"]
        table.add_row(
            row["case"],
            f"{1e3 * row['error']:.0e}",
            str(row["rhs_calls"]),
            f"{1e6 * row['seconds_per_call']:.2f}",
            f"{row['seconds']:.4f}",
            str(row["operations"]),
            str(row["elimination"]),
            str(row["functions"]),
            f"{ratio[0]:.2f}" if ratio[0] == ratio[1] else f"{ratio[0]:.1f} to {ratio[1]:.1f}",
        )
    table.caption = (
        "work to core: calls times (+-*/ + 20 per function), without and with the dense "
        "elimination. Seconds compare languages too: numpy against compiled or plain Python; the "
        "work does not. The core's includes its energy accounts."
    )
    return table


def main() -> None:
    """Measure both modes, print the table and append the rows."""
    start()
    rows = [row for mode in ("2-2", "1-2-1") for row in measure(mode)]
    for i, row in enumerate(rows):
        row["work_ratio"] = work_ratios(row, rows[i - i % 3])
    Console(width=130).print(work_table(rows))
    append_rows(rows)


if __name__ == "__main__":
    main()
