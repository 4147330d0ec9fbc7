"""Ecos by ecospy.

A parameter set, inputs by `set_real`, outputs by `get_real`, `get_integer` and `get_bool`.
"""

from ecospy import EcosSimulation, EcosSimulationStructure
from job import host


def land(fmu, job):
    structure = EcosSimulationStructure()
    structure.add_model("landing", fmu)
    structure.add_parameter_set(
        "job", {f"landing::{name}": value for name, value in job["parameters"].items()}
    )
    simulation = EcosSimulation(structure=structure, step_size=job["step"])
    simulation.init(parameter_set="job")
    readers = {
        "real": simulation.get_real,
        "integer": simulation.get_integer,
        "boolean": simulation.get_bool,
    }
    for k in range(1, job["steps"] + 1):
        time = simulation.step()
        yield [time, *(readers[kind](f"landing::{name}") for name, kind in job["outputs"].items())]
        if k == job["inputs_after"]:
            for name, value in job["inputs"].items():
                simulation.set_real(f"landing::{name}", value)
    simulation.terminate()


host(land)
