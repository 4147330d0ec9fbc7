"""A results folder is resumed with its own rows only: what is torn or foreign is refused."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet
from study_tools import write_study

from rlv_landing.studies.sweep.result_files import Results
from rlv_landing.studies.sweep.study import read_study
from rlv_landing.studies.sweep.sweep_row import Task


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """`whole`: a study's results; `r`: three parts of them; `other`: those of another study."""
    folder = tmp_path_factory.mktemp("made")
    for name, until in (("whole", 0.02), ("other", 0.03)):
        (folder / name).mkdir()
        study = write_study(folder / name, samples=20, until=until)
        task = Task(read := read_study(study), read.design)
        with Results(folder / name / "r", task) as results:
            rows = task.rows(0, len(task))
            results.add(
                [
                    [i, task.sample(i), read.seed, *values.values(), *task.plan.sweep_row(values)]
                    for i, values in enumerate(rows)
                ]
            )
            results.finish()
    table = parquet.read_table(folder / "whole" / "r" / "results.parquet").to_pylist()
    with Results(
        folder / "r", Task(read := read_study(folder / "whole" / "study.toml"), read.design)
    ) as r:
        for first, last in ((0, 10), (10, 22), (25, 33)):
            r.add([list(row.values()) for row in table[first:last]])
            r.flush()
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """A copy of the folder with three parts."""
    shutil.copytree(made / "r", tmp_path / "r")
    return tmp_path / "r"


def flip(path: Path) -> None:
    """Change a byte of the part's values, the last of its first column; its footer stays whole."""
    column = parquet.read_metadata(path).row_group(0).column(0)
    first = column.dictionary_page_offset or column.data_page_offset
    data = bytearray(path.read_bytes())
    data[first + column.total_compressed_size - 1] ^= 0xFF
    path.write_bytes(data)


def link_to(target: Path, link: Path) -> None:
    link.unlink(missing_ok=True)
    link.symlink_to(target)


def in_another_unit(table: Any) -> Any:
    """The same numbers, the unit of the last column with one another."""
    schema = table.schema
    at = max(i for i, f in enumerate(schema) if (f.metadata or {}).get(b"unit"))
    field = schema.field(at)
    other = field.with_metadata({**field.metadata, b"unit": b"furlong"})
    return table.cast(schema.set(at, other))


PART = "parts/000000000010.parquet"
FAULTS: dict[str, tuple[Callable[[Path, Path], object], str]] = {
    "empty part": (lambda f, m: (f / PART).write_bytes(b""), "is damaged"),
    "torn part": (lambda f, m: os.truncate(f / PART, 900), "is damaged"),
    "NULs": (lambda f, m: (f / PART).write_bytes(bytes(4096)), "is damaged"),
    "part is a folder": (
        lambda f, m: ((f / PART).unlink(), (f / PART).mkdir()),
        "is damaged (it is no file)",
    ),
    "part is a pipe": (lambda f, m: ((f / PART).unlink(), os.mkfifo(f / PART)), "it is no file"),
    "foreign name": (
        lambda f, m: shutil.copy(f / PART, f / "parts" / "abc.parquet"),
        "abc.parquet is no part of this study",
    ),
    "other study": (
        lambda f, m: shutil.copy(m / "other/r/results.parquet", f / PART),
        "has rows of another study; move it out of the folder",
    ),
    "no study": (
        lambda f, m: parquet.write_table(
            parquet.read_table(f / PART).replace_schema_metadata(None), f / PART
        ),
        "has rows of another study",
    ),
    "other name": (
        lambda f, m: (f / PART).rename(f / "parts" / "000000000011.parquet"),
        "has rows 10 to 21, and its name says that they begin at 11",
    ),
    "beyond the end": (
        lambda f, m: parquet.write_table(
            (t := parquet.read_table(f / PART)).set_column(
                0, t.schema.field(0), [[i + 990 for i in t["index"].to_pylist()]]
            ),
            f / "parts" / "000000001000.parquet",
        ),
        "has rows 1000 to 1011, and the study has 40 landings",
    ),
    "doubled rows": (
        lambda f, m: parquet.write_table(
            parquet.read_table(m / "whole/r/results.parquet").slice(5, 9),
            f / "parts" / "000000000005.parquet",
        ),
        "has rows that the part before it has",
    ),
    "other results": (
        lambda f, m: shutil.copy(m / "other/r/results.parquet", f / "results.parquet"),
        "results.parquet has rows of another study",
    ),
    "torn results": (
        lambda f, m: (f / "results.parquet").write_bytes(b""),
        "results.parquet is damaged",
    ),
    "changed results": (
        lambda f, m: (f / "results.parquet").write_bytes(
            # the first page's data follow its head
            (d := (m / "whole/r/results.parquet").read_bytes())[:200] + b"\xaa" * 9 + d[209:]
        ),
        "results.parquet is damaged",
    ),
    "other unit": (
        lambda f, m: parquet.write_table(
            in_another_unit(parquet.read_table(m / "whole/r/results.parquet")),
            f / "results.parquet",
        ),
        "results.parquet is damaged (its columns are not the study's)",
    ),
    "short results": (
        lambda f, m: shutil.copy(f / PART, f / "results.parquet"),
        "results.parquet has 12 rows, and the study has 40 landings",
    ),
    "study {}": (lambda f, m: (f / "study.json").write_text("{}"), "says of no study"),
    "study []": (lambda f, m: (f / "study.json").write_text("[]"), "it is no table"),
    "study NULs": (lambda f, m: (f / "study.json").write_bytes(bytes(99)), "cannot be read"),
    "study deep": (lambda f, m: (f / "study.json").write_text("[" * 10**5), "nested too deep"),
    "study not UTF-8": (lambda f, m: (f / "study.json").write_bytes(b"\xff"), "cannot be read"),
    "parts is a file": (
        lambda f, m: (shutil.rmtree(f / "parts"), (f / "parts").write_text("x")),
        "r/parts cannot be written: File exists; name another folder by --results",
    ),
    "lock is a link": (
        lambda f, m: link_to(f.parent / "precious", f / ".lock"),
        ".lock is a link or no file; remove it, or name another folder by --results",
    ),
    "lock is a pipe": (
        lambda f, m: ((f / ".lock").unlink(), os.mkfifo(f / ".lock")),
        ".lock is no file",
    ),
    "lock is a folder": (
        lambda f, m: ((f / ".lock").unlink(), (f / ".lock").mkdir()),
        ".lock is a link or no file",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_torn_and_foreign_files_are_refused_and_left_as_they_are(made, folder, command, fault):
    (folder.parent / "precious").write_text("precious")
    spoil, message = FAULTS[fault]
    spoil(folder, made)
    before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file() and p.name != ".lock"}
    study = str(made / "whole" / "study.toml")
    done = command("sweep", study, "--results", str(folder), "--resume")
    assert done.code == 2, done.err
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert {p: p.read_bytes() for p in before} == before
    assert (folder.parent / "precious").read_text() == "precious"


def test_a_changed_byte_in_a_part_is_noticed_when_the_parts_are_joined(made, folder, command):
    flip(folder / PART)
    done = command("sweep", str(made / "whole/study.toml"), "--results", str(folder), "--resume")
    assert done.code in (1, 2)
    assert "000000000010.parquet is damaged" in done.err
    assert "--resume makes its rows anew" in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert not (folder / "results.parquet").exists()
    (folder / PART).unlink()
    done = command("sweep", str(made / "whole/study.toml"), "--results", str(folder), "--resume")
    assert done.code == 0, done.err
    whole = made / "whole/r/results.parquet"
    assert (folder / "results.parquet").read_bytes() == whole.read_bytes()


def test_what_a_killed_sweep_left_and_other_files_do_no_harm(made, folder, command):
    (folder / "parts" / "000000000033.parquet.part").write_bytes(b"PAR1 half")
    (folder / "results.parquet.part").write_bytes(b"PAR1 half")
    (folder / "parts" / "notes.txt").write_text("mine")
    done = command("sweep", str(made / "whole/study.toml"), "--results", str(folder), "--resume")
    assert done.code == 0, done.err
    assert sorted(p.name for p in folder.rglob("*")) == [
        ".lock",
        "notes.txt",
        "parts",
        "results.parquet",
        "study.json",
        "study.toml",
    ]
    whole = made / "whole/r/results.parquet"
    assert (folder / "results.parquet").read_bytes() == whole.read_bytes()


def test_a_folder_where_a_sweep_was_killed_before_its_first_file_is_taken(made, tmp_path, command):
    (tmp_path / "r").mkdir()
    for name in (".lock", "study.toml", "study.json.part"):
        (tmp_path / "r" / name).write_text("half")
    done = command("sweep", str(made / "whole/study.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    assert json.loads((tmp_path / "r" / "study.json").read_text())["fingerprint"]
    assert not list((tmp_path / "r").glob("*.part"))


@pytest.mark.parametrize("name", ["file", "file/below", "n" * 300, "r/" + "n" * 300])
def test_a_results_path_that_cannot_be_a_folder_is_refused(made, tmp_path, command, name):
    (tmp_path / "file").write_text("mine")
    done = command("sweep", str(made / "whole/study.toml"), "--results", str(tmp_path / name))
    assert done.code == 2, done.err
    assert "name another folder by --results" in done.err
    assert len(done.err.strip()) <= 300
    assert (tmp_path / "file").read_text() == "mine"
    assert [p.name for p in tmp_path.iterdir()] in (["file"], ["file", "r"], ["r", "file"])


def test_a_results_folder_whose_name_is_not_utf8(made, tmp_path, command):
    name = str(tmp_path / os.fsdecode(b"m\xfcnchen"))
    done = command("sweep", str(made / "whole/study.toml"), "--results", name)
    assert done.code == 0, done.err
    whole = made / "whole/r/results.parquet"
    assert (Path(name) / "results.parquet").read_bytes() == whole.read_bytes()
