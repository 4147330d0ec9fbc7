"""FMU files that `rlv-landing fmu simulate` refuses in one line, and its end by Ctrl-C."""

from __future__ import annotations

import platform
import re
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from zipfile import ZipFile

import pytest
from bridge_tools import environment

from rlv_landing import LandingError
from rlv_ros_bridge.commands.fmu import fmu as commands
from rlv_ros_bridge.fmu.description import open_description

DESCRIPTION = "modelDescription.xml"


@pytest.fixture
def changed(fmu, tmp_path) -> Callable[..., Path]:
    """Makes a copy of an FMU, with its description or library changed, and files added."""

    def made(
        change: Callable[[bytes], bytes] = bytes,
        of: Path = fmu,
        library: Callable[[bytes], bytes] = bytes,
        **added: bytes,
    ) -> Path:
        target = tmp_path / "changed.fmu"
        with ZipFile(of) as source, ZipFile(target, "w") as archive:
            for name in source.namelist():
                text = source.read(name)
                if name.startswith("binaries/"):
                    text = library(text)
                archive.writestr(name, change(text) if name == DESCRIPTION else text)
            for name, text in added.items():
                archive.writestr(name, text)
        return target

    return made


def claim(path: Path, name: str, size: int) -> None:
    """Let the archive's directory say that the last file of this name has `size` bytes."""
    content = bytearray(path.read_bytes())
    # the directory has the name 46 bytes behind the entry's start, and the size 24 bytes
    at = content.rindex(name.encode()) - 46
    assert content[at : at + 4] == b"PK\1\2"
    struct.pack_into("<I", content, at + 24, size)
    path.write_bytes(content)


def refusal(*arguments: object) -> str:
    with pytest.raises(LandingError) as refused:
        commands.main([str(a) for a in arguments], standalone_mode=False)
    message = str(refused.value)
    assert "\n" not in message
    return message


def test_a_path_that_leads_out_of_the_folder_is_refused(changed):
    path = changed(**{"/tmp/rlv_landing_out": b"x"})
    assert "is damaged: Illegal path" in refusal("simulate", path)


def test_an_archive_that_would_fill_the_disk_is_refused(changed):
    path = changed(bomb=b"x")
    claim(path, "bomb", 2**31)
    assert "MB unpacked, at most 1000 MB" in refusal("simulate", path)


@pytest.mark.parametrize("command", ["info", "simulate"])
def test_a_description_that_would_fill_the_memory_is_refused(changed, command):
    path = changed()
    claim(path, DESCRIPTION, 2**31)
    assert "its modelDescription.xml has 2147 MB" in refusal(command, path)
    with pytest.raises(LandingError):
        open_description(path)


def test_an_fmu_without_an_end_needs_one(changed):
    path = changed(lambda text: re.sub(rb"<DefaultExperiment[^>]*/>", b"", text))
    assert refusal("simulate", path).endswith("give one, for example --until 1")


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    ("library", "reason"),
    [
        # as an FMU of FMI 2.0 has it that was built on Arm
        (lambda b: b[:18] + b"\xb7\0" + b[20:], "is for another processor"),
        (lambda b: b[: len(b) // 2], "is cut short"),
        (lambda b: b[:100], "is cut short"),
        (lambda b: b"MZ" + b[2:], "is no library of Linux"),
        (lambda b: b"", "has 0 bytes, which is no library"),
    ],
)
def test_a_library_that_the_loader_cannot_take_is_refused(
    changed, fmu, fmu3, version, library, reason
):
    """The loader would say that there is no such file, or end the process."""
    message = refusal("simulate", changed(of=fmu if version == 2 else fmu3, library=library))
    assert f" {reason}; build it on this machine" in message


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_for_other_platforms_names_them_and_this_one(fmu, fmu3, version, tmp_path):
    target = tmp_path / "other.fmu"
    with ZipFile(fmu if version == 2 else fmu3) as source, ZipFile(target, "w") as archive:
        for name in source.namelist():
            archive.writestr(re.sub("binaries/[^/]+/", "binaries/win64/", name), source.read(name))
    own = "linux64" if version == 2 else f"{platform.machine()}-linux"
    message = refusal("simulate", target)
    assert f"has a library for win64, and not for {own}, which this machine is; build" in message


@pytest.mark.parametrize(
    ("text", "other", "reason"),
    [
        (rb'modelIdentifier="RlvLanding"', rb'modelIdentifier="../x"', "is no name of a library"),
        (rb'<Dimension start="4"', rb'<Dimension start="3"', "has no variable 'leg[1]."),
        (rb'<Unit name="m2">.*?</Unit>', b"", "refers to 'm2', which is not in it"),
        (rb"(</?)CoSimulation", rb"\1ModelExchange", "of FMI 3.0 without co-simulation"),
        (rb'fmiVersion="3.0"', rb'fmiVersion="3.1"', "is an FMU of FMI 3.1; FMI 2.0 or 3.0"),
    ],
)
def test_a_description_of_fmi_3_that_is_not_ours_is_refused(changed, fmu3, text, other, reason):
    path = changed(lambda found: re.sub(text, other, found, flags=re.S), of=fmu3)
    assert reason in refusal("simulate", path)


INTERRUPTED = """
import sys
from rlv_ros_bridge.fmu.runner import FmuRunner

def interrupt(frame, event, _argument):
    if event == "call" and frame.f_code.co_name == "do_step":
        sys.setprofile(None)
        raise KeyboardInterrupt

try:
    with FmuRunner(sys.argv[1], {}) as runner:
        sys.setprofile(interrupt)
        runner.advance(0.0, 1e-3)
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("version", [2, 3])
def test_ctrl_c_in_a_step_of_the_fmu_is_ctrl_c(fmu, fmu3, version):
    """It has ended the slave, so the instance cannot be terminated any more, only freed.

    In a process of its own: other tests' interpreters have other handlers of signals.
    """
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, fmu if version == 2 else fmu3],
        capture_output=True,
        text=True,
        timeout=60,
        env=environment(),
    )
    assert done.stdout.splitlines()[-1:] == ["interrupted"], done.stderr
