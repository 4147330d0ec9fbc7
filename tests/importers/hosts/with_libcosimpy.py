"""libcosim by libcosimpy.

Initial values of reals and strings, inputs by an override manipulator, outputs by an observer.
"""

from job import host
from libcosimpy.CosimEnums import CosimVariableType
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave


def land(fmu, job):
    log_output_level(CosimLogLevel.WARNING)
    step = round(job["step"] * 1e9)
    execution = CosimExecution.from_step_size(step)
    landing = execution.add_local_slave(CosimLocalSlave(fmu, "landing"))
    variables = {v.name.decode(): v for v in execution.slave_variables(landing)}
    for name, value in job["parameters"].items():
        set_start = (
            execution.string_initial_value
            if isinstance(value, str)
            else execution.real_initial_value
        )
        assert set_start(landing, variables[name].reference, value)
    inputs, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    assert execution.add_manipulator(inputs)
    assert execution.add_observer(observer)
    readers = {
        CosimVariableType.REAL.value: observer.last_real_values,
        CosimVariableType.INTEGER.value: observer.last_integer_values,
        CosimVariableType.BOOLEAN.value: observer.last_boolean_values,
    }
    wanted = [variables[name] for name in job["outputs"]]
    for k in range(1, job["steps"] + 1):
        # libcosimpy 0.0.4, the last one for Python 3.10, returns False although the step is made
        execution.step()
        assert execution.status().current_time == k * step
        values = {}
        for kind, read in readers.items():
            references = [v.reference for v in wanted if v.type == kind]
            values.update(zip([(kind, r) for r in references], read(landing, references)))
        yield [k * step / 1e9, *(values[v.type, v.reference] for v in wanted)]
        if k == job["inputs_after"]:
            references = [variables[name].reference for name in job["inputs"]]
            assert inputs.slave_real_values(landing, references, list(job["inputs"].values()))


host(land)
