"""Time of a 1 s landing, sampled at 1 kHz with all outputs: compiled core, pure core, and through the FMU by FMPy.

All three take the same steps, so their error is the same: the largest difference of any main strut stroke from a landing at tolerance
1e-11. Prints a table with ratios to the compiled core, and appends a row a case to `results.jsonl`.
"""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from rich.console import Console
from rich.table import Table

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_landing.quantities import OUTPUT_NAMES

HERE = Path(__file__).parent
FMU = HERE.parent / "build" / "RlvLanding.fmu"
STROKES = [f"leg[{leg}].main_strut.stroke" for leg in (1, 2, 3, 4)]
REPEATS = 5
PURE = """
import json, sys, time
from rlv_landing import Landing, load_preset
landing = Landing(load_preset("yue2022-figures"), sys.argv[1])
start = time.perf_counter()
history = landing.run(1.0)
seconds = time.perf_counter() - start
print(json.dumps({"seconds": seconds, "strokes": [history[n].tolist() for n in json.loads(sys.argv[2])]}))
"""


def compiled(mode: str) -> tuple[float, History, int]:
    """Best of REPEATS."""
    best = float("inf")
    for _ in range(REPEATS):
        landing = Landing(load_preset("yue2022-figures"), mode)
        start = time.perf_counter()
        history = landing.run(1.0)
        best = min(best, time.perf_counter() - start)
    return best, history, landing.statistics["rhs_calls"]


def pure(mode: str) -> tuple[float, np.ndarray]:
    """Once, in a process that uses the plain Python core."""
    command = [sys.executable, "-c", PURE, mode, json.dumps(STROKES)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env={**os.environ, "RLV_LANDING_PURE": "1"})
    result = json.loads(done.stdout)
    return result["seconds"], np.array(result["strokes"])


def through_fmu(mode: str) -> tuple[float, Any]:
    """Best of REPEATS; unpacking and loading included, as an importer sees it."""
    values = {n: v for n, v in load_preset("yue2022-figures", mode).items() if n.startswith("drop.")}
    best = float("inf")
    for _ in range(REPEATS):
        start = time.perf_counter()
        result = fmpy.simulate_fmu(str(FMU), stop_time=1.0, output_interval=1e-3, start_values=values, output=list(OUTPUT_NAMES))
        best = min(best, time.perf_counter() - start)
    return best, result


def provenance() -> dict[str, str]:
    """Commit and processor."""
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True, cwd=HERE).stdout.strip()
    names = [line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    return {"commit": commit, "cpu": names[0] if names else platform.processor(), "python": platform.python_version()}


def append_rows(rows: list[dict[str, Any]]) -> None:
    """Append the rows, stamped with their provenance, to `results.jsonl`."""
    stamp = provenance()
    with (HERE / "results.jsonl").open("a", encoding="utf-8") as f:
        for row in rows:
            f.write(json.dumps({**stamp, **row}) + "\n")


def main() -> None:
    rows: list[dict[str, Any]] = []
    for mode in ("2-2", "1-2-1"):
        reference = Landing(load_preset("yue2022-figures"), mode, rtol=1e-11).run(1.0)
        exact = np.array([reference[n] for n in STROKES])
        seconds, history, calls = compiled(mode)
        rows.append(
            {"case": f"{mode} compiled core", "seconds": seconds, "strokes": np.array([history[n] for n in STROKES]), "rhs_calls": calls}
        )
        seconds, strokes = pure(mode)
        rows.append({"case": f"{mode} pure core", "seconds": seconds, "strokes": strokes, "rhs_calls": calls})
        seconds, result = through_fmu(mode)
        rows.append(
            {"case": f"{mode} FMU by FMPy", "seconds": seconds, "strokes": np.array([result[n] for n in STROKES]), "rhs_calls": calls}
        )
        for row in rows[-3:]:
            row["error"] = float(np.abs(row.pop("strokes") - exact).max())
            row["ratio"] = row["seconds"] / rows[-3]["seconds"]
    table = Table(title="1 s landing, 1001 samples of all outputs", title_justify="left")
    for name in ("case", "seconds", "ratio to compiled", "rhs calls", "worst stroke error [mm]"):
        table.add_column(name, justify="left" if name == "case" else "right")
    for row in rows:
        table.add_row(row["case"], f"{row['seconds']:.4f}", f"{row['ratio']:.1f}", str(row["rhs_calls"]), f"{1e3 * row['error']:.2e}")
    Console(width=110).print(table)
    append_rows(rows)


if __name__ == "__main__":
    main()
