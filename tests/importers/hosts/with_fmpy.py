"""FMPy: `simulate_fmu`, parameters as start values, inputs as a table over time."""

import fmpy
import numpy as np
from job import host


def land(fmu, job):
    time = np.arange(job["steps"] + 1) * job["step"]
    table = np.zeros(len(time), dtype=[("time", float), *((name, float) for name in job["inputs"])])
    table["time"] = time
    for name, value in job["inputs"].items():
        table[name][job["inputs_after"] :] = value
    result = fmpy.simulate_fmu(
        fmu,
        stop_time=time[-1],
        step_size=job["step"],
        output_interval=job["step"],
        start_values=job["parameters"],
        input=table,
        output=list(job["outputs"]),
    )
    return [[row[name] for name in ("time", *job["outputs"])] for row in result[1:]]


host(land)
