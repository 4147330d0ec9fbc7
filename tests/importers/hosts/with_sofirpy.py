"""sofirpy: the FMU between two models in Python; one gives its inputs, one takes its outputs.

It reads Integers and Booleans by their own functions, and sets no strings. It writes outputs down
after the next inputs are set, and accelerations follow inputs at once; so the rows are what the
second model was given before.
"""

import numpy as np
from job import host
from sofirpy import SimulationEntity, simulate


class Inputs(SimulationEntity):
    """Gives the job's inputs from the end of step `after` on, and 0 before."""

    values, after, step = {}, 0, 0.0
    changed = False

    def set_parameter(self, parameter_name, parameter_value):
        raise NotImplementedError

    def get_parameter_value(self, parameter_name):
        return self.values[parameter_name] if self.changed else 0.0

    def do_step(self, time):
        self.changed = time > (self.after - 1.5) * self.step

    def get_dtype_of_parameter(self, parameter_name):
        return float


class Outputs(SimulationEntity):
    """Keeps what it is given."""

    def __init__(self):
        self.values = {}

    def set_parameter(self, parameter_name, parameter_value):
        self.values[parameter_name] = float(parameter_value)

    def get_parameter_value(self, parameter_name):
        return self.values.get(parameter_name, 0.0)

    def do_step(self, time):
        """It has no states."""

    def get_dtype_of_parameter(self, parameter_name):
        return float


def from_system(system, names):
    """Connections of variables of one name."""
    return [
        {
            "parameter_name": name,
            "connect_to_system": system,
            "connect_to_external_parameter": name,
        }
        for name in names
    ]


def land(fmu, job):
    Inputs.values, Inputs.after, Inputs.step = job["inputs"], job["inputs_after"], job["step"]
    names = list(job["outputs"])
    table = simulate(
        stop_time=job["steps"] * job["step"],
        step_size=job["step"],
        fmu_paths={"landing": fmu},
        model_classes={"inputs": Inputs, "outputs": Outputs},
        connections_config={
            "outputs": from_system("landing", names),
            "landing": from_system("inputs", job["inputs"]),
        },
        start_values={"landing": job["parameters"]},
        parameters_to_log={"outputs": names},
    )
    rows = table[["time", *(f"outputs.{name}" for name in names)]].to_numpy(dtype=float)
    return np.asarray(rows)[1:]


host(land)
