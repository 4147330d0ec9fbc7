"""Measures what the FMU costs FMPy, beside an FMU in C with the same variables and no model.

- Cold: a new Python process imports FMPy and lands for 1 s in 1 ms steps with all outputs recorded.
  Measured from its start to its end. Parts of it are the start of Python with the import of FMPy,
  and `simulate_fmu` (unpacking, loading, the landing, removing). The processor time of its main
  thread is what an idle machine would take, without reading files.
- Calls: `fmi2DoStep` of 1 ms, alone and with all Real outputs in one `fmi2GetReal` with arrays made
  before, over the 1000 steps of a landing.

The C FMU (`empty_fmu.c`, compiled here by gcc) has the FMU's modelDescription.xml and nothing else
to unpack, and its step does nothing. So the ratios are upper bounds of those to the same model
written in C. The two FMUs take turns, and the best of all turns counts. Prints a table and appends
one row per case to `results.jsonl`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
import zipfile
from ctypes import c_double, c_uint
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import FMU2Slave
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rows import FMU, append_rows, start

HERE = Path(__file__).parent
HEADERS = Path(fmpy.__file__).parent / "c-code"
REPEATS = 10
STEPS = 1000
COLD = """
import json, sys, time
import fmpy
start = time.perf_counter()
result = fmpy.simulate_fmu(sys.argv[1], stop_time=1.0, output_interval=1e-3)
seconds = time.perf_counter() - start
shape = {"samples": len(result), "columns": len(result.dtype.names)}
print(json.dumps({"simulate": seconds, "processor": time.thread_time(), **shape}))
"""


def empty_fmu(folder: Path) -> Path:
    """Build the C FMU in `folder`."""
    with zipfile.ZipFile(FMU) as archive:
        description = archive.read("modelDescription.xml")
    variables = len(fmpy.read_model_description(str(FMU)).modelVariables)
    library = folder / "RlvLanding.so"
    options = [
        "-O2",
        "-Wall",
        "-Werror",
        "-shared",
        "-fPIC",
        f"-DVARIABLES={variables}",
        "-isystem",
        str(HEADERS),
    ]
    subprocess.run(["gcc", *options, "-o", str(library), str(HERE / "empty_fmu.c")], check=True)
    made = folder / "Empty.fmu"
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, "binaries/linux64/RlvLanding.so")
    return made


def cold(fmu: Path) -> dict[str, float]:
    """Measure one landing in a new Python process.

    Returns:
        Seconds of the whole process (`cold`), of `simulate_fmu` in it (`simulate`), of the rest
        (`start`), and of its main thread on a processor (`processor`).
    """
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", COLD, str(fmu)], capture_output=True, text=True, check=True
    )
    seconds = time.perf_counter() - start
    found = json.loads(done.stdout)
    outputs = sum(
        v.causality == "output" for v in fmpy.read_model_description(str(fmu)).modelVariables
    )
    if (found["samples"], found["columns"]) != (STEPS + 1, outputs + 1):
        raise SystemExit(
            f"error: {fmu.name} gave {found['samples']} samples of {found['columns']} columns"
        )
    return {
        "cold": seconds,
        "simulate": found["simulate"],
        "start": seconds - found["simulate"],
        "processor": found["processor"],
    }


def calls(fmu: Path, folder: Path) -> dict[str, float]:
    """Mean seconds per step of one landing: `fmi2DoStep` alone, and with all Real outputs."""
    description = fmpy.read_model_description(str(fmu))
    outputs = [
        v.valueReference
        for v in description.modelVariables
        if v.causality == "output" and v.type == "Real"
    ]
    vrs, values, n = (c_uint * len(outputs))(*outputs), (c_double * len(outputs))(), len(outputs)
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="bench",
    )
    slave.instantiate()
    component, do_step, get_real = slave.component, slave.fmi2DoStep, slave.fmi2GetReal
    taken: dict[str, float] = {}
    for case in ("step", "step_get"):
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        start = time.perf_counter()
        if case == "step":
            for k in range(STEPS):
                do_step(component, k * 1e-3, 1e-3, 1)
        else:
            for k in range(STEPS):
                do_step(component, k * 1e-3, 1e-3, 1)
                get_real(component, vrs, n, values)
        taken[case] = (time.perf_counter() - start) / STEPS
        slave.terminate()
        slave.reset()
    slave.freeInstance()
    return taken


def cost_table(best: dict[str, dict[str, float]], load: float) -> Table:
    """The costs of both FMUs, and their ratios.

    Args:
        best: Seconds of each part, by FMU: ours, then the one without a model.
        load: The machine's load before the measurement.
    """
    ours, empty = best.values()
    table = Table(
        title=f"Cost to FMPy {fmpy.__version__}: best of {REPEATS}, "
        f"load {load:.1f} on {os.cpu_count()} cores",
        title_justify="left",
    )
    for heading in ("cost", *best, "ratio"):
        table.add_column(heading, justify="left" if heading == "cost" else "right")
    for key, what, scale, unit in (
        ("cold", "landing of 1 s, 1 ms, all outputs, cold process", 1e3, "ms"),
        ("start", "  of it Python's start and end, import of FMPy", 1e3, "ms"),
        ("simulate", "  of it simulate_fmu", 1e3, "ms"),
        ("processor", "  of it the main thread on a processor", 1e3, "ms"),
        ("step", "fmi2DoStep of 1 ms", 1e6, "us"),
        ("step_get", "fmi2DoStep and all Real outputs in one call", 1e6, "us"),
    ):
        table.add_row(
            escape(f"{what} [{unit}]"),
            f"{scale * ours[key]:.1f}",
            f"{scale * empty[key]:.1f}",
            f"{ours[key] / empty[key]:.1f}",
        )
    table.caption = (
        "the C FMU computes nothing: the ratios are upper bounds of those to the same model in C"
    )
    return table


def main() -> None:
    """Measure both FMUs, print the table and append the rows."""
    start()
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        fmus = {"FMU": FMU, "C FMU without a model": empty_fmu(folder)}
        unpacked = {
            case: Path(fmpy.extract(str(fmu), str(folder / case.split()[0])))
            for case, fmu in fmus.items()
        }
        best: dict[str, dict[str, float]] = {case: {} for case in fmus}
        for _ in range(REPEATS):
            for case, fmu in fmus.items():
                for key, seconds in {**cold(fmu), **calls(fmu, unpacked[case])}.items():
                    best[case][key] = min(seconds, best[case].get(key, seconds))
    load = start().load
    Console(width=110).print(cost_table(best, load))
    rows: list[dict[str, Any]] = [
        {"case": f"cost {case}", "load": load, "fmpy": fmpy.__version__, **cost}
        for case, cost in best.items()
    ]
    append_rows(rows)


if __name__ == "__main__":
    main()
