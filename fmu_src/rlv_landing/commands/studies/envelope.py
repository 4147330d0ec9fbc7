"""`rlv-landing envelope`: the landing-stability boundary in two quantities."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from ...choices import parse_pairs, split_pair
from ...errors import LandingError, one_line
from ...signals.interrupts import answer
from ...text.durable import ANOTHER_WORK, refuse_no_files, unwritable, writing
from ..number_types import Number, WholeNumber
from ..options import (
    HELP_NAMES,
    PICTURES,
    check_writable,
    force_option,
    input_option,
    json_option,
    parameter_options,
    workers_option,
)
from ..printing import INTERRUPTED, exit_code, print_json, print_warning

if TYPE_CHECKING:
    from ...studies.envelope.search import Envelope
    from ...studies.envelope.store import Store
    from ...studies.envelope.study import EnvelopeStudy

NO_BOUNDARY = 1
RESULTS = ("boundary.csv", "boundary.json")
STUDY = click.Path(path_type=Path)


@click.command(context_settings=HELP_NAMES)
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
    help="Resolution of the boundary along an axis [default: 1/128 of it]. Repeat.",
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
@input_option()
@click.option(
    "--criterion",
    metavar="NAME",
    help="What is lost: toppled (default), body strike, bottomed out, slid, or limit (any passed).",
)
@click.option(
    "--cells", type=WholeNumber(), metavar="N", help="Coarse cells along each axis [default: 8]."
)
@click.option(
    "--levels",
    type=WholeNumber(),
    metavar="N",
    help="How often cells on the boundary are halved [default: 2].",
)
@click.option(
    "--until",
    type=Number("s"),
    metavar="S",
    help="End of a landing that neither rests nor topples [default: 60 after contact].",
)
@click.option(
    "--work",
    type=click.Path(path_type=Path),
    default=Path("envelope"),
    show_default=True,
    help="Folder for landings and results.",
)
@click.option("--resume", is_flag=True, help="Continue with the landings in --work.")
@workers_option()
@click.option(
    "--plot",
    metavar="FILE.png|svg|pdf",
    type=click.Path(path_type=Path),
    help="Draw boundaries, landings and critical conditions.",
)
@json_option("Print the whole result as JSON.")
@force_option("Overwrite a picture that exists.")
def envelope(
    study: Path | None,
    work: Path,
    plot: Path | None,
    *,
    resume: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Find where landings turn from stable to lost, in two quantities, for every family.

    It also finds the critical condition along that boundary. Coarse cells are halved where their
    corners differ. Then the edges that the boundary crosses are halved, to the tolerance of each
    axis. An island that lies within one coarse cell is not found (--cells). Results are
    boundary.csv, boundary.json and landings.jsonl in the folder --work. After Ctrl-C, --resume
    continues there. Axes are parameters or inputs; a landing starts at its first contact. Options
    win over the study's file.

    \b
    rlv-landing envelope examples/envelope.toml --plot envelope.png
    rlv-landing envelope --x drop.horizontal_velocity=-6..6 --y "drop.tilt=-15 deg..15 deg" \\
        --family ground.friction=0.3,0.6

    Exit codes: 0 done, 1 no family has a boundary in the range (all stable or all lost), or a full
    disk, 2 bad input, 130 interrupted.
    """
    from ...audit.transverse import joint_warning
    from ...studies.envelope.results import record
    from ...studies.study_effort import check_landings
    from ...tables.envelope_tables import envelope_tables
    from ...workers import default_workers

    check_writable(plot, PICTURES, force=options["force"])
    asked = _study(study, options)
    print_warning(joint_warning(map(asked.parameters_with, asked.families), asked.inputs))
    workers = options["workers"] or default_workers()
    check_landings(asked.fewest_landings, workers, asked.until, asked.every, decided=True)
    store = _open_store(asked, work, resume=resume)
    try:
        found = _search(asked, store, workers)
        _write(found, work)
    except KeyboardInterrupt:
        answer()
        _end("interrupted", INTERRUPTED, store, work)
    except OSError as e:
        reason = unwritable(work, e, ANOTHER_WORK, kept=True)
        _end(f"error: {reason}", exit_code(e), store, work)
    finally:
        store.close()
    if plot is not None:
        from ...figures.envelope.figure import save_envelope

        with writing(plot):
            save_envelope(found, plot)
    if as_json:
        print_json(record(found))
    else:
        click.echo(envelope_tables(found), nl=False)
    if not any(f.lines for f in found.families):
        click.echo("error: no family has a boundary in this range; widen the axes", err=True)
        sys.exit(NO_BOUNDARY)


def _end(reason: str, status: int, store: Store, work: Path) -> NoReturn:
    """End before the search is done."""
    kept = f"{len(store.found)} landings are kept in {work}, --resume continues"
    click.echo(one_line(f"{reason}; {kept}"), err=True)
    sys.exit(status)


def _study(path: Path | None, options: dict[str, Any]) -> EnvelopeStudy:
    """The study of the file, changed by the options."""
    from ...studies import toml_keys
    from ...studies.envelope.study import study_from

    document = toml_keys.read(path)[0] if path is not None else {}
    _override(document, options)
    return study_from(document, path.parent if path is not None else Path())


def _override(document: dict[str, Any], options: dict[str, Any]) -> None:
    """Let the options replace what the study's document gives."""
    from ...studies import toml_keys
    from ...studies.limits import LIMITS
    from ...studies.variables import VARIABLES

    for key in ("envelope", "set", "limits", *(axis for axis in ("x", "y") if axis in document)):
        document[key] = toml_keys.table(document, key)
    keys = document["envelope"]
    file = options["file"]
    if options["preset"] is not None or file is not None:
        keys.pop("preset", None)
        keys.pop("parameters", None)
    top = {
        "parameters": None if file is None else str(Path.cwd() / file),
        **{
            key: options[key] for key in ("preset", "mode", "criterion", "cells", "levels", "until")
        },
    }
    keys.update({key: value for key, value in top.items() if value is not None})
    fixed = parse_pairs((*options["pairs"], *options["inputs"]), VARIABLES, "quantity")
    document["set"].update(fixed)
    document["limits"].update(parse_pairs(options["limits"], LIMITS, "limit"))
    if options["families"]:
        pairs = [split_pair(pair, "--family") for pair in options["families"]]
        document["families"] = {
            name: [value.strip() for value in values.split(",")] for name, values in pairs
        }
    for key in ("x", "y"):
        if options[f"{key}_axis"] is not None:
            document[key] = _axis(key, options[f"{key}_axis"])
    for pair in options["tolerances"]:
        name, value = split_pair(pair, "--tolerance")
        axes = [document[key] for key in ("x", "y") if document.get(key, {}).get("name") == name]
        if not axes:
            raise LandingError(f"--tolerance {name}={value}: {name} is not an axis")
        axes[0]["tolerance"] = value


def _axis(key: str, text: str) -> dict[str, str]:
    name, values = split_pair(text, f"--{key}")
    low, dots, high = values.partition("..")
    if not dots:
        raise LandingError(
            f'--{key} {text}: write NAME=LOW..HIGH, for example drop.tilt="-10 deg..10 deg"'
        )
    return {"name": name, "low": low.strip(), "high": high.strip()}


def _open_store(asked: EnvelopeStudy, work: Path, *, resume: bool) -> Store:
    from ...studies.envelope.store import Store

    path = work / "landings.jsonl"
    refuse_no_files(work, RESULTS, ANOTHER_WORK)
    strange = [name for name in RESULTS if os.path.lexists(work / name)]
    if strange and not os.path.lexists(path):
        raise LandingError(f"{work / strange[0]} is there without {path.name}; {ANOTHER_WORK}")
    return Store(asked, path, resume=resume)


def _search(asked: EnvelopeStudy, store: Store, workers: int) -> Envelope:
    """Search with progress on a terminal."""
    from tqdm import tqdm

    from ...studies.envelope.search import envelope as run

    with tqdm(initial=len(store.found), unit="landing", disable=not sys.stderr.isatty()) as bar:

        def show_progress(family: int, count: int) -> None:
            bar.set_description_str(f"family {family + 1} of {len(asked.families)}", refresh=False)
            bar.update(count - bar.n)

        return run(asked, workers, store, show_progress)


def _write(found: Envelope, work: Path) -> None:
    from ...studies.envelope.results import write_csv, write_json

    write_csv(found, work / "boundary.csv")
    write_json(found, work / "boundary.json")
