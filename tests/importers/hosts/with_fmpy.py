"""FMPy: `simulate_fmu`, parameters as start values, inputs as a table over time.

Of an FMU of FMI 3.0 the outputs of the legs are elements of arrays.
"""

import re

import fmpy
import numpy as np
from job import host

LEG = re.compile(r"leg\[(\d)\]")


def land(fmu, job):
    arrays = fmpy.read_model_description(fmu).fmiVersion == "3.0"
    wanted = {name: LEG.sub("leg", name) if arrays else name for name in job["outputs"]}
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
        output=list(dict.fromkeys(wanted.values())),
    )
    columns = [result["time"]]
    for name, whole in wanted.items():
        values = result[whole]
        columns.append(values if whole == name else values[:, int(LEG.match(name)[1]) - 1])
    return np.array(columns).T[1:]


host(land)
