"""The results of a sweep survive Ctrl-C, SIGTERM, kill -9 and a full disk, and can be continued."""

from __future__ import annotations

import csv
import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from pyarrow import parquet
from study_tools import rows, start, wait_for, write_study

from rlv_landing.studies.sweep.result_files import Results
from rlv_landing.studies.sweep.study import read_study
from rlv_landing.studies.sweep.sweep_row import Task


def parts(folder: Path) -> list[Path]:
    return sorted((folder / "parts").glob("*.parquet"))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_an_ended_sweep_keeps_its_rows_and_resume_makes_the_rest(tmp_path, number):
    study = write_study(tmp_path, samples=20_000)
    process = start("sweep", study, "--results", "r", "--workers", 2, cwd=tmp_path)
    folder = tmp_path / "r"
    wait_for(process, lambda: bool(parts(folder)))
    process.send_signal(number)
    _, err = process.communicate(timeout=120)
    if number == signal.SIGKILL:
        assert process.returncode == -number
    else:
        assert process.returncode == 130, err
        assert "of 40000 landings are kept in r, --resume continues" in err
        assert "Traceback" not in err
    kept = [row["index"] for part in parts(folder) for row in rows(part)]
    assert kept == sorted(set(kept))
    task, results = resumed(study, folder)
    # an interrupt may lose the rows that were just being taken over
    with results:
        missing = [i for begin, end in results.missing() for i in range(begin, end)]
    assert sorted([*kept, *missing]) == list(range(len(task)))


def resumed(study: Path, folder: Path) -> tuple[Task, Results]:
    read = read_study(study)
    task = Task(read, read.design)
    return task, Results(folder, task, resume=True)


def test_resume_fills_holes_and_gives_the_file_of_an_undisturbed_run(tmp_path, command):
    study = write_study(tmp_path, samples=40)
    assert command("sweep", str(study), "--results", str(tmp_path / "whole")).code == 0
    whole = tmp_path / "whole" / "results.parquet"
    made = rows(whole)
    _, results = resumed(study, tmp_path / "r")
    with results:
        for first, last in ((0, 7), (20, 31), (50, 51)):
            results.add([list(row.values()) for row in made[first:last]])
    assert [part.stem for part in parts(tmp_path / "r")] == [
        "000000000000",
        "000000000020",
        "000000000050",
    ]
    done = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
    assert done.code == 0, done.err
    assert (tmp_path / "r" / "results.parquet").read_bytes() == whole.read_bytes()
    again = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
    assert again.code == 0, again.err
    assert (tmp_path / "r" / "results.parquet").read_bytes() == whole.read_bytes()


@contextmanager
def files_up_to(size: int) -> Iterator[None]:
    """A disk that takes no file of more than `size` bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_keeps_what_is_done_and_resume_continues_when_there_is_room(tmp_path, command):
    study = write_study(tmp_path, samples=60)
    folder = tmp_path / "r"
    with files_up_to(30_000):
        done = command("sweep", str(study), "--results", str(folder))
    assert done.code == 1, done.err
    assert (
        "cannot be written: File too large; make room; "
        f"0 of 120 landings are kept in {folder}, --resume continues" in done.err
    )
    assert len(done.err.strip().splitlines()) == 1
    assert not list(folder.rglob("*.part"))
    done = command("sweep", str(study), "--results", str(folder), "--resume")
    assert done.code == 0, done.err
    assert [row["index"] for row in rows(folder / "results.parquet")] == list(range(120))


def test_a_disk_too_full_for_the_joined_file_keeps_its_parts(tmp_path, command):
    study = write_study(tmp_path, samples=120)
    assert command("sweep", str(study), "--results", str(tmp_path / "whole")).code == 0
    made = rows(tmp_path / "whole" / "results.parquet")
    _, results = resumed(study, tmp_path / "r")
    with results:
        for first in range(0, 240, 60):
            results.add([list(row.values()) for row in made[first : first + 60]])
            results.flush()
    with files_up_to(max(part.stat().st_size for part in parts(tmp_path / "r")) + 1000):
        done = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
    assert done.code == 1, done.err
    assert "240 of 240 landings are kept" in done.err
    assert len(parts(tmp_path / "r")) == 4
    assert not list((tmp_path / "r").glob("results*"))


def test_the_joined_file_does_not_depend_on_its_parts(tmp_path, monkeypatch):
    monkeypatch.setattr("rlv_landing.studies.sweep.row_table.GROUP_ROWS", 16)
    study = write_study(tmp_path, samples=30)
    task = Task(read := read_study(study), read.design)
    made = [
        [
            i,
            task.sample(i),
            3,
            *task.rows(i, i + 1)[0].values(),
            "0",
            "why",
            *[None] * len(task.plan.responses),
        ]
        for i in range(60)
    ]
    for name, size in (("a", 60), ("b", 7)):
        _, results = resumed(study, tmp_path / name)
        with results:
            for first in range(0, 60, size):
                results.add(made[first : first + size])
                results.flush()
            results.finish()
    assert (tmp_path / "a" / "results.parquet").read_bytes() == (
        tmp_path / "b" / "results.parquet"
    ).read_bytes()
    assert parquet.ParquetFile(tmp_path / "a" / "results.parquet").num_row_groups == 4


def test_a_changed_study_is_not_resumed_and_the_change_is_named(tmp_path, command):
    study = write_study(tmp_path, samples=10)
    folder = str(tmp_path / "r")
    assert command("sweep", str(study), "--results", folder).code == 0
    before = (tmp_path / "r" / "results.parquet").read_bytes()
    refused = command("sweep", str(study), "--results", folder)
    assert refused.code == 2
    assert "--resume continues with it, --results names another folder" in refused.err
    study.write_text(
        study.read_text()
        .replace("until = 0.1", "until = 0.2")
        .replace("ground.friction = 0.4", "ground.friction = 0.5")
    )
    changed = command("sweep", str(study), "--results", folder, "--resume")
    assert changed.code == 2
    assert "holds rows of another study: until, set, parameters changed since" in changed.err
    assert (tmp_path / "r" / "results.parquet").read_bytes() == before


def test_a_comment_in_the_study_changes_nothing(tmp_path, command):
    study = write_study(tmp_path, samples=10)
    assert command("sweep", str(study), "--results", str(tmp_path / "r")).code == 0
    study.write_text("# of Monday\n" + study.read_text())
    assert command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume").code == 0


def test_a_folder_in_use_and_a_damaged_part_and_foreign_files_are_refused(tmp_path, command):
    study = write_study(tmp_path, samples=10)
    _, results = resumed(study, tmp_path / "r")
    with results:
        refused = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
        assert refused.code == 2
        assert "is in use by another sweep" in refused.err
    (tmp_path / "r" / "parts" / "000000000000.parquet").write_bytes(b"PAR1 cut")
    damaged = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
    assert damaged.code == 2
    assert "is damaged" in damaged.err
    assert "--resume makes its rows anew" in damaged.err
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").write_text("x")
    foreign = command("sweep", str(study), "--results", str(tmp_path / "mine"))
    assert foreign.code == 2
    assert "holds other files and no study" in foreign.err


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_rows_go_to_a_file_of_ones_own(tmp_path, monkeypatch, command, ending):
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path, samples=3)
    done = command("sweep", "study.toml", "--results", "r", "--output", f"rows.{ending}")
    assert (done.code, done.err) == (0, "")
    stored = parquet.read_table("r/results.parquet")
    if ending == "csv":
        with Path("rows.csv").open(newline="", encoding="utf-8") as file:
            written = list(csv.DictReader(file))
        for name in ("outcome", "legs.main_strut.force.min", "margin.stability_min"):
            expected = ["" if v is None else v for v in stored[name].to_pylist()]
            assert [type(v)(row[name]) for v, row in zip(expected, written)] == expected
        assert len(written) == stored.num_rows
    else:
        assert parquet.read_table("rows.parquet").equals(stored)
    for output, said in ((f"rows.{ending}", "--force"), ("rows.xlsx", "must end in .csv")):
        again = command("sweep", "study.toml", "--results", "r2", "--output", output)
        assert (again.code, again.err.count("\n")) == (2, 1)
        assert said in again.err
        assert not Path("r2").exists()
