"""`rlv-landing envelope`: the landing-stability boundary in two quantities."""

from __future__ import annotations

import json
import signal
import sys
from pathlib import Path
from typing import Any

import click

from ..errors import LandingError
from .options import check_writable, parameter_options

NO_BOUNDARY, INTERRUPTED = 1, 130
STUDY = click.Path(path_type=Path)


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("study", metavar="[STUDY.toml]", required=False, type=STUDY)
@parameter_options
@click.option(
    "--x",
    "x_axis",
    metavar="NAME=LOW..HIGH",
    help='Horizontal axis: drop.horizontal_velocity=-6..6, or with units: "0 deg..10 deg".',
)
@click.option("--y", "y_axis", metavar="NAME=LOW..HIGH", help="Vertical axis.")
@click.option(
    "--tolerance",
    "tolerances",
    metavar="NAME=VALUE",
    multiple=True,
    help="How well to know an axis [default: 1/128 of it]. Repeat.",
)
@click.option(
    "--family",
    "families",
    metavar="NAME=V1,V2,...",
    multiple=True,
    help='A boundary each: ground.slope="0 deg,5 deg". Repeat.',
)
@click.option(
    "--limit",
    "limits",
    metavar="NAME=VALUE",
    multiple=True,
    help='A load limit: main_strut.force="20 kN". Repeat.',
)
@click.option(
    "--input",
    "inputs",
    metavar="NAME=VALUE",
    multiple=True,
    help="A constant input: external.force_x=500. Repeat.",
)
@click.option(
    "--criterion",
    metavar="NAME",
    help="What is lost: toppled (default), bottomed out, slid, or limit (any limit passed).",
)
@click.option("--cells", type=int, metavar="N", help="Coarse cells along each axis [default: 8].")
@click.option(
    "--levels",
    type=int,
    metavar="N",
    help="How often cells on the boundary are halved [default: 2].",
)
@click.option(
    "--until",
    type=float,
    metavar="S",
    help="When a landing is given up that neither rests nor topples [default: 6].",
)
@click.option(
    "--work",
    type=click.Path(path_type=Path),
    default=Path("envelope"),
    show_default=True,
    help="Folder for landings and results.",
)
@click.option("--resume", is_flag=True, help="Go on with the landings in --work.")
@click.option("--workers", type=click.IntRange(1), help="Threads [default: all cores].")
@click.option(
    "--plot",
    metavar="FILE.png|.svg",
    type=click.Path(path_type=Path),
    help="Draw boundaries, landings and critical conditions.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the whole result as JSON.")
@click.option("--force", is_flag=True, help="Overwrite a picture that exists.")
def envelope(
    study: Path | None, preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...], inputs: tuple[str, ...],
    work: Path, resume: bool, workers: int | None, plot: Path | None, as_json: bool, force: bool, **options: Any,
) -> None:  # fmt: skip
    """Find where landings turn from stable to lost, in two quantities, for every family, with what
    is critical along that boundary.

    Coarse cells are halved where their corners differ, then the edges that the boundary crosses, to
    the tolerance of each axis; an island that lies within one coarse cell is not seen (--cells).
    Writes boundary.csv, boundary.json and landings.jsonl to the folder --work, which also lets
    --resume go on after Ctrl-C. Axes are parameters or inputs; a landing starts at its first
    contact. Options win over the study's file.

    \b
    rlv-landing envelope examples/envelope.toml --plot envelope.png
    rlv-landing envelope --x drop.horizontal_velocity=-6..6 --y "drop.tilt=-15 deg..15 deg" --family ground.friction=0.3,0.6

    Exit codes: 0 done, 1 no family has a boundary in the range (all stable or all lost), 2 bad
        input, 130 interrupted.
    """
    from tqdm import tqdm

    from ..figures.envelope_figure import save_envelope
    from ..studies import toml_keys
    from ..studies.envelope.results import record, write_csv, write_json
    from ..studies.envelope.search import envelope as run
    from ..studies.envelope.store import Store
    from ..studies.envelope.study import study_from
    from ..tables.envelope_tables import envelope_tables
    from ..workers import default_workers

    check_writable(plot, ".svg" if plot is not None and plot.suffix == ".svg" else ".png", force)
    document = toml_keys.read(study)[0] if study is not None else {}
    top = {
        "preset": preset,
        "parameters": None if file is None else str(Path(file).resolve()),
        "mode": mode,
    }
    top |= {key: options[key] for key in ("criterion", "cells", "levels", "until")}
    _override(
        document,
        top,
        (*pairs, *inputs),
        **{key: options[key] for key in ("x_axis", "y_axis", "tolerances", "families", "limits")},
    )
    asked = study_from(document, study.parent if study is not None else Path())
    try:
        work.mkdir(parents=True, exist_ok=True)
        store = Store(asked, work / "landings.jsonl", resume)
    except OSError as e:
        raise LandingError(f"{e.filename or work} cannot be written: {e.strerror or e}") from None
    # SIGTERM ends as Ctrl-C does: with everything written
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with tqdm(initial=len(store.found), unit="landing", disable=not sys.stderr.isatty()) as bar:

            def tell(family: int, count: int) -> None:
                bar.set_description_str(
                    f"family {family + 1} of {len(asked.families)}", refresh=False
                )
                bar.update(count - bar.n)

            found = run(asked, workers or default_workers(), store, tell)
    except KeyboardInterrupt:
        click.echo(
            f"interrupted; {len(store.found)} landings are kept in {work}, --resume goes on",
            err=True,
        )
        sys.exit(INTERRUPTED)
    finally:
        store.close()
    try:
        write_csv(found, work / "boundary.csv")
        write_json(found, work / "boundary.json")
        if plot is not None:
            save_envelope(found, plot)
    except OSError as e:
        raise LandingError(f"{e.filename or plot} cannot be written: {e.strerror or e}") from None
    click.echo(
        json.dumps(record(found), indent=1, allow_nan=False) if as_json else envelope_tables(found),
        nl=as_json,
    )
    if not any(f.lines for f in found.families):
        click.echo("error: no family has a boundary in this range; widen the axes", err=True)
        sys.exit(NO_BOUNDARY)


def _override(
    document: dict[str, Any], top: dict[str, Any], pairs: tuple[str, ...], **options: Any
) -> None:
    """Put what the options say in the place of what the study's document says."""
    told = document.setdefault("envelope", {})
    if top["preset"] is not None or top["parameters"] is not None:
        told.pop("preset", None)
        told.pop("parameters", None)
    told.update({key: value for key, value in top.items() if value is not None})
    document.setdefault("set", {}).update(map(_pair, pairs))
    document.setdefault("limits", {}).update(map(_pair, options["limits"]))
    if options["families"]:
        document["families"] = {
            name: [v.strip() for v in values.split(",")]
            for name, values in map(_pair, options["families"])
        }
    for key in ("x", "y"):
        if options[f"{key}_axis"] is not None:
            name, values = _pair(options[f"{key}_axis"])
            low, dots, high = values.partition("..")
            if not dots:
                raise LandingError(
                    f'--{key} {options[f"{key}_axis"]}: write NAME=LOW..HIGH, for example drop.tilt="-10 deg..10 deg"'
                )
            document[key] = {"name": name, "low": low.strip(), "high": high.strip()}
    for name, value in map(_pair, options["tolerances"]):
        axes = [document[key] for key in ("x", "y") if document.get(key, {}).get("name") == name]
        if not axes:
            raise LandingError(f"--tolerance {name}={value}: {name} is not an axis")
        axes[0]["tolerance"] = value


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals:
        raise LandingError(f"{text!r} has no '='; write NAME=VALUE")
    return name.strip(), value.strip()
