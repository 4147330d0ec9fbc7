"""The same system as an SSP 1.0 file (System Structure and Parameterization), run by Ecos."""

from __future__ import annotations

import ctypes
import sys
import zipfile
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import fmpy
import numpy as np
from master import Connections, Parameters

NAMESPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}
PARAMETER_SET = "start"


def write(
    path: Path,
    fmus: dict[str, Path],
    connections: Connections,
    parameters: Parameters,
    until: float,
) -> None:
    """Write the system to `path` (.ssp).

    The file has the FMUs, their connections, and all their parameters as the set `start`.
    """
    prefixes = {f"xmlns:{prefix}": uri for prefix, uri in NAMESPACES.items()}
    root = Element("ssd:SystemStructureDescription", prefixes, name=path.stem, version="1.0")
    system = SubElement(root, "ssd:System", name=path.stem)
    elements = SubElement(system, "ssd:Elements")
    for name, file in fmus.items():
        add_component(elements, name, file, connections, parameters[name])
    lines = SubElement(system, "ssd:Connections") if connections else system
    for (source, output), (target, inlet) in connections.items():
        SubElement(
            lines,
            "ssd:Connection",
            startElement=source,
            startConnector=output,
            endElement=target,
            endConnector=inlet,
        )
    SubElement(root, "ssd:DefaultExperiment", startTime="0.0", stopTime=repr(until))
    indent(root)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(
            "SystemStructure.ssd", tostring(root, encoding="utf-8", xml_declaration=True)
        )
        for file in fmus.values():
            archive.write(file, f"resources/{file.name}")


def add_component(
    elements: Element, name: str, file: Path, connections: Connections, parameters: dict[str, float]
) -> None:
    """Add the FMU `file` as the component `name`.

    It gets connectors for its connected variables, and its parameters with the types that the FMU
    states.
    """
    types = {v.name: v.type for v in fmpy.read_model_description(str(file)).modelVariables}
    element = SubElement(
        elements,
        "ssd:Component",
        name=name,
        type="application/x-fmu-sharedlibrary",
        source=f"resources/{file.name}",
    )
    ends = [("output", end) for end in connections] + [
        ("input", end) for end in connections.values()
    ]
    own = [(kind, variable) for kind, (component, variable) in ends if component == name]
    connectors = SubElement(element, "ssd:Connectors") if own else element
    for kind, variable in own:
        SubElement(
            SubElement(connectors, "ssd:Connector", name=variable, kind=kind),
            f"ssc:{types[variable]}",
        )
    if parameters:
        binding = SubElement(SubElement(element, "ssd:ParameterBindings"), "ssd:ParameterBinding")
        values = SubElement(
            SubElement(binding, "ssd:ParameterValues"),
            "ssv:ParameterSet",
            version="1.0",
            name=PARAMETER_SET,
        )
        entries = SubElement(values, "ssv:Parameters")
        for parameter, value in parameters.items():
            SubElement(
                SubElement(entries, "ssv:Parameter", name=parameter),
                f"ssv:{types[parameter]}",
                value=str(value),
            )


def run_in_ecos(
    path: Path,
    columns: list[str],
    step: float = 1e-3,
    until: float = 3.0,
    progress: Callable[[float], object] | None = None,
) -> dict[str, np.ndarray]:
    """Run an SSP file in Ecos.

    Args:
        path: The SSP file.
        columns: Real outputs to read, as `component.output`.
        step: Communication step [s].
        until: End [s].
        progress: Called with the time [s] after each step.

    Returns:
        `time` and the columns, as `master.simulate` returns them.

    Raises:
        FileNotFoundError: Ecos or its libtbb is not installed.
    """
    # the wheel `tbb` puts libtbb where the loader does not look; once loaded, it is found by its
    # name
    libtbb = Path(sys.prefix) / "lib" / "libtbb.so.12"
    if not (libtbb.is_file() and find_spec("ecospy")):
        raise FileNotFoundError(
            'Ecos or its libtbb is missing; install both with pip install "rlv-landing[cosim]"'
        )
    ctypes.CDLL(str(libtbb), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation

    simulation = EcosSimulation(ssp_path=str(path), step_size=step)
    simulation.init(parameter_set=PARAMETER_SET)
    names = ["::".join(column.split(".", 1)) for column in columns]
    time, rows = 0.0, []
    for k in range(round(until / step) + 1):
        if k > 0:
            time = simulation.step()
        rows.append([time, *(simulation.get_real(name) for name in names)])
        if progress is not None:
            progress(time)
    simulation.terminate()
    return dict(zip(["time", *columns], np.array(rows).T))
