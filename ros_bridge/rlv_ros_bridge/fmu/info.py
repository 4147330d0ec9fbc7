"""What is in an FMU: ours with its vehicle, any other as far as FMPy reads it."""

from __future__ import annotations

import re
import zipfile
from dataclasses import asdict, dataclass, field
from math import degrees
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError, one_line
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import SPACE
from rlv_landing.tables.rendering import new_table, render
from rlv_landing.touchdown import footpad_at_rest

from .description import is_ours, open_description, vehicle_of

# our compiled cores in the FMU
CORE = re.compile(r"resources/[^/]+/core/(?:compiled_for/)?((?:[^/]+/)?compiled\.[^/]+)")
BINARY = re.compile(r"binaries/([^/]+)/[^/]+\.(?:so|dll|dylib)")
LONGEST_START = 40
KINDS = {"coSimulation": "co-simulation", "modelExchange": "model exchange"}


@dataclass(frozen=True)
class Variable:
    """A variable of the description; its start as text, empty where it has none.

    An array's type has its extents: `Float64[4]`.
    """

    name: str
    causality: str
    type: str
    unit: str
    start: str
    description: str


@dataclass(frozen=True)
class FmuInfo:
    """What is in an FMU.

    Attributes:
        path: The file.
        size: Its size [bytes].
        ours: Whether it is of this model.
        facts: What the description says of the model, by name.
        kinds: The kinds of simulation that it is for.
        platforms: The platforms that it has a binary for, by FMI's names.
        cores: Our compiled cores in it.
        vehicle: The vehicle of ours, by name with unit.
        variables: All variables.
    """

    path: str
    size: int
    ours: bool
    facts: dict[str, str]
    kinds: list[str]
    platforms: list[str]
    cores: list[str]
    vehicle: dict[str, float | str] = field(default_factory=dict)
    variables: list[Variable] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """All of it, for JSON."""
        return asdict(self)

    def text(self) -> str:
        """All of it, for people."""
        lines = [f"{self.path}: {self.size / 1e3:.0f} kB"]
        lines += [f"  {name:<12} {text}" for name, text in self.facts.items() if text]
        lines.append(f"  {'for':<12} {', '.join(self.kinds)}")
        lines.append(f"  {'platforms':<12} {', '.join(self.platforms) or 'none: it has no binary'}")
        if self.ours:
            lines.append(f"  {'core':<12} {', '.join(self.cores) or 'not compiled'}")
            lines += ["", "vehicle"]
            lines += [
                f"  {name:<38} {value if isinstance(value, str) else f'{value:.6g}'}"
                for name, value in self.vehicle.items()
            ]
        table = new_table(
            f"{len(self.variables)} variables",
            ("name", "causality", "type", "unit"),
            ("start",),
            ("meaning",),
        )
        for v in self.variables:
            name = v.name.replace("[", r"\[")
            description = v.description.replace("[", r"\[")
            # of a height field's text its ends
            start = one_line(v.start, LONGEST_START).replace("[", r"\[")
            table.add_row(name, v.causality, v.type, v.unit, start, description)
        return "\n".join(lines) + "\n\n" + render(table, 180)


def fmu_info(path: Path) -> FmuInfo:
    """What is in the FMU at `path`.

    Raises:
        LandingError: no such file, not an FMU, or FMPy is missing.
    """
    description = open_description(path)
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
    ours = is_ours(description)
    return FmuInfo(
        path=str(path),
        size=path.stat().st_size,
        ours=ours,
        facts={
            "model": description.modelName,
            "about": description.description or "",
            "version": description.version or "",
            "FMI": description.fmiVersion,
            "GUID": description.guid,
            "made by": description.generationTool or "",
            "made at": str(description.generationDateAndTime or ""),
            "licence": description.license or "",
        },
        kinds=[text for kind, text in KINDS.items() if getattr(description, kind, None)],
        platforms=sorted({m[1] for name in names if (m := BINARY.fullmatch(name))}),
        cores=sorted({m[1] for name in names if (m := CORE.fullmatch(name))}) if ours else [],
        vehicle=_vehicle(_vehicle_at(description, path)) if ours else {},
        variables=[
            Variable(
                v.name,
                v.causality or "",
                v.type + "".join(f"[{_extent(d)}]" for d in v.dimensions or ()),
                v.unit or "",
                _short(v.type, v.start),
                v.description or "",
            )
            for v in description.modelVariables
        ],
    )


def _vehicle_at(description: Any, path: Path) -> Parameters:
    """The vehicle of our FMU at `path`.

    Raises:
        LandingError: A value is not one of this version's.
    """
    try:
        return vehicle_of(description)
    except LandingError as e:
        raise LandingError(f"the vehicle of {path}: {e}") from None


def _extent(dimension: Any) -> str:
    """The extent of an array: its number, or the structural parameter that has it."""
    return str(dimension.variable.name if dimension.start is None else dimension.start)


def _short(kind: str, start: Any) -> str:
    """A start value as text; a number with at most nine digits."""
    if start is None:
        return ""
    try:
        return f"{float(start):.9g}" if kind in ("Real", "Float64", "Float32") else str(start)
    except ValueError:
        return str(start)


def _vehicle(p: Parameters) -> dict[str, float | str]:
    radius, height = footpad_at_rest(p)
    return {
        "mass with footpads [kg]": p.whole_mass,
        "pitch inertia of the body [kg.m2]": p.vehicle.inertia,
        "footpads' radius, legs extended [m]": radius,
        "CG above the footpads [m]": -height,
        "stroke of the dampers [mm]": 1e3 * p.main_strut.stroke_max,
        "ground friction": p.ground.friction,
        "landing mode": p.drop.mode,
        "first contact at [s]": p.drop.contact_time,
        "vertical velocity then [m/s]": p.drop.vertical_velocity,
        "horizontal velocity then [m/s]": p.drop.horizontal_velocity,
        "tilt then [deg]": degrees(p.drop.tilt),
        "pitch rate then [deg/s]": degrees(p.drop.pitch_rate),
        **(_in_space(p) if p.drop.mode == SPACE else {}),
    }


def _in_space(p: Parameters) -> dict[str, float | str]:
    return {
        "legs": p.vehicle.legs,
        "heading then [deg]": degrees(p.drop.heading),
        "roll then [deg]": degrees(p.drop.roll),
        "velocity across then [m/s]": p.drop.lateral_velocity,
        "roll rate then [deg/s]": degrees(p.drop.roll_rate),
        "yaw rate then [deg/s]": degrees(p.drop.yaw_rate),
    }
