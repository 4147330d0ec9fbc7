"""The FMU's documentation: documentation/index.html, licences, changelog and the icon model.png."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable
from dataclasses import replace
from importlib.metadata import distribution
from pathlib import Path
from typing import Any, cast
from xml.etree.ElementTree import Element

from jinja2 import Environment, StrictUndefined
from latex2mathml.converter import convert
from markupsafe import Markup

from rlv_landing import __version__
from rlv_landing.errors import one_line
from rlv_landing.figures.plots import inline_svg
from rlv_landing.figures.style import page_css
from rlv_landing.landing import LOOSEST_RTOL
from rlv_landing.quantities import STATISTIC_QUANTITIES, Quantity, flat_name, whole_name

from ..binary import compilers
from ..dependencies import dependencies_of
from ..fmi3.arrays import whole_meaning
from ..sources import source
from ..targets import tried
from ..wanted import COUNTS, Wanted
from .drawing import vehicle_figure

TEMPLATE = Path(__file__).with_name("documentation.html.j2")
LICENCE_OF = "pythonfmu"
DOTS_PER_INCH = 100
# what the tables say of the legs, by the version of FMI
OF_LEGS = {2: "leg[1] stands for every leg", 3: "[N]: arrays with an element for each leg"}


def write_documentation(files: Path, description: Element, wanted: Wanted) -> None:
    """Write documentation, licences, changelog and icon.

    Args:
        files: Folder of the unpacked FMU.
        description: Root of its modelDescription.xml.
        wanted: The vehicle, and the names of its variables.
    """
    documentation = files / "documentation"
    licences = documentation / "licenses"
    licences.mkdir(parents=True)
    vehicle_figure(wanted.parameters).savefig(
        files / "model.png", dpi=DOTS_PER_INCH, metadata={"Software": None}
    )
    shutil.copyfile(source("CHANGELOG.md"), documentation / "CHANGELOG.md")
    shutil.copyfile(source("LICENSE"), licences / "LICENSE")
    (licences / f"{LICENCE_OF}-LICENSE").write_text(licence_text(LICENCE_OF), encoding="utf-8")
    (documentation / "index.html").write_text(render(files, description, wanted), encoding="utf-8")


def licence_text(package: str) -> str:
    """Text of an installed package's licence, from its metadata.

    Raises:
        SystemExit: The installed package has no licence file.
    """
    for path in distribution(package).files or ():
        if path.name.upper().startswith("LICENSE") and ".dist-info" in path.parts[0]:
            return path.read_text(encoding="utf-8")
    raise SystemExit(
        f"error: the installed {package} has no licence text, which the FMU must contain; "
        "install it from PyPI"
    )


def render(files: Path, description: Element, wanted: Wanted) -> str:
    """The documentation page: self-contained HTML that is well-formed XML, too."""
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["math"] = lambda latex: Markup(convert(latex, display="block"))
    experiment = description.find("DefaultExperiment")
    simulation = description.find("CoSimulation")
    assert experiment is not None
    assert simulation is not None
    named = flat_name if wanted.flat_names else str
    fmi = int(description.attrib["fmiVersion"][0])
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        css=Markup(page_css()),
        version=__version__,
        wanted=wanted,
        named=named,
        loosest=LOOSEST_RTOL,
        in_space=wanted.interface.in_space,
        legs=COUNTS[len(wanted.interface.legs)],
        model=description.attrib,
        fmi=fmi,
        identity=description.get("guid") or description.get("instantiationToken"),
        experiment=experiment.attrib,
        capabilities=simulation.attrib,
        cores=sorted(p.name for p in files.glob("resources/*/core/compiled.*")),
        cores_of_others=sorted(
            p.parent.name for p in files.glob("resources/*/core/compiled_for/*/compiled.*")
        ),
        platforms={name: tried(name) for name in compilers(wanted.platforms, wanted.fmi)},
        drawing=Markup(
            inline_svg(
                vehicle_figure(wanted.parameters, named=True),
                "vehicle",
                f"The vehicle on its {COUNTS[len(wanted.interface.legs)]} legs",
            )
        ),
        pythonfmu=distribution("pythonfmu").version,
        tables=tables(wanted, fmi, named("leg[1]")),
    )


# identifier, heading, note and rows of a table of variables
Table = tuple[str, str, str, list[dict[str, str]]]


def tables(wanted: Wanted, fmi: int, first_leg: str) -> list[Table]:
    """The tables of variables.

    Args:
        wanted: The FMU, whose vehicle's values are the start values.
        fmi: The version of FMI.
        first_leg: The name of leg 1 in names of variables.
    """
    interface = wanted.interface
    legs = len(interface.legs)
    of_legs = OF_LEGS[fmi].replace("leg[1]", first_leg).replace("N", str(legs))
    outputs = rows(of_one_leg(interface.outputs), legs if fmi == 3 else 0)
    known_of = dependencies_of(interface)
    for row, q in zip(outputs, of_one_leg(interface.outputs)):
        row["at_once"] = " ".join(sorted(known_of.inputs(q.name)))
    return [
        (
            "parameters",
            "Parameters",
            "fixed; set them before or in initialization mode",
            rows(starts_of(wanted)),
        ),
        ("inputs", "Inputs", "continuous; 0 by default", rows(interface.inputs)),
        ("outputs", "Outputs", f"calculated; {of_legs}, numbered as drawn", outputs),
        (
            "statistics",
            "Statistics",
            "local; counts of the integrator, and whether the core is compiled",
            rows(STATISTIC_QUANTITIES),
        ),
        (
            "peaks",
            "Peaks",
            f"local; extremes since the start, between steps too; {of_legs}",
            rows(of_one_leg(interface.peak_quantities, "peak."), legs if fmi == 3 else 0),
        ),
    ]


def starts_of(wanted: Wanted) -> list[Quantity]:
    """The parameters' quantities with the vehicle's values for defaults, and their sources."""
    own = wanted.parameters
    return [
        # a file may name any source
        replace(q, default=own[name], source=cast(Any, one_line(own.source(name))))
        for name, q in wanted.table.items()
    ]


def of_one_leg(quantities: Iterable[Quantity], before: str = "") -> list[Quantity]:
    """The quantities without those of later legs, which differ from leg 1's in their names alone.

    Args:
        quantities: The quantities.
        before: What their names begin with.
    """
    return [
        q
        for q in quantities
        if not q.name.startswith(f"{before}leg[") or q.name.startswith(f"{before}leg[1].")
    ]


def names(q: Quantity, elements: int) -> dict[str, str]:
    """Name, size and meaning of a quantity, or of the array of so many `elements` it begins."""
    whole = whole_name(q.name)
    if elements and whole != q.name:
        return {"name": whole, "size": f"[{elements}]", "meaning": whole_meaning(q.meaning)}
    return {"name": q.name, "size": "", "meaning": q.meaning}


def rows(quantities: Iterable[Quantity], elements: int = 0) -> list[dict[str, str]]:
    """One table row per quantity, all as text; bounds and default in its SI unit.

    Args:
        quantities: The quantities.
        elements: Elements of the legs' arrays, 0 where each leg has its own variables.
    """
    return [
        {
            **names(q, elements),
            "unit": q.unit or ("1" if q.kind == "real" else ""),
            "shown": q.display_unit,
            "type": q.kind.capitalize(),
            "start": q.default if isinstance(q.default, str) else f"{q.default:.6g}",
            "bounds": " | ".join(q.choices) or _bounds(q),
            "nominal": f"{q.nominal:g}" if q.kind == "real" else "",
            "source": q.source,
            "at_once": "",
        }
        for q in quantities
    ]


def _bounds(q: Quantity) -> str:
    """Text of the finite bounds; empty if there are none."""
    if math.isfinite(q.lo) and math.isfinite(q.hi):
        return f"{q.lo:g} ... {q.hi:g}"
    if math.isfinite(q.lo):
        return f"at least {q.lo:g}"
    return f"at most {q.hi:g}" if math.isfinite(q.hi) else ""
