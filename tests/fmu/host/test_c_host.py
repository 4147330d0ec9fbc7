"""The FMU in a host written in C, which has no Python: the FMU brings its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from python_libraries import BARE, python_libraries

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUT_NAMES

STEPS, EVERY = 400, 100
MISSING = "no Python library (libpython) of 3.10 to 3.14 was found for this process"


@pytest.fixture
def land(host, unpacked, description):
    """Lands the FMU in `folder` in a C host of its own process."""
    first = {v.name: v.valueReference for v in description.modelVariables}["body.x"]

    def run(
        folder: Path = unpacked,
        uri: str = "",
        steps: int = STEPS,
        stdin: int | None = None,
        **environment: str,
    ) -> subprocess.CompletedProcess[str]:
        command = [
            host("land"),
            folder / "binaries" / "linux64" / "RlvLanding.so",
            uri or (folder / "resources").as_uri(),
        ]
        numbers = [description.guid, str(steps), str(min(steps, EVERY)), str(first), "10"]
        return subprocess.run(
            [*command, *numbers],
            stdin=stdin,
            capture_output=True,
            text=True,
            env=BARE | environment,
            timeout=120,
        )

    return run


def assert_landed_or_logged_what_is_missing(
    done: subprocess.CompletedProcess[str], steps: int = STEPS
) -> None:
    """The host's numbers are `Landing`'s.

    On a machine without any libpython the host does not crash, and its log names what was tried.
    """
    if not python_libraries() and done.returncode == 1:
        assert MISSING in done.stdout
        assert all(f"libpython3.{minor}.so.1.0" in done.stdout for minor in range(10, 15))
        assert "set RLV_LANDING_LIBPYTHON to the path of one" in done.stdout
        return
    assert done.returncode == 0, done.stdout + done.stderr
    landing = Landing()
    *lines, _ = [line for line in done.stdout.splitlines() if not line.startswith("log ")]
    assert len(lines) == steps // min(steps, EVERY)
    for line in lines:
        k, *values = line.split()[1:]
        landing.advance_to((int(k) - 1) * 1e-3 + 1e-3)
        for name, theirs, ours in zip(OUTPUT_NAMES, values, landing.values()):
            assert float.fromhex(theirs) == pytest.approx(ours, rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize("library", python_libraries() or ["/nowhere/libpython3.13.so.1.0"])
def test_a_c_host_lands_like_landing_with_every_python_of_the_machine(land, library):
    """With the compiled core where the FMU has one for that Python.

    An FMU that Python 3.11 or newer built has one for all versions from 3.11 on.
    """
    done = land(RLV_LANDING_LIBPYTHON=library)
    if library.startswith("/nowhere/"):
        assert done.returncode == 1
        assert f"RLV_LANDING_LIBPYTHON = {library}: no such file" in done.stdout
        return
    assert_landed_or_logged_what_is_missing(done)
    minor = int(library.split("libpython3.")[1].split(".")[0])
    compiled = minor >= 11 if sys.version_info >= (3, 11) else minor == 10
    assert done.stdout.splitlines()[-1] == ("compiled core" if compiled else "pure core")


def test_fifty_c_hosts_in_a_row_end_well_without_any_variable_set(land):
    for _ in range(50):
        assert_landed_or_logged_what_is_missing(land(steps=5), steps=5)


@pytest.mark.parametrize(
    "name", ["two words", "ü", "(1)", "a#b", "50%", "%41", "quote'\"", "+&;$=@,~"]
)
@pytest.mark.parametrize("escaped", [True, False])
def test_folders_may_have_any_name(land, unpacked, tmp_path, name, escaped):
    folder = tmp_path / name
    shutil.copytree(unpacked, folder)
    done = land(
        folder, (folder / "resources").as_uri() if escaped else str(folder / "resources"), steps=20
    )
    assert_landed_or_logged_what_is_missing(done, steps=20)


FORMS = ["{}", "file:{}", "file://{}", "FILE://{}", "file:///{}", "file://localhost{}", "{}/"]


@pytest.mark.parametrize("form", [*FORMS, "File://LocalHost{}"])
@pytest.mark.parametrize("folder", ["resources", ""])
def test_the_resources_or_their_fmu_may_be_named_in_every_usual_form(land, unpacked, form, folder):
    done = land(uri=form.format(unpacked / folder), steps=1)
    assert_landed_or_logged_what_is_missing(done, steps=1)
    assert "logStatusWarning" not in done.stdout


@pytest.mark.parametrize("form", ["file:{}", "file://{}", "file:///{}"])
def test_the_path_of_a_uri_may_lack_its_first_slash(land, unpacked, form):
    """As in file://tmp/fmu/resources."""
    done = land(uri=form.format(str(unpacked / "resources").lstrip("/")), steps=1)
    assert_landed_or_logged_what_is_missing(done, steps=1)
    assert "logStatusWarning" not in done.stdout


@pytest.mark.parametrize("uri", ["file:///nowhere/resources", "http://example.org/", "NULL"])
def test_resources_that_are_not_where_the_host_says_are_found_from_the_binarys_place(
    land, unpacked, uri
):
    done = land(uri=uri, steps=5)
    assert_landed_or_logged_what_is_missing(done, steps=5)
    reason = (
        f"the location of the FMU's resources, {uri}, does not lead to them; "
        f"{(unpacked / 'resources').resolve()} is taken"
    )
    assert f"log 1 logStatusWarning land: {reason}" in done.stdout


def test_wrong_resources_of_a_binary_that_is_not_in_the_fmu_are_an_error_that_names_them(
    land, unpacked, tmp_path
):
    elsewhere = tmp_path / "binaries" / "linux64"
    elsewhere.mkdir(parents=True)
    shutil.copy(unpacked / "binaries" / "linux64" / "RlvLanding.so", elsewhere)
    done = land(tmp_path, uri="file:///nowhere/resources")
    assert done.returncode == 1
    reason = "the location of the FMU's resources, file:///nowhere/resources, does not lead to them"
    assert f"log 3 logStatusError land: {reason} (no landing_fmu_" in done.stdout


@pytest.mark.parametrize(
    ("library", "fault"),
    [
        ("/nowhere/libpython3.12.so.1.0", "no such file"),
        ("libm.so.6", "not Python 3.10 or newer"),
        ("/etc/passwd", "cannot be loaded"),
    ],
)
def test_a_bad_library_is_an_error_that_names_it_and_the_remedy(land, library, fault):
    done = land(RLV_LANDING_LIBPYTHON=library)
    assert done.returncode == 1
    assert (
        f"{MISSING}; RLV_LANDING_LIBPYTHON = {library}: {fault}; "
        "set RLV_LANDING_LIBPYTHON to the path of one" in done.stdout
    )


@pytest.mark.skipif(not python_libraries(), reason="no libpython that could be started")
def test_a_stream_that_ends_python_is_an_error_and_does_not_end_the_host(land, tmp_path):
    """Python before 3.14 exits the process where standard input is a directory."""
    folder = os.open(tmp_path, os.O_RDONLY)
    try:
        done = land(stdin=folder)
    finally:
        os.close(folder)
    assert done.returncode == 1
    assert "standard input of this process is a directory" in done.stdout
    assert done.stderr == ""


@pytest.mark.parametrize(
    "environment",
    [
        {"PYTHONHOME": "/nowhere"},
        {"PYTHONPATH": "/nowhere"},
        {"LC_ALL": "C"},
        {"LC_ALL": "C.UTF-8"},
    ],
)
def test_the_hosts_environment_does_not_reach_the_fmus_python(land, environment):
    assert_landed_or_logged_what_is_missing(land(steps=5, **environment), steps=5)


@pytest.fixture
def venv_that_ends_python(tmp_path) -> Path:
    """A venv whose site-packages end every Python that reads them.

    A `.pth` file that starts Python anew does that to an embedded Python.
    """
    venv = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(venv)], check=True)
    site_packages = next(venv.glob("lib/python3*/site-packages"))
    (site_packages / "ends.pth").write_text("import os; os._exit(99)\n")
    assert subprocess.run([venv / "bin" / "python3", "-c", ""]).returncode == 99
    return venv


def test_a_pth_that_ends_or_restarts_python_does_not_reach_the_host(land, venv_that_ends_python):
    for venv in (venv_that_ends_python, Path(sys.prefix)):
        path = f"{venv}/bin{os.pathsep}{BARE['PATH']}"
        assert_landed_or_logged_what_is_missing(
            land(steps=5, PATH=path, VIRTUAL_ENV=str(venv)), steps=5
        )


def test_the_library_of_python3_on_path_is_the_last_resort(land, unpacked, tmp_path):
    """Without a recorded libpython, and without one that the loader finds.

    The loader does not look where pyenv and conda put theirs.
    """
    folder, empty, shims = tmp_path / "fmu", tmp_path / "empty", tmp_path / "shims"
    shutil.copytree(unpacked, folder)
    (folder / "resources" / "libpython.txt").unlink(missing_ok=True)
    empty.mkdir()
    for minor in range(10, 15):
        (empty / f"libpython3.{minor}.so.1.0").touch()
    shims.mkdir()
    (shims / "python3").write_text(
        f'#!/bin/sh\nunset LD_LIBRARY_PATH\nexec "{sys.executable}" "$@"\n'
    )
    (shims / "python3").chmod(0o755)
    done = land(
        folder, steps=5, LD_LIBRARY_PATH=str(empty), PATH=f"{shims}{os.pathsep}{BARE['PATH']}"
    )
    assert_landed_or_logged_what_is_missing(done, steps=5)
    without = land(folder, steps=5, LD_LIBRARY_PATH=str(empty), PATH="/nowhere")
    assert without.returncode == 1
    assert "RLV_LANDING_LIBPYTHON: not set; the loader's libpython3." in without.stdout
    assert all(
        f"; the loader's libpython3.{minor}.so.1.0: cannot be loaded" in without.stdout
        for minor in range(10, 15)
    )
    assert (
        "; python3 on PATH: none that names its library; set RLV_LANDING_LIBPYTHON"
        in without.stdout
    )
