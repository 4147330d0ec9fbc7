"""Many instances: in threads, in any order of creation and release, one after the other."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import fmpy
import pytest
from fmu_instance import FOLDER
from interrupting import raises_keyboard_interrupt
from python_libraries import BARE, python_libraries

from rlv_landing import Landing

SEEN = ("body.x", "body.y", "body.pitch")


@pytest.fixture
def run(host, unpacked, description):
    """Run a C host in a clean environment and return its output.

    `library` names the Python library to use. On a machine without any the host must fail with exit
    code 1.
    """

    def hosted(name: str, *arguments: object, library: str = "") -> str:
        command = [
            host(name),
            unpacked / "binaries" / "linux64" / "RlvLanding.so",
            (unpacked / "resources").as_uri(),
            description.guid,
        ]
        environment = BARE | ({"RLV_LANDING_LIBPYTHON": library} if library else {})
        done = subprocess.run(
            [*command, *map(str, arguments)],
            capture_output=True,
            text=True,
            env=environment,
            timeout=3600,
        )
        assert done.returncode == (0 if python_libraries() else 1), done.stdout + done.stderr
        return done.stdout

    return hosted


@pytest.mark.parametrize("library", python_libraries() or [""])
def test_instances_in_eight_threads_of_a_c_host_land_like_landing(run, description, library):
    first = {v.name: v.valueReference for v in description.modelVariables}[SEEN[0]]
    lines = run("threads", 8, 2, first, len(SEEN), library=library).splitlines()
    if not python_libraries():
        assert all("no Python library (libpython)" in line for line in lines)
        return
    landing = Landing()
    landing.advance_to(119 * 1e-3 + 1e-3)
    assert len(lines) == 16
    for line in lines:
        assert [float.fromhex(v) for v in line.split()] == pytest.approx(
            [landing.get(n) for n in SEEN], rel=1e-9, abs=1e-9
        )


@pytest.mark.parametrize(
    ("what", "count", "most"),
    [("instance", 2000, 256.0), ("state", 1000, 512.0), ("message", 20_000, 2.0)],
)
def test_instances_states_and_messages_leave_nothing_behind(run, what, count, most):
    """Memory comes in pages and arenas, so the bounds are a few of them; a slave takes 200 kB."""
    printed = run("many", count, what)
    assert float(printed) <= most if python_libraries() else "no instance" in printed


@pytest.mark.torture
@pytest.mark.parametrize("library", python_libraries())
@pytest.mark.parametrize("what", ["instance", "message"])
def test_very_many_instances_and_messages_leave_nothing_behind(run, many, what, library):
    """100 000 under torture: within one arena of Python's, if each part grew as the least."""
    count = many(2000) if "RLV_TORTURE" in os.environ else 400
    assert float(run("many", count, what, library=library)) * count <= 2**20


def test_instances_in_threads_of_a_python_host_land_like_landing(make):
    instances = [make() for _ in range(8)]

    def land(instance):
        instance.start()
        instance.steps(0, 150)
        return [instance.get(name) for name in SEEN]

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(land, instances))
    landing = Landing()
    landing.advance_to(149 * 1e-3 + 1e-3)
    assert found == [[landing.get(name) for name in SEEN]] * 8


@pytest.mark.parametrize("steps", [0, 5])
@pytest.mark.parametrize("terminated", [False, True])
def test_instances_may_be_freed_in_any_order_with_and_without_termination(make, steps, terminated):
    instances = [make() for _ in range(6)]
    for instance in instances:
        instance.start()
        instance.steps(0, steps)
        instance.slave.getFMUState()
    for i in (3, 0, 5, 1):
        if terminated:
            instances[i].slave.terminate()
        instances[i].free()
    instances[2].steps(steps, 20)
    landing = Landing()
    landing.advance_to(19 * 1e-3 + 1e-3)
    assert instances[2].get("body.y") == landing.get("body.y")


def test_simulations_one_after_the_other_leave_nothing_on_pythons_path(fmu):
    before = list(sys.path)
    for _ in range(3):
        fmpy.simulate_fmu(str(fmu), stop_time=0.01, output_interval=1e-3)
    assert sys.path == before


STEPPING = """
import sys, fmpy, pathlib
sys.path.insert(0, sys.argv[1])
from fmu_instance import Instance
folder = pathlib.Path(sys.argv[2])
instance = Instance(fmpy.read_model_description(str(folder)), folder)
instance.start()
instance.steps(0, 2)
try:
    print("stepping", flush=True)
    if sys.argv[3] == "one long step":
        instance.set_rate("external.force_x", 1e-3)  # a load that grows lets nothing rest
        instance.step(2e-3, 1e8)
    for k in range(2, 10**9):
        instance.step(k * 1e-3, 1e-3)
        instance.get("body.y") if instance.log == [] else None
except KeyboardInterrupt:
    print("interrupted", flush=True)
instance.slave.reset()
instance.start()
instance.steps(0, 100)
instance.slave.terminate()
instance.free()
print("landed again", flush=True)
"""


@pytest.mark.parametrize("how", ["many short steps", "one long step"])
def test_ctrl_c_reaches_the_hosts_python_and_the_instance_can_be_reset(unpacked, how):
    for _ in range(5):
        tools = str(FOLDER)
        command = [sys.executable, "-c", STEPPING, tools, str(unpacked), how]
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as process:
            try:
                assert process.stdout is not None
                assert process.stdout.readline() == "stepping\n"
                process.send_signal(signal.SIGINT)
                out, err = process.communicate(timeout=60)
            finally:
                process.kill()
        assert process.returncode == 0, err
        assert out == "interrupted\nlanded again\n"


def test_ctrl_c_at_any_moment_of_a_call_raises_keyboard_interrupt(make):
    instance = make()

    def call():
        instance.set_rate("external.force_x", random.uniform(1.0, 2.0))
        instance.step(2e-3, 1e-3)

    for _ in range(500):
        instance.slave.reset()
        instance.start()
        instance.steps(0, 2)
        assert raises_keyboard_interrupt(call, random.uniform(1e-6, 4e-4))
