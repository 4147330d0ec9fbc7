"""fmuloader: FMI's functions one by one, each kind of variable by its own; with events in FMI 3.0.

It reads no arrays, so of an FMU of FMI 3.0 only what is no leg's.
"""

import fmpy
from fmuloader.fmi2 import Fmi2Slave, Fmi2Type
from fmuloader.fmi3 import Fmi3Slave
from job import host


def started(fmu, description):
    """An instance before initialisation, and its functions by kind and by text."""
    if description.fmiVersion == "2.0":
        slave = Fmi2Slave(fmu, model_identifier=description.coSimulation.modelIdentifier)
        slave.instantiate("landing", Fmi2Type.CO_SIMULATION, guid=description.guid)
        slave.setup_experiment(start_time=0.0)
        readers = (slave.get_real, slave.get_integer, slave.get_boolean)
        return slave, dict(zip(("real", "integer", "boolean"), readers)), slave.set_real
    slave = Fmi3Slave(fmu, model_identifier=description.coSimulation.modelIdentifier)
    slave.instantiate_co_simulation(
        "landing",
        instantiation_token=description.guid,
        event_mode_used=True,
        early_return_allowed=True,
    )
    readers = (slave.get_float64, slave.get_int32, slave.get_boolean)
    return slave, dict(zip(("real", "integer", "boolean"), readers)), slave.set_float64


def handle_events(slave):
    while slave.update_discrete_states().discrete_states_need_update:
        pass
    slave.enter_step_mode()


def step_to_the_end(slave, time, size):
    """One step, with the events in it if the FMU stops at them."""
    end = time + size
    while True:
        done = slave.do_step(time, end - time)
        if isinstance(slave, Fmi2Slave):
            return
        if done.event_handling_needed:
            slave.enter_event_mode()
            handle_events(slave)
        if not done.early_return or end - done.last_successful_time < 1e-12:
            return
        time = done.last_successful_time


def land(fmu, job):
    description = fmpy.read_model_description(fmu)
    references = {v.name: v.valueReference for v in description.modelVariables}
    slave, readers, set_real = started(fmu, description)
    for name, value in job["parameters"].items():
        setter = slave.set_string if isinstance(value, str) else set_real
        setter([references[name]], [value])
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    if isinstance(slave, Fmi3Slave):
        handle_events(slave)
    wanted = {kind: [n for n, k in job["outputs"].items() if k == kind] for kind in readers}
    for k in range(job["steps"]):
        step_to_the_end(slave, k * job["step"], job["step"])
        values = {}
        for kind, names in wanted.items():
            read = readers[kind]([references[name] for name in names])
            values.update(zip(names, read))
        yield [(k + 1) * job["step"], *(values[name] for name in job["outputs"])]
        if k + 1 == job["inputs_after"]:
            inputs = job["inputs"]
            set_real([references[name] for name in inputs], list(inputs.values()))
    slave.terminate()
    slave.free_instance()


host(land)
