"""The FMU's state: get, set, serialise, and restore in another process.

Bytes that are no state are refused.
"""

from __future__ import annotations

import json
import random
import struct
import subprocess
import sys
from ctypes import byref, c_size_t, c_void_p

import pytest
from fmpy import fmi2
from fmu_instance import DISCARD, ERROR, FOLDER, OK

from rlv_landing import Landing

SEEN = ("body.x", "body.y", "leg[3].main_strut.stroke", "leg[2].contact.force_x", "energy.balance")
HEADER = struct.Struct("<8sQ40sQdQ")

OTHER_PROCESS = """
import sys, fmpy, pathlib
sys.path.insert(0, sys.argv[1])
from fmu_instance import Instance
folder, data = pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]).read_bytes()
instance = Instance(fmpy.read_model_description(str(folder)), folder)
instance.slave.setFMUState(instance.slave.deSerializeFMUstate(data))
instance.steps(150, 400)
print(*(instance.get(name).hex() for name in sys.argv[4:]))
instance.slave.terminate()
instance.free()
"""


@pytest.fixture
def data(instance) -> bytes:
    """The state in mid-contact, under load."""
    instance.start(**{"ground.friction": 0.35})
    instance.steps(0, 100)
    instance.set("external.force_x", 50.0)
    instance.steps(100, 150)
    return instance.slave.serializeFMUstate(instance.slave.getFMUState())


def deserialise(instance, data: bytes) -> tuple[int, c_void_p]:
    state = c_void_p()
    return instance.status(
        "fmi2DeSerializeFMUstate", (fmi2.fmi2Byte * len(data))(*data), len(data), byref(state)
    ), state


def checksum(data: bytes) -> int:
    """FNV-1a, 64 bit."""
    total = 14695981039346656037
    for byte in data:
        total = (total ^ byte) * 1099511628211 % 2**64
    return total


def forged(data: bytes, content: bytes) -> bytes:
    """`data` with other content, and all that the front checks put right."""
    magic, _, guid, _, time, phase = HEADER.unpack(data[: HEADER.size])
    rest = HEADER.pack(magic, 0, guid, len(content), time, phase)[16:] + content
    return magic + struct.pack("<Q", checksum(rest)) + rest


def test_another_process_goes_on_with_the_very_same_digits(instance, data, unpacked, tmp_path):
    instance.steps(150, 400)
    file = tmp_path / "state"
    file.write_bytes(data)
    command = [
        sys.executable,
        "-c",
        OTHER_PROCESS,
        str(FOLDER),
        str(unpacked),
        str(file),
        *SEEN,
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [instance.get(name).hex() for name in SEEN]


def test_a_serialised_state_is_json_and_holds_no_code(data):
    """So that reading a state from an untrusted source runs nothing."""
    content = json.loads(data[HEADER.size :])
    assert content["parameters"] == {"ground.friction": 0.35}
    assert content["landing"][0] == pytest.approx(0.15)


def test_damaged_bytes_are_an_error_with_a_reason_and_the_landing_goes_on(instance, data):
    generator = random.Random(1)
    bad = [
        data[:n] for n in (0, 1, 8, HEADER.size - 1, HEADER.size, HEADER.size + 1, len(data) - 1)
    ]
    bad += [generator.randbytes(n) for n in (1, 100, 10_000)]
    for _ in range(60):
        at = generator.randrange(len(data))
        bad.append(data[:at] + bytes([data[at] ^ 1 << generator.randrange(8)]) + data[at + 1 :])
    for bytes_ in bad:
        status, state = deserialise(instance, bytes_)
        assert status == ERROR
        assert not state
        assert f"fmi2DeSerializeFMUstate: the {len(bytes_)} bytes are " in instance.reason()
    instance.steps(150, 160)


def test_a_state_of_another_build_is_refused_by_name(instance, data):
    other = forged(data.replace(data[16:24], b"d0000000", 1), data[HEADER.size :])
    assert deserialise(instance, other)[0] == ERROR
    assert "are a state of another build or version" in instance.reason()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\xff",
        b"not json",
        b"[1, 2]",
        b"{}",
        b'{"landing": null}',
        b"NUMBERS",
        b"SHORT",
        b"NAN",
        b"PARAMETER",
        b"1" * 5000,
        b"[" * 100_000,
    ],
)
def test_content_that_is_no_state_is_an_error_with_a_reason_and_changes_nothing(
    instance, data, content
):
    good = json.loads(data[HEADER.size :])
    changed = {
        b"NUMBERS": good | {"landing": ["a"] * len(good["landing"])},
        b"SHORT": good | {"landing": good["landing"][:-1]},
        b"NAN": good | {"landing": [float("nan")] * len(good["landing"])},
        b"PARAMETER": good | {"parameters": {"ground.friction": "rough"}},
    }
    if content in changed:
        content = json.dumps(changed[content]).encode()
    before = [instance.get(name) for name in SEEN]
    status, state = deserialise(instance, forged(data, content))
    assert status == OK
    assert instance.status("fmi2SetFMUstate", state) == ERROR
    assert instance.reason()
    assert [instance.get(name) for name in SEEN] == before
    instance.steps(150, 400)
    landed = [instance.get(name) for name in SEEN]
    instance.slave.setFMUState(instance.slave.deSerializeFMUstate(data))
    instance.steps(150, 400)
    assert [instance.get(name) for name in SEEN] == landed


def test_a_freed_state_is_gone_and_a_given_one_is_taken_anew(instance):
    instance.start()
    state = c_void_p()
    assert instance.status("fmi2GetFMUstate", byref(state)) == OK
    instance.steps(0, 50)
    assert instance.status("fmi2GetFMUstate", byref(state)) == OK
    later = instance.get("body.y")
    instance.steps(50, 60)
    assert instance.status("fmi2SetFMUstate", state) == OK
    assert instance.get("body.y") == later
    kept = c_void_p(state.value)
    assert instance.status("fmi2FreeFMUstate", byref(state)) == OK
    assert not state
    assert instance.status("fmi2FreeFMUstate", byref(state)) == OK
    assert instance.status("fmi2FreeFMUstate", byref(kept)) == ERROR
    assert instance.status("fmi2SetFMUstate", kept) == ERROR


def test_a_buffer_too_small_for_a_serialised_state_is_an_error(instance):
    instance.start()
    state, size = instance.slave.getFMUState(), c_size_t()
    assert instance.status("fmi2SerializedFMUstateSize", state, byref(size)) == OK
    room = (fmi2.fmi2Byte * size.value)()
    assert instance.status("fmi2SerializeFMUstate", state, room, size.value - 1) == ERROR
    assert (
        f"size = {size.value - 1} bytes is too small, {size.value} are needed" in instance.reason()
    )
    assert instance.status("fmi2SerializeFMUstate", state, room, size.value) == OK


def test_a_state_holds_the_phase_of_the_instance(make):
    instance, other = make(), make()
    instance.slave.enterInitializationMode()
    early = instance.slave.serializeFMUstate(instance.slave.getFMUState())
    instance.slave.exitInitializationMode()
    instance.steps(0, 10)
    late = instance.slave.getFMUState()
    other.slave.setFMUState(late)
    other.steps(10, 20)
    instance.steps(10, 20)
    assert other.get("body.y") == instance.get("body.y")
    other.slave.setFMUState(other.slave.deSerializeFMUstate(early))
    assert other.step(0.0, 1e-3) == ERROR
    other.set("ground.friction", 0.1)
    other.slave.exitInitializationMode()
    other.steps(0, 10)


def test_a_landing_that_has_broken_off_says_so_until_a_state_is_restored(instance):
    instance.start()
    instance.steps(0, 150)
    good, time = instance.slave.getFMUState(), 0.151
    instance.set("ground.heave", 1e-3)
    failed = instance.step(0.15, 1e-3)
    # a new position after 1 ms is reached within 1 ms
    instance.set("ground.heave", 100.0)
    while failed == OK and time < 1.0:
        failed = instance.step(time, 1e-3)
        time += 1e-3
    assert failed == ERROR
    assert instance.reason().startswith("the integrator")
    assert "the landing has ended there: restore a state, or reset" in instance.reason()
    assert instance.step(time - 1e-3, 1e-3) == ERROR
    assert (
        instance.status(
            "fmi2GetReal",
            (fmi2.fmi2ValueReference * 1)(instance.vr["body.y"]),
            1,
            (fmi2.fmi2Real * 1)(),
        )
        == ERROR
    )
    instance.slave.setFMUState(good)
    instance.steps(150, 160)
    landing = Landing()
    landing.advance_to(159 * 1e-3 + 1e-3)
    assert instance.get("body.y") == landing.get("body.y")
    assert instance.step(0.5, 1e-3) == DISCARD
