"""PathSim with pathsim-fmi: the FMU as a block, its inputs from sources, its outputs in a scope.

It reads every output as a Real, and sets no strings.
"""

import numpy as np
from job import host
from pathsim import Connection, Simulation
from pathsim.blocks import Scope, Source
from pathsim_fmi import CoSimulationFMU


def land(fmu, job):
    # the block steps at the beginning of each interval, and so the change is a quarter step early
    change = (job["inputs_after"] - 0.25) * job["step"]
    landing = CoSimulationFMU(fmu, start_values=job["parameters"], dt=job["step"])
    sources = {
        name: Source(lambda t, value=value: value if t >= change else 0.0)
        for name, value in job["inputs"].items()
    }
    scope = Scope(sampling_period=job["step"], t_wait=job["step"] / 2)
    connections = [Connection(source, landing[name]) for name, source in sources.items()]
    names = list(job["outputs"])
    connections += [Connection(landing[name], scope[i]) for i, name in enumerate(names)]
    simulation = Simulation(
        [landing, scope, *sources.values()], connections, dt=job["step"] / 2, log=False
    )
    simulation.run(job["steps"] * job["step"])
    times, values = scope.read()
    rows = np.column_stack([times + job["step"] / 2, np.transpose(values)])
    return rows[: job["steps"]]


host(land)
