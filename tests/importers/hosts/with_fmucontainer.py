"""fmucontainer of fmu-manipulation-toolbox: two landings in one FMU, run by FMPy.

One is the job's, the other the default drop. The container's outputs are `job.NAME` and
`other.NAME`; the rows hold the job's and then the other's.
"""

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np
from job import host

EMBEDDED = {"job": "RlvLanding.fmu", "other": "RlvLanding-1.fmu"}


def build(fmu, job, folder):
    """The container's file, in `folder`."""
    (folder / "RlvLanding.fmu").symlink_to(Path(fmu).resolve())
    names = list(EMBEDDED.values())
    description = {
        "name": "two.fmu",
        "step_size": job["step"],
        "auto_link": False,
        "auto_input": False,
        "auto_output": False,
        "fmu": names,
        "path": {names[1]: names[0]},
        "input": [[f"job.{name}", names[0], name] for name in job["inputs"]],
        "output": [
            [file, name, f"{who}.{name}"]
            for who, file in EMBEDDED.items()
            for name in job["outputs"]
        ],
        "start": [[names[0], name, value] for name, value in job["parameters"].items()],
    }
    (folder / "two.json").write_text(json.dumps(description), encoding="utf-8")
    command = [
        str(Path(sys.executable).parent / "fmucontainer"),
        "-fmu-directory",
        str(folder),
        "-container",
        "two.json",
    ]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return folder / "two.fmu"


def land(fmu, job):
    time = np.arange(job["steps"] + 1) * job["step"]
    table = np.zeros(
        len(time), dtype=[("time", float), *((f"job.{name}", float) for name in job["inputs"])]
    )
    table["time"] = time
    for name, value in job["inputs"].items():
        table[f"job.{name}"][job["inputs_after"] :] = value
    outputs = [f"{who}.{name}" for who in EMBEDDED for name in job["outputs"]]
    with TemporaryDirectory() as folder:
        container = build(fmu, job, Path(folder))
        result = fmpy.simulate_fmu(
            str(container),
            stop_time=time[-1],
            step_size=job["step"],
            output_interval=job["step"],
            input=table,
            output=outputs,
        )
    return [[row[name] for name in ("time", *outputs)] for row in result[1:]]


host(land)
