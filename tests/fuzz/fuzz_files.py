"""Reads mutated files of every kind: fuzz_files.py COUNT SEED FOLDER.

Runs as a process with little memory. Any exception but an error for the user ends it, as does a
case that takes a minute. An error is one line of at most 300 characters. Parameters that are taken
come back the same from their own TOML text.
"""

from __future__ import annotations

import contextlib
import faulthandler
import io
import json
import random
import resource
import sys
from collections.abc import Callable
from pathlib import Path

import click
from mutated_text import NONSENSE, mutated
from pyarrow import csv as arrow_csv
from pyarrow import parquet

from rlv_landing.cli import cli
from rlv_landing.errors import LONGEST_LINE, LandingError
from rlv_landing.identification.measured.target_file import read_targets
from rlv_landing.presets import load_preset, parse_toml, read_toml, to_toml
from rlv_landing.studies import toml_keys
from rlv_landing.studies.envelope.study import study_from
from rlv_landing.studies.sweep.sensitivity import numeric_responses, sobol_design
from rlv_landing.studies.sweep.states_table import read_states
from rlv_landing.studies.sweep.study import read_study
from rlv_landing.studies.sweep.sweep_row import Task
from rlv_landing.tables.sweep_tables import plan_table
from rlv_landing.validation.curves import read_curves

MEMORY = 3 * 1024**3
# points of a study that are drawn here at most
MOST_POINTS = 4096

PARAMETERS = """preset = "yue2022-table2"
[vehicle]
mass = 178.0
inertia = { value = "202.9 kg.m2", source = "measured \\u00b1 3 %" }
[main_strut]
stroke_max = "50 mm"
orifice_area_compression = "6.1 mm2"
[ground]
friction = 0.3
slope = "2 deg"
[drop]
mode = "2-2"
tilt = "-7.4 deg"
[mode.1-2-1.drop]
tilt = "-6 deg"
"""
SWEEP = """[study]
name = "mine"
method = "lhs"
samples = 16
seed = 3
until = 0.02
every = "2 ms"
modes = ["2-2", "1-2-1"]
responses = ["outcome", "margin.*", "leg[1].main_strut.force.min"]
[set]
drop.contact_time = 0.0
ground.friction = 0.4
[limits]
main_strut.force = "8 kN"
[[factor]]
name = "drop.tilt"
unit = "deg"
low = -6.0
high = 6.0
[[factor]]
name = "drop.vertical_velocity"
distribution = "normal"
mean = -1.4
deviation = 0.3
high = -0.2
[[factor]]
name = "external.force_x"
values = [0.0, "0.5 kN"]
"""
GRID = """[study]
method = "grid"
[[factor]]
name = "drop.tilt"
low = "-6 deg"
high = "6 deg"
count = 3
[[factor]]
name = "drop.mode"
values = ["2-2", "1-2-1"]
"""
TABLE_STUDY = """[study]
table = "states.csv"
ignore = ["case"]
[set]
ground.friction = 0.3
"""
ENVELOPE = """[envelope]
mode = "2-2"
criterion = "toppled"
cells = 6
levels = 2
until = "6 s"
[x]
name = "drop.horizontal_velocity"
low = -6.0
high = 6.0
tolerance = 0.1
[y]
name = "drop.tilt"
low = "-18 deg"
high = "18 deg"
tolerance = "0.5 deg"
[set]
drop.pitch_rate = 0.0
[families]
ground.slope = ["0 deg", "5 deg"]
ground.friction = [0.3, 0.6]
[limits]
main_strut.force = "12 kN"
"""
STATES = """case,drop.vertical_velocity [m/s],drop.horizontal_velocity,drop.tilt [deg],\
drop.pitch_rate
a,-1.5,0.1,2.0,0.01
b,-1.4,,1.0,0.0
"""
TARGETS = """id,value,unit
22-fm1-td,-2.7,kN
22-s3-max,24.17,mm
"""
CURVES = """time [s],leg[1].main_strut.force [kN],body.pitch
0.0,-1.0,0.1
0.1,-2.0,0.1
0.2,-1.5,0.1
"""
SETS = ("vehicle.mass", "drop.tilt", "main_strut.area_upper", "ground.friction", "drop.mode")


def parameters(path: Path) -> None:
    found = read_toml(path)
    assert to_toml(parse_toml(to_toml(found), "again")) == to_toml(found)


def sweep(path: Path) -> None:
    study = read_study(path)
    if study.samples > MOST_POINTS:
        return
    task = Task(study, study.design)
    task.rows(0, min(3, len(task)))
    json.dumps(task.about())
    plan_table(task)
    if study.method in ("lhs", "sobol") and len(study.factors) > 1:
        numeric_responses(study, ())
        sobol_design(study)


def envelope(path: Path) -> None:
    study = study_from(toml_keys.read(path)[0], path.parent)
    json.dumps(study.record())


def states(path: Path) -> None:
    design = read_states(path, ["case"], [])
    design.digest()
    design.rows(0, min(3, len(design)))


def command(*arguments: str) -> Callable[[Path], None]:
    """The command with the file in the place of `FILE`, in this process."""

    def run(path: Path) -> None:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
            cli.main([str(path) if a == "FILE" else a for a in arguments], standalone_mode=False)

    return run


KINDS: dict[str, tuple[str, str, Callable[[Path], object]]] = {
    "parameters": (PARAMETERS, "p.toml", parameters),
    "all parameters": (to_toml(load_preset("yue2022-figures")), "p.toml", parameters),
    "simulate": (
        PARAMETERS,
        "p.toml",
        command("simulate", "--parameters", "FILE", "--until", "0.001", "--json"),
    ),
    "parameter table": (PARAMETERS, "p.toml", command("parameters", "--parameters", "FILE")),
    "sweep": (SWEEP, "s.toml", sweep),
    "grid": (GRID, "s.toml", sweep),
    "table": (TABLE_STUDY, "s.toml", sweep),
    "envelope": (ENVELOPE, "e.toml", envelope),
    "envelope options": (
        ENVELOPE,
        "e.toml",
        command(
            *("envelope", "FILE", "--criterion", "none", "--preset", "yue2022-figures"),
            *("--set", "vehicle.mass=200", "--limit", "main_strut.force=1 kN"),
            *("--tolerance", "drop.tilt=1 deg", "--x", "drop.tilt=-5 deg..5 deg"),
        ),
    ),
    "states": (STATES, "states.csv", states),
    "targets": (TARGETS, "t.csv", read_targets),
    "curves": (CURVES, "c.csv", read_curves),
}


def options(r: random.Random) -> list[str]:
    """A command with a nonsensical option, which ends before anything lands."""
    value = r.choice(NONSENSE).strip("'\"")
    return r.choice(
        (
            ["parameters", "--set", f"{r.choice(SETS)}={value}"],
            ["parameters", "--preset", value],
            ["parameters", "--mode", value, "--parameters", value],
            ["simulate", "--until", "nan", "--input", f"ground.tilt={value}"],
            ["simulate", "--rtol", value, "--every", "nan"],
            ["simulate", "--every", value, "--until", "nan"],
            ["simulate", "--output", value, "--until", "nan"],
            ["identify", "--bound", f"ground.friction={value}", "--free", "none"],
            ["identify", "--bound", f"drop.tilt=0..{value}", "--free", "none"],
            ["identify", "--targets", value, "--free", "ground.friction", "--mode", "none"],
            ["identify", "--series", f"2-2={value}", "--free", "ground.friction"],
            ["identify", "--seed", value, "--free", "none"],
            ["envelope", "--criterion", "none", "--x", f"drop.tilt={value}..{value}"],
            ["envelope", "--criterion", "none", "--family", f"ground.slope={value}", "--x", "a"],
            ["envelope", value, "--criterion", "none"],
            ["sweep", value, "--dry-run", "--workers", value],
            ["sensitivity", value, "--level", value],
            ["validate", "--require", value],
            ["validate", "--test-data", value],
        )
    )


def refused(action: Callable[[], None]) -> bool:
    """Whether the action ends with an error for the user, which must be one short line."""
    try:
        action()
    except click.ClickException:
        return True
    except LandingError as e:
        message = f"error: {e}"
        if len(message) > LONGEST_LINE or not message.isprintable():
            raise RuntimeError(f"no short line: {message!r}") from e
        return True
    return False


def main(count: int, seed: int, folder: Path) -> dict[str, int]:
    """The number of cases, of those refused, and of those taken."""
    counts = {"cases": 0, "refused": 0, "taken": 0}
    for case in range(count):
        faulthandler.dump_traceback_later(60.0, exit=True)
        r = random.Random(f"{seed}-{case}")
        kind = list(KINDS)[case % (len(KINDS) + 1)] if case % (len(KINDS) + 1) < len(KINDS) else ""
        try:
            if kind:
                text, name, action = KINDS[kind]
                (folder / "states.csv").write_text(STATES)
                path = folder / name
                path.write_bytes(mutated(text.encode(), r))
                bad = refused(lambda: action(path))  # noqa: B023
                if name == "states.csv":
                    bad = _as_parquet(path) and bad
            else:
                bad = refused(lambda: command(*options(r))(folder))  # noqa: B023
        except Exception as e:
            raise RuntimeError(f"case {case} of seed {seed}: {kind or 'options'}") from e
        counts["cases"] += 1
        counts["refused" if bad else "taken"] += 1
    faulthandler.cancel_dump_traceback_later()
    return counts


def _as_parquet(path: Path) -> bool:
    """The same table as Parquet, with the types that Arrow finds in it."""
    target = path.with_suffix(".parquet")
    try:
        parquet.write_table(arrow_csv.read_csv(path), target)
    except Exception:
        target.write_bytes(path.read_bytes())
    return refused(lambda: states(target))


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(json.dumps(main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))))
