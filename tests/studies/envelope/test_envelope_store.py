"""An envelope resumes its landings line by line: torn ends are cut off, damage is refused."""

from __future__ import annotations

import json
import os
import resource
from collections.abc import Callable
from pathlib import Path

import pytest
from study_tools import run

OPTIONS = (
    *("--x", "drop.horizontal_velocity=-4..4", "--y", "drop.tilt=-0.2..0.2"),
    *("--cells", "2", "--levels", "0", "--until", "0.3"),
    *("--tolerance", "drop.horizontal_velocity=4", "--tolerance", "drop.tilt=0.2"),
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of an envelope that is done."""
    folder = tmp_path_factory.mktemp("made")
    run("envelope", *OPTIONS, "--work", "e", cwd=folder)
    return folder / "e"


@pytest.fixture
def work(made: Path, tmp_path: Path) -> Path:
    """A folder with the landings, as a killed search leaves them."""
    (tmp_path / "e").mkdir()
    (tmp_path / "e" / "landings.jsonl").write_bytes((made / "landings.jsonl").read_bytes())
    return tmp_path / "e"


def changed(number: int, change: Callable[[dict], object]) -> Callable[[bytes], bytes]:
    def of(data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        record = json.loads(lines[number])
        change(record)
        lines[number] = json.dumps(record).encode() + b"\n"
        return b"".join(lines)

    return of


def replaced(number: int, line: bytes) -> Callable[[bytes], bytes]:
    def of(data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        return b"".join([*lines[:number], line, *lines[number + 1 :]])

    return of


TORN: dict[str, Callable[[bytes], bytes]] = {
    "in a line": lambda data: data[:-30],
    "before the end of the line": lambda data: data[:-1],
    "NULs": lambda data: data + bytes(400),
    "NULs in a line": lambda data: data[:-30] + bytes(400),
    "not UTF-8": lambda data: data + b"\xff\xfe",
    "in the first line": lambda data: data[:20],
    "empty": lambda data: b"",
    "NULs only": lambda data: bytes(4096),
    "doubled line": lambda data: data + data.splitlines(keepends=True)[3],
}
DAMAGED: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "no JSON": (replaced(2, b"xx\n"), "line 3, is damaged"),
    "NULs in the middle": (replaced(2, bytes(40) + b"\n"), "line 3, is damaged"),
    "not UTF-8": (replaced(2, b"\xff\xfe\n"), "line 3, is damaged"),
    "empty table": (replaced(2, b"{}\n"), "line 3, is damaged (it is no landing)"),
    "list": (replaced(2, b"[]\n"), "it is no landing"),
    "deep": (replaced(2, b"[" * 10**5 + b"\n"), "line 3, is damaged"),
    "point is a text": (changed(2, lambda r: r.update(i="a")), "i = 'a' is not from 0 to 2"),
    "point outside": (changed(2, lambda r: r.update(j=3)), "j = 3 is not from 0 to 2"),
    "family outside": (changed(2, lambda r: r.update(family=1)), "family = 1 is not from 0 to 0"),
    "outcome": (changed(2, lambda r: r["landed"].update(name="fine")), "'fine' is no outcome"),
    "time": (changed(2, lambda r: r["landed"].update(time="1")), "are no numbers"),
    "leg": (changed(2, lambda r: r["landed"].update(leg=9)), "leg 9 is none of 4"),
    "more": (changed(2, lambda r: r["landed"].update(x=1)), "it is no landing"),
    "limit": (changed(2, lambda r: r["landed"].update(first_limit={})), "it is no landing"),
    "digit": (
        changed(2, lambda r: r["landed"].update(time=r["landed"]["time"] + 1e-3)),
        "line 3, is damaged (its check sum is another)",
    ),
    "contradiction": (
        lambda data: (
            data
            + changed(0, lambda r: r["landed"].update(time=9.0))(data.splitlines(keepends=True)[2])
        ),
        "line 11, is damaged (it contradicts a line before it)",
    ),
    "other study": (replaced(0, b'{"study": "0"}\n'), "of another study or version"),
    "text": (lambda data: b"precious\n", "of another study or version"),
}


@pytest.mark.parametrize("how", TORN)
def test_a_torn_end_is_cut_off_and_the_result_is_the_same(made, work, command, how):
    path = work / "landings.jsonl"
    path.write_bytes(TORN[how](path.read_bytes()))
    command("envelope", *OPTIONS, "--work", str(work), "--resume")
    for name in ("boundary.json", "boundary.csv"):
        assert (work / name).read_bytes() == (made / name).read_bytes()
    lines = path.read_bytes().splitlines()
    assert sorted(set(lines)) == sorted((made / "landings.jsonl").read_bytes().splitlines())


@pytest.mark.parametrize("how", DAMAGED)
def test_damage_is_refused_with_the_number_of_its_line(work, command, how):
    path = work / "landings.jsonl"
    spoil, message = DAMAGED[how]
    path.write_bytes(spoil(path.read_bytes()))
    before = path.read_bytes()
    done = command("envelope", *OPTIONS, "--work", str(work), "--resume")
    assert done.code == 2, done.err
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert path.read_bytes() == before
    assert not (work / "boundary.json").exists()


def test_a_full_disk_keeps_the_landings_and_resume_continues(made, tmp_path, command):
    done = run(
        *("envelope", *OPTIONS, "--work", "e"),
        cwd=tmp_path,
        before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)),
    )
    assert done.returncode == 1
    assert "e cannot be written: File too large; make room; " in done.stderr
    assert "landings are kept in e, --resume continues" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    kept = (tmp_path / "e" / "landings.jsonl").read_bytes()
    assert kept.endswith(b"\n")
    assert not list((tmp_path / "e").glob("boundary*"))
    command("envelope", *OPTIONS, "--work", str(tmp_path / "e"), "--resume")
    assert (tmp_path / "e/landings.jsonl").read_bytes().startswith(kept)
    assert (tmp_path / "e/boundary.json").read_bytes() == (made / "boundary.json").read_bytes()


def test_folders_that_are_not_its_own_are_left_alone(tmp_path, command):
    (tmp_path / "boundary.csv").write_text("mine")
    done = command("envelope", *OPTIONS, "--work", str(tmp_path))
    assert done.code == 2
    assert "boundary.csv is there without landings.jsonl; name another folder" in done.err
    (tmp_path / "e").mkdir()
    (tmp_path / "precious").write_text("precious")
    (tmp_path / "e" / ".lock").symlink_to(tmp_path / "precious")
    done = command("envelope", *OPTIONS, "--work", str(tmp_path / "e"))
    assert done.code == 2
    assert ".lock is a link or no file" in done.err
    done = command("envelope", *OPTIONS, "--work", str(tmp_path / "precious"))
    assert done.code == 2
    assert "precious cannot be written" in done.err
    assert (tmp_path / "precious").read_text() == "precious"
    os.mkfifo(tmp_path / "e" / "landings.jsonl")
    (tmp_path / "e" / ".lock").unlink()
    done = command("envelope", *OPTIONS, "--work", str(tmp_path / "e"), "--resume")
    assert done.code == 2
    assert "landings.jsonl is no file" in done.err
