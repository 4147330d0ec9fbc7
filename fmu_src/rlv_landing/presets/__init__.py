"""The presets, and parameters read from and written to TOML."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import LandingError, first_of, unknown
from ..parameters import GROUPS, PARAMETER_QUANTITIES, Parameters, groups_of_a_leg
from ..quantities import MODES
from ..text.files import parse_document, read_text, toml_table, toml_text
from ..text.listed import parse_parameter

FOLDER = Path(__file__).parent
DEFAULT_PRESET = "yue2022-figures"
# parameters that a complete file may leave out: they say nothing of a vehicle, or of one that has
# nothing of the kind
NOT_OF_A_VEHICLE = {
    *(name for name in PARAMETER_QUANTITIES if name.startswith(("solver.", "sea."))),
    *(name for name, q in PARAMETER_QUANTITIES.items() if q.kind == "string" and not q.choices),
    *("ground.step", "leg.kind", "auxiliary_strut.joint_spread"),
    *("ground.roughness", "ground.roughness_length", "ground.terrain_seed"),
}
OVERRIDES = "vehicle.leg_overrides"
# the table of what all legs have alike, and of single legs' tables by number
LEG = "leg"
ALIKE = {name.split(".")[1] for name in PARAMETER_QUANTITIES if name.startswith(f"{LEG}.")}


def preset_names() -> list[str]:
    """The names of the presets that come with the package."""
    return sorted(p.stem for p in FOLDER.glob("*.toml"))


def load_preset(name: str, mode: str | None = None) -> Parameters:
    """The parameters of a preset, for the landing `mode` (default: the preset's own).

    Raises:
        LandingError: The name is unknown.
    """
    if name not in preset_names():
        raise unknown("preset", name, preset_names())
    parameters = read_toml(FOLDER / f"{name}.toml")
    return parameters.for_mode(mode if mode is not None else parameters.drop.mode)


def read_toml(path: str | Path) -> Parameters:
    """Parameters from a TOML file.

    Its tables are `vehicle`, `leg`, `main_strut`, `auxiliary_strut`, `ground` and `drop`,
    `mode.X.drop` for one mode only, and `leg.N.main_strut`, `leg.N.ground` ... for one leg only. A
    value is a number in SI units, a text with a unit ("-2 deg"), or
    `{ value = ..., source = "..." }`. Other values come from `preset = "..."` (default
    yue2022-figures). With `complete = true` there may be none: every parameter of the vehicle, the
    ground and the drop must be in the file.

    Raises:
        LandingError: The file is missing, its TOML syntax is wrong (with line), or names or values
            are.
    """
    path = Path(path)
    missing = f"there is no parameter file {path}; presets are {', '.join(preset_names())}"
    return parse_toml(read_text(path, "parameter file", missing), str(path), path.parent)


def parse_toml(text: str, name: str, folder: Path | None = None) -> Parameters:
    """Parameters from a TOML text, as `read_toml`; errors name it `name`.

    Names of files in it start from the `folder`; None: the present one.
    """
    document = parse_document(text, name)
    try:
        return parameters_of_document(document, folder)
    except LandingError as e:
        raise LandingError(f"{name}: {e}") from None


def parameters_of_document(document: dict[str, Any], folder: Path | None = None) -> Parameters:
    """Parameters from a TOML document, as `read_toml`.

    Names of files in it start from the `folder`; None: the present one.

    Raises:
        LandingError: Names or values are wrong.
    """
    known = ("preset", "complete", "mode", *GROUPS)
    for key in document:
        if key not in known:
            raise unknown("table", key, known)
    base = document.get("preset")
    parameters = load_preset(base) if base is not None else Parameters()
    values, sources = _flat(_of_all(document), folder=folder)
    _check_complete(document, values)
    own_values, own_sources = _of_legs(document)
    parameters = parameters.with_values({**values, **own_values}, {**sources, **own_sources})
    for mode, tables in toml_table(document.get("mode", {}), "mode").items():
        if mode not in MODES:
            raise unknown("landing mode", mode, MODES)
        own, own_sources = _flat(toml_table(tables, f"mode.{mode}"))
        parameters = parameters.with_mode_values({mode: own}, own_sources)
    return parameters.for_mode(parameters.drop.mode)


def _check_complete(document: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    complete = document.get("complete", False)
    if not isinstance(complete, bool):
        raise LandingError(f"complete = {complete!r} is neither true nor false")
    if complete and "preset" in document:
        raise LandingError(
            "complete = true leaves nothing to take from a preset; delete one of the two"
        )
    missing = [
        name for name in PARAMETER_QUANTITIES if name not in values and name not in NOT_OF_A_VEHICLE
    ]
    if complete and missing:
        raise LandingError(
            f"complete = true, but {len(missing)} missing: {first_of(missing)}; give a value, or "
            "delete complete = true to take the rest from preset = ..."
        )


def _of_all(document: Mapping[str, Any]) -> dict[str, Any]:
    """The tables by group, without what single legs have for themselves."""
    tables = {group: table for group, table in document.items() if group in GROUPS}
    if LEG in tables:
        leg = toml_table(tables[LEG], LEG)
        tables[LEG] = {what: entry for what, entry in leg.items() if what in ALIKE}
    return tables


def _of_legs(document: Mapping[str, Any]) -> tuple[dict[str, float | str], dict[str, str]]:
    """What single legs have for themselves, from the tables `leg.N.GROUP`."""
    values: dict[str, float | str] = {}
    sources: dict[str, str] = {}
    for number, tables in toml_table(document.get(LEG, {}), LEG).items():
        if number in ALIKE:
            continue
        own = toml_table(tables, f"leg.{number}")
        if not number.isdecimal():
            raise LandingError(
                f"table leg.{number} has no leg's number; write for example [leg.2.ground]"
            )
        found = _flat(own, f"leg[{int(number)}].")
        values.update(found[0])
        sources.update(found[1])
    return values, sources


def _flat(
    tables: Mapping[str, Any], of: str = "", folder: Path | None = None
) -> tuple[dict[str, float | str], dict[str, str]]:
    """Values and sources by name, from tables by group.

    `of` is put before each name; names of files start from the `folder`.
    """
    values: dict[str, float | str] = {}
    sources: dict[str, str] = {}
    groups = groups_of_a_leg() if of else tuple(GROUPS)
    for group, table in tables.items():
        if group not in groups:
            raise unknown("table", f"{of}{group}", [f"{of}{g}" for g in groups])
        for what, entry in toml_table(table, group).items():
            name = f"{of}{group}.{what}"
            if name not in PARAMETER_QUANTITIES:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
            if isinstance(entry, dict):
                for key in entry:
                    if key not in ("value", "source"):
                        raise unknown(f"key of {name}", key, ("value", "source"))
                if "value" not in entry:
                    raise LandingError(
                        f'{name} has no value: write {{ value = ..., source = "..." }}'
                    )
                if "source" in entry:
                    sources[name] = str(entry["source"])
                entry = entry["value"]
            values[name] = parse_parameter(PARAMETER_QUANTITIES[name], entry, folder)
    return values, sources


def origins(path: str | Path | None, preset: str | None, mode: str) -> dict[str, str]:
    """Where each parameter's value comes from: a file, a preset, or the table of defaults.

    Args:
        path: A parameter file.
        preset: A preset, where there is no file; None is the default one.
        mode: The landing mode, whose own values win.

    Raises:
        LandingError: As `read_toml`.
    """
    found = dict.fromkeys(PARAMETER_QUANTITIES, f"default, as of {DEFAULT_PRESET}")
    layers: list[tuple[dict[str, Any], str]] = []
    if path is not None:
        document = parse_document(read_text(Path(path), "parameter file", ""), str(path))
        preset = document.get("preset")
        layers.append((document, str(path)))
    else:
        preset = preset or DEFAULT_PRESET
    if preset is not None:
        file = FOLDER / f"{preset}.toml"
        layers.insert(
            0, (parse_document(read_text(file, "preset", ""), preset), f"preset {preset}")
        )
    for tables, origin in layers:
        folder = Path(path).parent if path is not None else None
        plain, _ = _flat(_of_all(tables), folder=folder)
        of_mode, _ = _flat(tables.get("mode", {}).get(mode, {}))
        found.update(dict.fromkeys(plain, origin))
        if any(what not in ALIKE for what in tables.get(LEG, {})):
            found[OVERRIDES] = origin
        found.update(dict.fromkeys(of_mode, f"{origin}, mode {mode}"))
    return found


def to_toml(parameters: Parameters, *, comments: bool = True) -> str:
    """The parameters as a TOML text that `read_toml` reads back to the same digits.

    Values that belong to one landing mode (of the drop) follow in tables of their own. The text
    is ASCII: other characters of a source are escaped.

    Args:
        parameters: The parameters.
        comments: Whether each line has meaning, bounds and unit as a comment.
    """
    lines: list[str] = []
    group = ""
    of_legs = parameters.overrides
    # they have tables of their own
    listed = [(name, v) for name, v in parameters.items() if name != OVERRIDES or not of_legs]
    for name, value in [*listed, *of_legs.items()]:
        q = PARAMETER_QUANTITIES[name]
        owner, what = name.rsplit(".", 1)
        if owner != group:
            lines += ([""] if lines else []) + [f"[{owner.replace('[', '.').replace(']', '')}]"]
            group = owner
        written = f'"{value}"' if isinstance(value, str) else repr(value)
        about = f"[{q.lo:g}, {q.hi:g}] {q.unit}".rstrip()
        if q.kind == "string":
            about = " or ".join(q.choices) or "a text"
        source = toml_text(parameters.source(name))
        comment = f"  # {q.meaning}; {about}; {source[1:-1]}" if comments else ""
        lines.append(f"{what} = {{ value = {written}, source = {source} }}{comment}")
    for mode, own in parameters.by_mode.items():
        lines += ["", f"[mode.{mode}.drop]"] if own else []
        for name, value in own.items():
            source = toml_text(parameters.source(name, mode))
            lines.append(f"{name.split('.')[1]} = {{ value = {value!r}, source = {source} }}")
    return "\n".join(lines) + "\n"
