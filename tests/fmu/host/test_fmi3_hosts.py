"""The FMU of FMI 3.0 in hosts written in C, which have no Python, and no callbacks."""

from __future__ import annotations

import subprocess

import pytest
from python_libraries import BARE, python_libraries

from rlv_landing import Landing

pytestmark = pytest.mark.skipif(not python_libraries(), reason="no libpython on this machine")


@pytest.fixture
def run(host, unpacked3, description3):
    """Runs a host of its own process on the FMU; returns the lines that it prints."""

    def lines(name: str, *arguments: int) -> list[str]:
        binary = unpacked3 / "binaries" / "x86_64-linux" / "RlvLanding.so"
        command = [host(name), binary, f"{unpacked3 / 'resources'}/"]
        done = subprocess.run(
            [*command, description3.instantiationToken, *map(str, arguments)],
            capture_output=True,
            text=True,
            env=BARE | {"RLV_LANDING_LIBPYTHON": python_libraries()[-1]},
            timeout=120,
        )
        assert done.returncode == 0, (done.returncode, done.stdout[-300:], done.stderr[-300:])
        return done.stdout.splitlines()

    return lines


@pytest.fixture(scope="module")
def references(description3) -> dict[str, int]:
    return {v.name: v.valueReference for v in description3.modelVariables}


def test_many_instances_in_threads_land_like_landing_through_events_and_states(run, references):
    """Within rounding: they are left at events, and half of them are moved by a state."""
    lines = run("land3", 3, 2, references["leg.main_strut.force"])
    landing = Landing()
    landing.advance_to(0.4)
    expected = [landing.get(f"leg[{leg}].main_strut.force") for leg in (1, 2, 3, 4)]
    assert len(lines) == 6
    for line in lines:
        events, *values = line.split()
        assert events == lines[0].split()[0] == "6"
        assert [float.fromhex(v) for v in values] == pytest.approx(expected, rel=1e-9)


@pytest.mark.torture
def test_calls_of_any_order_and_arguments_never_end_the_host(run, references, many):
    for seed in range(many(2)):
        counts, landed = run("random3", seed, 2000, references["time"])
        ok, _, _, errors, fatal = map(int, counts.split())
        assert ok > 100
        assert errors > 100
        assert fatal == 0
        assert landed == "2 events"
