"""Contents of the FMU file: needed files only, licences, documentation, reproducible bytes."""

from __future__ import annotations

import os
import re
import shutil
import struct
import subprocess
import sys
from datetime import datetime, timezone
from importlib.metadata import distribution
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import fmpy
import pytest
from lxml import etree

from rlv_landing import __version__
from rlv_landing.quantities import INPUT_QUANTITIES

ROOT = Path(__file__).resolve().parents[3]
PAGE = "documentation/index.html"


@pytest.fixture(scope="module")
def archive(fmu: Path) -> ZipFile:
    return ZipFile(fmu)


@pytest.fixture(scope="module")
def page(archive: ZipFile):
    """The documentation page, parsed as XML."""
    return etree.fromstring(archive.read(PAGE).replace(b"<!DOCTYPE html>", b""))


def test_every_file_serves_the_run_the_reader_or_the_licence(archive):
    tag = __version__.replace(".", "_")
    names = archive.namelist()
    of_pythonfmu = {n.rsplit("/", 1)[1] for n in names if "/pythonfmu/" in n}
    needed = {"default_experiment", "enums", "fmi2slave", "logmsg", "variables"}
    assert of_pythonfmu == {"__init__.py", "_version.py", *(f"{module}.py" for module in needed)}
    assert not [n for n in names if "__pycache__" in n or n.endswith((".pyc", ".pxd", ".j2", ".c"))]
    resources = {
        re.sub(r"_[0-9a-f]{12}\b", "", n.split("/")[1]) for n in names if "resources/" in n
    }
    assert resources == {
        f"rlv_landing_{tag}",
        f"landing_fmu_{tag}.py",
        "slavemodule.txt",
        "libpython.txt",
    }
    binaries = {n for n in names if n.startswith("binaries/")}
    assert {"binaries/linux64/RlvLanding.so"} <= binaries
    assert binaries <= {"binaries/linux64/RlvLanding.so", "binaries/win64/RlvLanding.dll"}
    assert {n.split("/")[0] for n in names} == {
        "binaries",
        "documentation",
        "model.png",
        "modelDescription.xml",
        "resources",
    }


def test_entries_are_sorted_deflated_of_one_date_and_with_modes(archive, fmu):
    made = datetime.fromisoformat(
        fmpy.read_model_description(str(fmu)).generationDateAndTime.replace("Z", "+00:00")
    )
    entries = archive.infolist()
    assert [e.filename for e in entries] == sorted(e.filename for e in entries)
    for e in entries:
        assert e.compress_type == ZIP_DEFLATED
        assert abs((datetime(*e.date_time, tzinfo=timezone.utc) - made).total_seconds()) < 2.0
        assert e.external_attr >> 16 == (
            0o100755 if e.filename.endswith((".so", ".dll")) else 0o100644
        ), e.filename


def test_licences_and_changes_are_in_it(archive):
    assert archive.read("documentation/licenses/LICENSE") == (ROOT / "LICENSE").read_bytes()
    installed = [p for p in distribution("pythonfmu").files or () if p.name == "LICENSE"]
    assert archive.read("documentation/licenses/pythonfmu-LICENSE").decode() == installed[
        0
    ].read_text(encoding="utf-8")
    assert b"Permission is hereby granted" in archive.read(
        "documentation/licenses/pythonfmu-LICENSE"
    )
    assert archive.read("documentation/CHANGELOG.md").startswith(b"# Changelog")


def test_icon_is_a_png_of_400_by_400_without_date_or_software(archive):
    data = archive.read("model.png")
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == (400, 400)
    assert b"tEXt" not in data
    assert b"tIME" not in data


def test_page_stands_alone(page, archive):
    assert page.xpath("//script") == []
    assert page.xpath("//@src") == []
    targets = set(page.xpath("//a/@href"))
    assert {t for t in targets if t.startswith("#")} <= {f"#{name}" for name in page.xpath("//@id")}
    assert all(f"documentation/{t}" in archive.namelist() for t in targets if not t.startswith("#"))
    assert b"@import" not in archive.read(PAGE)
    assert b"url(http" not in archive.read(PAGE)


def test_page_shows_a_drawing_and_the_equations(page):
    math = "{http://www.w3.org/1998/Math/MathML}math"
    assert len(page.findall(f".//{math}")) == 13
    texts = set(page.xpath("//figure//*[local-name()='text']/text()"))
    assert {
        "main strut with damper",
        "auxiliary strut",
        "footpad",
        "CG of the upper mass",
        "1",
        "2",
        "3",
        "4",
    } <= {t.strip() for t in texts}


def test_page_lists_every_variable_with_unit_bounds_and_default_as_the_description_has_them(
    page, fmu
):
    """Leg 1 stands for all legs."""
    shown = {
        row[0].text: [cell.text or "" for cell in row]
        for row in page.xpath("//tbody/tr[td[@class='id']]")
    }
    variables = {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}
    assert set(shown) == {
        name
        for name in variables
        if not name.removeprefix("peak.").startswith(("leg[2]", "leg[3]", "leg[4]"))
    }
    for name, cells in shown.items():
        v = variables[name]
        assert cells[1] == v.type
        assert cells[-1] == v.description
        assert v.unit is None or v.unit in cells
        assert v.displayUnit is None or v.displayUnit in cells
        if v.type == "Real" and v.causality not in ("output", "local"):
            assert float(cells[2]) == pytest.approx(float(v.start), rel=1e-5)
            assert [float(b) for b in cells[5].split(" ... ")] == [float(v.min), float(v.max)]
        if v.causality == "output":
            assert cells[4] == (
                "0 ... 3" if name == "status.phase" else "" if v.min is None else "at least 0"
            )
    assert {q.name for q in INPUT_QUANTITIES} <= set(shown)


def build(target: Path, **environment: str) -> bytes:
    subprocess.run(
        [sys.executable, "-m", "fmu_build.build", str(target)],
        cwd=ROOT,
        check=True,
        capture_output=True,
        timeout=300,
        env={**os.environ, "PYTHONPATH": "fmu_src", **environment},
    )
    return target.read_bytes()


def test_two_builds_of_the_same_sources_give_the_same_bytes(tmp_path):
    """Whatever the order of sets, the time zone and the temporary folder."""
    (tmp_path / "elsewhere").mkdir()
    date = {"SOURCE_DATE_EPOCH": "1700000001"}
    first = build(tmp_path / "a.fmu", PYTHONHASHSEED="1", TZ="UTC", **date)
    second = build(
        tmp_path / "b.fmu",
        PYTHONHASHSEED="2",
        TZ="Asia/Tokyo",
        TMPDIR=str(tmp_path / "elsewhere"),
        **date,
    )
    assert first == second
    assert (
        fmpy.read_model_description(str(tmp_path / "a.fmu")).generationDateAndTime
        == "2023-11-14T22:13:21Z"
    )


DATE = "from fmu_build import build; print(build.source_date().isoformat())"


@pytest.mark.parametrize(
    ("committed", "epoch", "expected"),
    [
        (True, "1700000001", "2023-11-14T22:13:21+00:00"),
        (True, "", "2020-02-03T04:05:06+00:00"),
        (False, "", "1980-01-01T00:00:00+00:00"),
        (True, "0", "1980-01-01T00:00:00+00:00"),
    ],
)
def test_date_is_that_of_the_environment_else_of_the_last_commit_else_a_constant(
    tmp_path, committed, epoch, expected
):
    done = source_date(tmp_path, committed=committed, epoch=epoch)
    assert (done.returncode, done.stdout.strip()) == (0, expected), done.stderr


@pytest.mark.parametrize("epoch", ["yesterday", "-5", "1e9", "99999999999"])
def test_bad_source_date_is_refused_with_what_to_do(tmp_path, epoch):
    done = source_date(tmp_path, committed=True, epoch=epoch)
    assert done.returncode == 1
    assert done.stderr.startswith(f"error: SOURCE_DATE_EPOCH = {epoch!r}")
    assert "leave it out" in done.stderr


def source_date(folder: Path, *, committed: bool, epoch: str) -> subprocess.CompletedProcess[str]:
    """The date that a copy of the build scripts finds in `folder`, a git repository or none."""
    shutil.copytree(
        ROOT / "fmu_src" / "fmu_build",
        folder / "fmu_src" / "fmu_build",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    environment = {
        **os.environ,
        "SOURCE_DATE_EPOCH": epoch,
        "GIT_CEILING_DIRECTORIES": str(folder.parent),
    }
    if committed:
        git = [
            "git",
            "-c",
            "user.name=n",
            "-c",
            "user.email=e@example.org",
            "-c",
            "commit.gpgsign=false",
        ]
        subprocess.run([*git, "init", "-q", "."], cwd=folder, check=True)
        dated = {
            **environment,
            "GIT_COMMITTER_DATE": "2020-02-03T05:05:06+01:00",
            "GIT_AUTHOR_DATE": "2019-01-01T00:00:00+00:00",
        }
        subprocess.run(
            [*git, "commit", "-q", "--allow-empty", "--no-verify", "-m", "a date"],
            cwd=folder,
            check=True,
            env=dated,
        )
    return subprocess.run(
        [sys.executable, "-c", DATE],
        cwd=folder / "fmu_src",
        capture_output=True,
        text=True,
        env=environment,
        timeout=120,
    )
