"""A host that has its own Python: ended while instances live, started again, sub-interpreters."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from python_libraries import BARE, python_libraries

LIBRARIES = python_libraries()
ENDED = "log 3 logStatusError landed: the Python of this process has ended"


@pytest.fixture(params=LIBRARIES or [""])
def run(request, host, unpacked, description):
    """Run the host's scenario with each Python of this machine; return the lines it prints."""
    library = request.param
    if not library:
        pytest.skip("no Python library (libpython) on this machine")

    def scenario(name: str) -> list[str]:
        command = [
            host("python_host"),
            unpacked / "binaries" / "linux64" / "RlvLanding.so",
            (unpacked / "resources").as_uri(),
            description.guid,
            library,
            name,
        ]
        home = {"PYTHONHOME": str(Path(library).parent.parent)} if "/" in library else {}
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, env=BARE | home)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout.splitlines()

    scenario.minor = int(library.split("libpython3.")[1].split(".")[0])
    return scenario


def calls(lines: list[str]) -> list[str]:
    return [line for line in lines if not line.startswith("log ")]


BEGINNING = ["instance with the lock: ok", "step with the lock: ok", "step without the lock: ok"]


def test_calls_after_the_end_of_the_hosts_python_are_errors_and_the_instance_can_be_freed(run):
    """The usual order of static objects in C++."""
    lines = run("end")
    assert calls(lines) == [*BEGINNING, "step after the end: error", "terminate: error", "end"]
    assert any(line.startswith(ENDED) for line in lines)


def test_a_python_that_was_ended_and_started_again_has_new_instances_and_lost_ones(run):
    assert calls(run("again")) == [
        *BEGINNING,
        "step after the end: error",
        "step in the second life: error",
        "instance in the second life: ok",
        "step of the second: ok",
        "terminate: error",
        "end",
    ]


def test_calls_in_a_sub_interpreter_are_errors_and_the_instance_goes_on_in_the_main_one(run):
    """Before Python 3.12 also in the main one, as long as there is another."""
    lines = run("sub-interpreter")
    beside = "ok" if run.minor >= 12 else "error"
    assert calls(lines) == [
        *BEGINNING,
        "step in a sub-interpreter: error",
        "instance in a sub-interpreter: error",
        f"step beside a sub-interpreter: {beside}",
        "step after a sub-interpreter: ok",
        "step after the end: error",
        "terminate: error",
        "end",
    ]
    reason = (
        "this thread is in a sub-interpreter of Python; call the FMU from the main interpreter"
        if run.minor >= 12
        else "this process has several Python interpreters, with which the FMU works from Python "
        "3.12 on"
    )
    assert f"log 3 logStatusError other: {reason}" in lines


def test_a_library_in_a_namespace_of_its_own_is_refused(run):
    lines = run("dlmopen")
    assert calls(lines) == ["instance: error"]
    assert "loaded to a namespace of its own (dlmopen)" in lines[0]
