"""The command line in a process of its own: what it prints, what it writes, how it ends."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import numpy as np
import pytest
from forked import run_forked

from rlv_landing import Landing, load_preset
from rlv_landing.cli import cli
from rlv_landing.quantities import OUTPUT_NAMES, interface_of


def run(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return run_forked(*arguments, cwd=cwd, environment={**os.environ, "COLUMNS": "120"})


def test_simulate_writes_csv_with_landings_digits_and_a_picture(tmp_path, mode):
    done = run(
        "simulate", "--mode", mode, "--output", "l.csv", "--plot", "l.png", "--json", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    history = Landing(load_preset("yue2022-figures"), mode).run(1.0)
    peak = history.extremes["leg[1].main_strut.force"]
    assert summary["legs"][0]["main_strut_force_min"] == peak.minimum
    assert summary["peaks_of"] == "landing"
    data = np.loadtxt(tmp_path / "l.csv", delimiter=",", skiprows=1)
    assert (tmp_path / "l.csv").read_text().splitlines()[0].split(",") == ["time", *OUTPUT_NAMES]
    assert np.array_equal(data[:, 1:], history.data)
    assert (tmp_path / "l.png").read_bytes().startswith(b"\x89PNG")


def test_compare_prints_every_printed_scalar_of_the_mode(mode):
    done = run("simulate", "--mode", mode, "--compare")
    assert done.returncode == 0, done.stderr
    assert f"of {20 if mode == '2-2' else 28}" in done.stdout
    assert "maximum tension" in done.stdout


def test_parameters_as_toml_come_back_as_parameters(tmp_path):
    done = run("parameters", "--mode", "1-2-1", "--set", "ground.friction=0.3", "--toml")
    assert done.returncode == 0, done.stderr
    (tmp_path / "mine.toml").write_text(done.stdout)
    back = run("parameters", "--parameters", str(tmp_path / "mine.toml"), "--json")
    values = {record["name"]: record for record in json.loads(back.stdout)}
    assert values["ground.friction"]["value"] == 0.3
    assert values["ground.friction"]["source"] == "user"
    assert (
        values["drop.contact_time"]["value"]
        == load_preset("yue2022-figures", "1-2-1").drop.contact_time
    )
    assert values["drop.mode"]["value"] == "1-2-1"


def test_tables_of_parameters_inputs_and_outputs_name_units():
    assert "main_strut.orifice_area_compression" in run("parameters").stdout
    assert "ground.heave_rate" in run("parameters", "--inputs").stdout
    assert "leg[4].contact.active" in run("parameters", "--outputs").stdout


def test_inputs_and_outputs_listed_are_those_of_the_landing_that_is_chosen():
    space = ("--mode", "space", "--set", "vehicle.legs=5", "--json")
    for what in ("inputs", "outputs"):
        listed = json.loads(run("parameters", f"--{what}", *space).stdout)
        landings = getattr(interface_of("space", 5), what)
        assert [q["name"] for q in listed] == [q.name for q in landings]


@pytest.mark.parametrize("command", [(), ("simulate",), ("parameters",), ("validate",), ("audit",)])
def test_help_teaches(command):
    done = run(*command, "--help")
    assert done.returncode == 0
    assert "rlv-landing" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("simulat",), "did you mean simulate?"),
        (("simulate", "--untill", "2"), "--until"),
        (("simulate", "--mode", "3-1"), "unknown landing mode '3-1'; known are 2-2, 1-2-1"),
        (("simulate", "--preset", "yue2022"), "unknown preset 'yue2022'"),
        (("simulate", "--set", "ground.fricton=0.3"), "did you mean ground.friction?"),
        (("simulate", "--set", "ground.friction"), "has no '='"),
        (("simulate", "--set", "ground.friction=-0.1"), "ground.friction = -0.1 is outside [0, 3]"),
        (("simulate", "--set", "ground.friction=nan"), "ground.friction = nan is outside [0, 3]"),
        (("simulate", "--set", "drop.tilt=5 m"), "wrong unit"),
        (("simulate", "--input", "external.force_z=5"), "did you mean external.force_"),
        (("simulate", "--parameters", "none.toml"), "there is no parameter file none.toml"),
        (("simulate", "--every", "-0.001"), "every = -0.001 s must be finite and above 0 s"),
        (("simulate", "--until", "nan"), "until = nan s must be finite"),
        (("simulate", "--until", "abc"), "not a valid float"),
        (("simulate", "--rtol", "3"), "rtol = 3 is outside"),
        (("simulate", "--output", "x.txt"), "must end in .csv or .parquet"),
        (("simulate", "--output", "no/such/x.csv"), "there is no folder no/such"),
        (("simulate", "--output", "x" * 300 + ".csv"), "cannot be written: File name too long"),
        (("simulate", "--set", "drop.tilt=9**9**9**9 deg"), "nothing is calculated"),
        (("simulate", "--set", "ground.friction=0,05"), "a point instead of the comma: 0.05"),
        (("simulate", "--input", "ground.tilt=1,5 deg"), "a point instead of the comma: 1.5 deg"),
        (("simulate", "--until", "1_0"), "a number has no underscores"),
        (("simulate", "--until", "1 m"), "give it in s"),
        (("simulate", "--rtol", "9" * 500), "500 characters, more than 100"),
        (("envelope", "--cells", "1_0"), "not a valid integer"),
        (("envelope", "--cells", "9" * 500), "more than 18 digits"),
        (
            ("envelope", "--x", "drop.tilt=-9..9 deg", "--y", "ground.friction=0..1"),
            "drop.tilt = -9 has no unit, and '9 deg' beside it has one",
        ),
        (("envelope", "--limit", "main_strut.force=1,5 kN"), "a point instead of the comma"),
        (
            (
                "envelope",
                "--family",
                "ground.slope=1,5 deg",
                "--x",
                "drop.tilt=-1..1",
                "--y",
                "ground.friction=0..1",
            ),
            "ground.slope = 1 has no unit",
        ),
        (("identify", "--bound", "main_strut.stroke_max=30..60 mm"), "30 has no unit"),
        (("identify", "--bound", "main_strut.stroke_max=30 mm..60 deg"), "has the wrong unit"),
        (("simulate", "--parameters", "/dev/zero"), "larger than 4 MiB"),
        (("simulate", "--compare", "--until", "0.3"), "the paper's scalars need it until"),
        (("simulate", "--compare", "--json"), "--compare prints a table, and --json has none"),
        (("parameters", "--inputs", "--toml"), "leave --toml out"),
        (("parameters", "--outputs", "--origin"), "leave --origin out"),
        *(
            ((*words, "--mode", "space"), "this needs a symmetric landing; choose 2-2 or 1-2-1")
            for words in (("simulate", "--compare"), ("identify",), ("identify", "--priors"))
        ),
    ],
)
def test_bad_input_is_one_clear_line_and_exit_code_2(tmp_path, arguments, message):
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert len(done.stderr.strip()) <= 300
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_options_take_units(tmp_path):
    done = run(
        *("simulate", "--until", "100 ms", "--every", "10 ms", "--output", "l.csv"),
        *("--input", "ground.tilt=\u22122 deg", "--set", "main_strut.area_upper=0.001077092 m2"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    data = np.loadtxt(tmp_path / "l.csv", delimiter=",", skiprows=1)
    assert data[:, 0].tolist() == [k * 0.01 for k in range(11)]


def test_files_are_not_overwritten_unless_asked(tmp_path):
    (tmp_path / "l.csv").write_text("precious")
    done = run("simulate", "--until", "0.1", "--output", "l.csv", cwd=tmp_path)
    assert done.returncode == 2
    assert "l.csv exists; --force overwrites it" in done.stderr
    assert (tmp_path / "l.csv").read_text() == "precious"
    assert (
        run("simulate", "--until", "0.1", "--output", "l.csv", "--force", cwd=tmp_path).returncode
        == 0
    )


def test_the_module_runs_as_the_command_does():
    done = subprocess.run(
        [sys.executable, "-m", "rlv_landing.cli", "--version"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == run("--version").stdout.replace("-c,", "python -m rlv_landing.cli,")


def _all(group: click.Group) -> Iterator[click.Command]:
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield command
        if isinstance(command, click.Group):
            yield from _all(command)


def _commands(group: click.Group) -> Iterator[click.Command]:
    return (c for c in _all(group) if not isinstance(c, click.Group))


def test_output_has_its_short_form_in_every_command():
    found = [p for c in _commands(cli) for p in c.params if "--output" in p.opts]
    assert len(found) > 3
    assert all("-o" in p.opts for p in found)


def test_help_prints_no_open_range():
    texts = {c.name: c.get_help(click.Context(c)) for c in _commands(cli)}
    assert {"envelope", "node", "export"} <= set(texts)
    assert [name for name, text in texts.items() if "None" in text] == []


def test_without_a_command_three_lines_lead_on(command):
    done = command()
    assert (done.code, done.err) == (0, "")
    assert len(done.out.splitlines()) == 3
    for words in ("simulate --plot", "new my_vehicle", "--help"):
        assert words in done.out


def test_a_group_without_a_command_prints_its_help(command):
    groups = [c.name for c in _all(cli) if isinstance(c, click.Group)]
    assert {"fmu", "log", "examples"} <= set(groups)
    for name in groups:
        done = command(name)
        assert (done.code, done.err) == (0, ""), name
        assert done.out == command(name, "--help").out
