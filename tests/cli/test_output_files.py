"""Output files are written whole or not at all; what cannot be written is one line and a code."""

from __future__ import annotations

import errno
import os
import subprocess
from pathlib import Path

import pytest
from forked import run_forked

from rlv_landing.commands.printing import exit_code
from rlv_landing.text.durable import NO_ROOM, unwritable, write_durably

STUDY = """[study]
method = "sobol"
samples = 2
until = 0.02
responses = ["outcome", "margin.stability_min"]
[[factor]]
name = "drop.tilt"
low = -0.1
high = 0.1
[[factor]]
name = "ground.friction"
low = 0.2
high = 0.5
"""
AXES = ("--x", "drop.horizontal_velocity=-4..4", "--y", "drop.tilt=-0.2..0.2")
COARSE = ("--tolerance", "drop.horizontal_velocity=4", "--tolerance", "drop.tilt=0.2")
ENVELOPE = ("envelope", *AXES, *COARSE, "--cells", "2", "--levels", "0", "--until", "0.1")
ONE = ("--evaluations", "1", "--polish", "0", "--workers", "1", "--free", "ground.friction")


def run(
    folder: Path, *arguments: str, largest: int | None = None, output: str | None = None
) -> subprocess.CompletedProcess[str]:
    """The command in `folder`; files take `largest` bytes, and standard output goes to `output`."""
    return run_forked(
        *arguments, cwd=folder, largest=largest, output=Path(output or os.devnull), timeout=200.0
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "s.toml").write_text(STUDY)
    return tmp_path


PRINTING = {
    "help": ("--help",),
    "version": ("--version",),
    "simulate": ("simulate", "--until", "0.05"),
    "json": ("simulate", "--until", "0.05", "--json"),
    "parameters": ("parameters", "--toml"),
    "priors": ("identify", "--priors"),
    "dry run": ("sweep", "s.toml", "--dry-run"),
    "sweep": ("sweep", "s.toml"),
    "sensitivity": ("sensitivity", "s.toml"),
    "envelope": ENVELOPE,
    "identify": ("identify", *ONE),
    "validate": ("validate", "--mode", "2-2"),
    "audit": ("audit", "--mode", "2-2"),
    "animate": ("animate", "l.gif", "--end", "0.02"),
}


@pytest.mark.parametrize("name", PRINTING)
def test_a_full_standard_output_is_one_line_and_exit_code_1(folder, name):
    done = run(folder, *PRINTING[name], output="/dev/full")
    assert done.returncode == 1
    assert done.stderr == ("error: standard output cannot be written: No space left on device\n")


def test_files_are_written_even_if_standard_output_takes_nothing(folder):
    run(folder, "simulate", "--until", "0.05", "--output", "l.csv", output="/dev/full")
    assert (folder / "l.csv").read_text().count("\n") == 52


WRITING = {
    "simulate --output": (("simulate", "--output", "out.csv"), "out.csv", 2),
    "simulate --plot": (("simulate", "--plot", "out.png"), "out.png", 2),
    "validate --html": (("validate", "--mode", "2-2", "--html", "out.html"), "out.html", 2),
    "animate": (("animate", "out.gif", "--end", "0.05"), "out.gif", 2),
    "envelope --plot": ((*ENVELOPE, "--plot", "out.png"), "out.png", 2),
    "sensitivity --plot": (("sensitivity", "s.toml", "--plot", "out.png"), "out.png", 2),
}


@pytest.mark.parametrize("name", WRITING)
def test_a_disk_that_fills_leaves_the_file_that_was_there(folder, name):
    arguments, file, code = WRITING[name]
    (folder / file).write_text("the file before")
    force: tuple[str, ...] = ("--force",)
    if name.startswith("sensitivity"):
        # its rows are there already: what is left to write is the picture
        assert run(folder, "sensitivity", "s.toml").returncode == 0
        force = ("--resume",)
    done = run(folder, *arguments, *force, largest=16_000)
    last = done.stderr.strip().splitlines()[-1]
    assert done.returncode == code, done.stderr
    assert f"{file} cannot be written: File too large; make room, or name another" in last
    assert "Traceback" not in done.stderr
    assert (folder / file).read_text() == "the file before"
    assert not [p for p in folder.rglob("*") if ".part" in p.name]


def test_a_disk_that_fills_leaves_no_new_file(folder):
    done = run(folder, "simulate", "--output", "out.csv", largest=100_000)
    assert done.returncode == 2
    assert sorted(p.name for p in folder.iterdir()) == ["s.toml"]


@pytest.mark.parametrize("filling", [("new", "a/b"), ("examples", "copy", "a/b")])
def test_a_disk_that_fills_leaves_no_new_folder(folder, filling):
    done = run(folder, *filling, largest=2000)
    assert done.returncode == 2
    assert done.stderr.startswith("error: a/b")
    assert "cannot be written: File too large; make room, or name a new folder" in done.stderr
    assert done.stderr.count("\n") == 1
    assert sorted(p.name for p in folder.iterdir()) == ["s.toml"]


def test_a_disk_that_fills_empties_the_folder_that_was_there(folder):
    (folder / "empty").mkdir()
    assert run(folder, "examples", "copy", "empty", largest=2000).returncode == 2
    assert list((folder / "empty").iterdir()) == []
    assert run(folder, "new", "empty").returncode == 0


def test_a_disk_that_fills_ends_an_identification_with_a_code_of_its_own(folder):
    done = run(folder, "identify", *ONE, "--work", "i", largest=8192)
    assert done.returncode == 1
    assert "i cannot be written: File too large; make room; --resume goes on" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert sorted(p.name for p in (folder / "i").iterdir()) == [
        ".lock",
        "best.json",
        "search.json",
    ]


RESULTS = {
    "e/boundary.csv": (*ENVELOPE, "--work", "e"),
    "i/report.md": ("identify", *ONE, "--work", "i"),
    "r/results.parquet": ("sweep", "s.toml", "--results", "r"),
}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_that_is_a_folder_is_refused_on_resume_and_no_room_is_asked_for(
    folder, command, monkeypatch, name
):
    monkeypatch.chdir(folder)
    assert command(*RESULTS[name]).code in (0, 1)
    (folder / name).unlink()
    (folder / name).mkdir()
    done = command(*RESULTS[name], "--resume")
    assert done.code == 2, done.err
    assert name in done.err
    assert "make room" not in done.err
    assert len(done.err.strip().splitlines()) == 1


@pytest.mark.parametrize("number", sorted(errno.errorcode))
def test_room_is_asked_for_only_where_there_is_none(tmp_path, number):
    for kept in (False, True):
        text = str(unwritable(tmp_path, OSError(number, os.strerror(number)), kept=kept))
        assert ("make room" in text) == (number in NO_ROOM), text
        assert ("name another" in text) != (kept and number in NO_ROOM), text


def test_a_folder_in_the_way_is_named(tmp_path):
    (tmp_path / "boundary.csv").mkdir()
    with pytest.raises(IsADirectoryError) as refused:
        write_durably(tmp_path / "boundary.csv", b"x")
    assert str(unwritable(tmp_path, refused.value)) == (
        f"{tmp_path / 'boundary.csv'} cannot be written: Is a directory; "
        "move it away, or name another"
    )
    assert exit_code(refused.value) == 2
    assert [p.name for p in tmp_path.iterdir()] == ["boundary.csv"]


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "--output", "{}.csv"),
        ("simulate", "--plot", "{}.png"),
        ("simulate", "--parameters", "{}.toml"),
        ("sweep", "{}.toml"),
        ("sweep", "s.toml", "--results", "{}"),
        ("sensitivity", "s.toml", "--results", "{}"),
        (*ENVELOPE, "--work", "{}"),
        ("identify", *ONE, "--work", "{}"),
        ("identify", *ONE, "--targets", "{}"),
        ("validate", "--html", "{}.html"),
        ("animate", "{}.gif", "--end", "0.02"),
        ("log", "info", "{}"),
        ("log", "verify", "{}"),
        ("log", "export", "{}", "l.csv"),
        ("log", "recover", "{}"),
        ("replay", "{}"),
        ("fmu", "build", "-o", "{}.fmu"),
        ("fmu", "build", "--parameters", "{}.toml"),
        ("fmu", "info", "{}"),
        ("fmu", "simulate", "{}"),
    ],
)
def test_names_of_300_characters_are_refused_in_one_line(folder, arguments):
    done = run(folder, *(a.format("n" * 300) for a in arguments))
    assert done.returncode == 2, done.stderr
    assert "File name too long" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert len(done.stderr.strip()) <= 300
    assert [p.name for p in folder.iterdir()] == ["s.toml"]


def test_a_name_of_255_bytes_is_written(folder):
    name = "\u00fc" * 125 + "x.csv"
    assert run(folder, "simulate", "--until", "0.02", "--output", name).returncode == 0
    assert (folder / name).read_text().startswith("time,")
    assert len(list(folder.iterdir())) == 2


def test_names_that_are_not_utf8_are_written(folder):
    name = os.fsdecode(b"m\xfc")
    for arguments in (
        ("simulate", "--until", "0.02", "--output", f"{name}.csv", "--plot", f"{name}.png"),
        ("sensitivity", "s.toml", "--results", f"r{name}", "--plot", f"s{name}.png"),
        (*ENVELOPE, "--work", f"e{name}", "--plot", f"e{name}.png"),
        ("identify", *ONE, "--work", f"i{name}"),
        ("animate", f"{name}.gif", "--end", "0.02"),
    ):
        done = run(folder, *arguments)
        assert "Traceback" not in done.stderr
        assert (
            "error: nothing better" in done.stderr
            or "no family" in done.stderr
            or (done.returncode == 0)
        ), done.stderr
    for made in (f"{name}.csv", f"s{name}.png", f"e{name}/boundary.csv", f"i{name}/report.md"):
        assert (folder / made).is_file()


@pytest.mark.parametrize("what", ["folder", "pipe"])
def test_what_is_no_file_is_not_overwritten(folder, what):
    (folder / "l.csv").mkdir() if what == "folder" else os.mkfifo(folder / "l.csv")
    done = run(folder, "simulate", "--output", "l.csv", "--force")
    assert done.returncode == 2
    assert "l.csv is there and is no file; name another" in done.stderr


def test_a_link_is_followed_and_a_temporary_name_that_is_a_link_is_not(folder):
    (folder / "far.csv").write_text("old")
    (folder / "l.csv").symlink_to("far.csv")
    (folder / "precious").write_text("precious")
    (folder / "far.csv.part").symlink_to("precious")
    done = run(folder, "simulate", "--until", "0.02", "--output", "l.csv", "--force")
    assert done.returncode == 0, done.stderr
    assert (folder / "l.csv").is_symlink()
    assert (folder / "far.csv").read_text().startswith("time,")
    assert (folder / "precious").read_text() == "precious"
    assert not (folder / "far.csv.part").exists()


@pytest.fixture
def read_only(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that nobody can write to, not even root: one of the system's own."""
    folder = Path("/sys/kernel")
    if not folder.is_dir():
        pytest.skip("needs /sys")
    return folder


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "--output", "{}/l.csv"),
        ("simulate", "--plot", "{}/l.png"),
        ("validate", "--mode", "2-2", "--html", "{}/l.html"),
        ("animate", "{}/l.gif", "--end", "0.02"),
        ("sweep", "s.toml", "--results", "{}/r"),
        ("sensitivity", "s.toml", "--results", "{}/r"),
        (*ENVELOPE, "--work", "{}/e"),
        ("identify", *ONE, "--work", "{}/i"),
    ],
)
def test_a_folder_that_cannot_be_written_is_named_in_one_line(folder, read_only, arguments):
    done = run(folder, *(a.format(read_only) for a in arguments))
    assert done.returncode == 2, done.stderr
    assert f"{read_only}/" in done.stderr
    assert "cannot be written" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
