"""The origins of a search's values: the text of its TOML file, and each value's source."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from .. import __version__
from ..parameters import GROUPS, Parameters
from ..presets import DEFAULT_PRESET, to_toml
from ..text.files import parse_document, read_text, toml_text
from .search_folder import Best


def with_origins(
    parameters: Parameters, preset: str | None, file: str | None, changed: Collection[str]
) -> Parameters:
    """The parameters with sources that say where each value comes from.

    They are `--set`, the file's name, or the source that the preset gives and the preset's name;
    the same for a source that the file states. One that names a place already stays.

    Args:
        parameters: The parameters chosen.
        preset: The preset's name; None: the file's, or the default.
        file: The TOML file; None without one.
        changed: The names that were changed since.
    """
    written: set[str | tuple[str, str]] = set()
    base, place = preset or DEFAULT_PRESET, ""
    if file is not None:
        path = Path(file)
        document = parse_document(read_text(path, "parameter file"), str(path))
        base, place = document.get("preset", DEFAULT_PRESET), path.name
        written.update(f"{g}.{what}" for g in GROUPS for what in document.get(g, {}))
        for mode, tables in document.get("mode", {}).items():
            written.update((mode, f"{g}.{what}") for g in tables for what in tables[g])

    def origin(source: str, *keys: str | tuple[str, str]) -> str:
        of_file = any(key in written for key in keys)
        if of_file and source == "user":
            return place
        return source if ", " in source else f"{source}, {place if of_file else base}"

    mode = parameters.drop.mode
    sources: dict[str | tuple[str, str], str] = {
        name: "--set" if name in changed else origin(parameters.source(name), name, (mode, name))
        for name, _ in parameters.items()
    }
    for own_mode, own in parameters.by_mode.items():
        for name in own:
            key = (own_mode, name)
            sources[key] = origin(parameters.source(name, own_mode), key)
    return replace(parameters, sources=sources)


def identified_toml(parameters: Parameters, best: Best, arguments: Sequence[str]) -> str:
    """The TOML text of the best point, headed by the command that made it.

    Args:
        parameters: The parameters of the best point.
        best: The best point.
        arguments: The command's arguments, `identify` first.
    """
    command = toml_text(shlex.join(["rlv-landing", *arguments]))[1:-1].replace('\\"', '"')
    return (
        f"# Written by rlv-landing {__version__}:\n# {command}\n"
        f"# Loss {best.start_loss:.6g} at the start, {best.loss:.6g} here, after "
        f"{best.evaluations} evaluations.\n"
        "# Values of source identified are this search's; others keep the source before it, and "
        "the file or preset that gave it.\n\n"
    ) + to_toml(parameters)
