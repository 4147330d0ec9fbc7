"""The files of a new vehicle: its parameters, a study, an envelope, and what to do next."""

from __future__ import annotations

import re
from math import hypot, sqrt
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from ..parameters import Parameters
from ..presets import load_preset, to_toml
from ..touchdown import footpad_at_rest
from .damper import Damper, size_damper
from .leg_geometry import leg_geometry
from .needs import NEEDS, Needs
from .vehicle import size_vehicle

TEMPLATES = Path(__file__).with_name("templates")
PROTOTYPE = "prototype"
# a limit for the study of the prototype: above its drop tests' peaks [N]
PROTOTYPE_FORCE = 12e3


def sized_project(name: str, needs: Needs) -> dict[str, str]:
    """The texts of a sized vehicle's files, by file name.

    Raises:
        LandingError: No legs do what the `needs` ask for.
    """
    parameters = size_vehicle(needs)
    damper = size_damper(needs, leg_geometry(needs))
    said = [f"#   {n} = {getattr(needs, n):g} {q.unit}".rstrip() for n, q in NEEDS.items()]
    head = [
        f"# {name}: sized from what its maker said:",
        *said,
        "# The rules are those of `rlv-landing new --help` and docs/own_vehicle.md.",
    ]
    return _project(name, parameters, head, _about(needs, damper), damper.force)


def prototype_project(name: str) -> dict[str, str]:
    """The texts of the files of the paper's drop-test vehicle, by file name."""
    parameters = load_preset("yue2022-figures")
    head = [f"# {name}: the drop-test vehicle of Yue, Lin, Zheng and Du (2022), as identified."]
    about = "The drop-test vehicle of Yue, Lin, Zheng and Du (2022), its parameters as identified."
    return _project(name, parameters, head, about, PROTOTYPE_FORCE)


def _project(
    name: str, parameters: Parameters, head: list[str], about: str, force: float
) -> dict[str, str]:
    templates = Environment(
        loader=FileSystemLoader(TEMPLATES),
        undefined=StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,
    )
    values = {
        "name": name,
        "model": model_name(name),
        "about": about,
        **_studied(parameters, force),
    }
    files = {
        path.name.removesuffix(".j2"): templates.get_template(path.name).render(values)
        for path in sorted(TEMPLATES.glob("*.j2"))
    }
    return {"vehicle.toml": "\n".join([*head, "complete = true", "", to_toml(parameters)]), **files}


def model_name(name: str) -> str:
    """The name as an FMU's model identifier: letters, digits and underscores."""
    return re.sub(r"\W", "_", name, flags=re.ASCII).strip("_").lstrip("0123456789_") or "Vehicle"


def _about(needs: Needs, damper: Damper) -> str:
    return (
        f"Sized for {needs.sink_speed:g} m/s of sink speed at {needs.load_factor:g} times the "
        f"weight, all legs at once: the footpads travel {1e3 * damper.travel:.3g} mm, the main "
        f"struts {1e3 * damper.stroke:.3g} mm of {1e3 * damper.stroke_max:.3g} mm, and bear at "
        f"most {1e-3 * damper.force:.3g} kN."
    )


def _studied(parameters: Parameters, force: float) -> dict[str, Any]:
    """Round numbers of this vehicle's size for its study and envelope."""
    drop, ground = parameters.drop, parameters.ground
    sink = -drop.vertical_velocity
    radius, height = footpad_at_rest(parameters)
    # a rigid block on the feet of 2-2 that trips at this speed just lifts its CG over them
    depth, arm = -height, hypot(sqrt(0.5) * radius, height)
    trips = sqrt(2.0 * ground.gravity * (arm - depth)) * arm / depth
    return {
        "fastest": rounded(-1.2 * sink),
        "slowest": rounded(-0.5 * sink),
        "sideways": rounded(0.2 * sink),
        "topple": rounded(2.0 * trips),
        "tolerance": rounded(0.04 * trips),
        "force": rounded(force),
        "stroke": rounded(1e3 * parameters.main_strut.stroke_max),
    }


def rounded(value: float) -> float:
    """The value with two significant digits."""
    return float(f"{value:.2g}")
