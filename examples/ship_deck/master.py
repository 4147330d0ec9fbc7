"""A co-simulation master in Python: FMPy's instances, a fixed step, Jacobi.

Jacobi: all instances make their step with the inputs of its start. Then outputs go to the inputs
that they are connected to.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

Parameters = dict[str, dict[str, float]]
Connections = dict[tuple[str, str], tuple[str, str]]


class Component:
    """An instance of the FMU `file`, its variables by name."""

    def __init__(self, name: str, file: Path, folder: Path) -> None:
        description = fmpy.read_model_description(str(file))
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.outputs = [
            v.name
            for v in description.modelVariables
            if v.causality == "output" and v.type == "Real"
        ]
        self._output_references = [self.references[output] for output in self.outputs]
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=fmpy.extract(str(file), str(folder / name)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.slave.instantiate()

    def start(self, parameters: dict[str, float]) -> None:
        """Initialise the instance at time 0 with `parameters`."""
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.set(parameters)
        self.slave.exitInitializationMode()

    def set(self, values: dict[str, float]) -> None:
        """Set real variables by name."""
        self.slave.setReal([self.references[name] for name in values], list(values.values()))

    def get(self) -> list[float]:
        """Values of all real outputs, in the order of `outputs`."""
        return self.slave.getReal(self._output_references)


def simulate(
    fmus: dict[str, Path],
    connections: Connections,
    parameters: Parameters,
    step: float = 1e-3,
    until: float = 3.0,
    progress: Callable[[float], object] | None = None,
) -> dict[str, np.ndarray]:
    """Run the system from time 0.

    Args:
        fmus: The file of every component.
        connections: (component, output) -> (component, input).
        parameters: Values by name for every component.
        step: Communication step [s].
        until: End [s].
        progress: Called with the time [s] after each step.

    Returns:
        `time`, and the real outputs of all components as `component.output`, at every communication
        point.
    """
    with TemporaryDirectory() as folder:
        components = {name: Component(name, file, Path(folder)) for name, file in fmus.items()}
        for name, component in components.items():
            component.start(parameters[name])
        columns = [
            f"{name}.{output}"
            for name, component in components.items()
            for output in component.outputs
        ]
        time, rows = 0.0, []
        for k in range(round(until / step) + 1):
            if k > 0:
                for component in components.values():
                    component.slave.doStep(time, step)
                # summed as in Ecos, so that both have the same communication points
                time += step
            transfer(
                components,
                connections,
                {name: component.get() for name, component in components.items()},
            )
            # read again, as Ecos does: inputs act on accelerations and contact forces at once
            rows.append(
                [time, *(value for component in components.values() for value in component.get())]
            )
            if progress is not None:
                progress(time)
        for component in components.values():
            component.slave.terminate()
            component.slave.freeInstance()
    return dict(zip(["time", *columns], np.array(rows).T))


def transfer(
    components: dict[str, Component], connections: Connections, values: dict[str, list[float]]
) -> None:
    """Set every connected input to the output that drives it."""
    inputs: dict[str, dict[str, float]] = {}
    for (source, output), (target, name) in connections.items():
        inputs.setdefault(target, {})[name] = values[source][
            components[source].outputs.index(output)
        ]
    for target, settings in inputs.items():
        components[target].set(settings)
