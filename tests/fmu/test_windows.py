"""The FMU's Windows library, read by objdump.

It is the front if mingw-w64 is installed, else pythonfmu's own DLL.
"""

import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
import pythonfmu

ROOT = Path(__file__).resolve().parent.parent.parent
OF_WINDOWS = {"kernel32.dll", "advapi32.dll", "shell32.dll", "msvcrt.dll", "ucrtbase.dll"}
PYTHONFMUS_DLL = (
    Path(pythonfmu.__file__).parent / "resources" / "binaries" / "win64" / "pythonfmu-export.dll"
)


@pytest.fixture
def fmu_binary(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "fmu_src")
    from fmu_build import binary

    return binary


@pytest.fixture
def files(unpacked, tmp_path) -> Path:
    """The files that pythonfmu gives the build: its own binaries and a description."""
    for folder, suffix in (("linux64", ".so"), ("win64", ".dll")):
        (tmp_path / "binaries" / folder).mkdir(parents=True)
        own = next((PYTHONFMUS_DLL.parent.parent / folder).glob(f"*{suffix}"))
        shutil.copy(own, tmp_path / "binaries" / folder / f"RlvLanding{suffix}")
    (tmp_path / "resources").mkdir()
    shutil.copy(unpacked / "modelDescription.xml", tmp_path)
    return tmp_path


def tables(library: Path) -> tuple[set[str], set[str]]:
    """The names that a DLL exports, and the libraries that it needs."""
    text = subprocess.run(
        ["objdump", "-p", library], capture_output=True, text=True, check=True
    ).stdout
    imports, exports = text.split("[Ordinal/Name Pointer] Table", 1)
    return set(
        re.findall(r"^\s*\[ *\d+\] (?:\+base\[ *\d+\] +[0-9a-f]+ )?(\S+)$", exports, re.M)
    ), {name.lower() for name in re.findall(r"DLL Name: (\S+)", imports)}


def test_without_mingw_the_windows_library_is_pythonfmus_own(fmu_binary, files, monkeypatch):
    monkeypatch.setattr(fmu_binary, "MINGW", "no-such-compiler")
    fmu_binary.replace_binaries(files)
    assert [p.name for p in (files / "binaries" / "win64").iterdir()] == ["RlvLanding.dll"]
    assert (
        files / "binaries" / "win64" / "RlvLanding.dll"
    ).read_bytes() == PYTHONFMUS_DLL.read_bytes()


def test_windows_library_exports_what_linuxs_does_and_needs_windows_only(fmu_binary, files):
    """With mingw-w64 on this machine.

    Without it the library is pythonfmu's, which has the functions too, and needs Python.
    """
    fmu_binary.replace_binaries(files)
    exports, needs = tables(files / "binaries" / "win64" / "RlvLanding.dll")
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", files / "binaries" / "linux64" / "RlvLanding.so"],
        capture_output=True,
        text=True,
        check=True,
    )
    of_linux = {line.split()[-1] for line in listed.stdout.splitlines()}
    assert len(of_linux) == 34
    if shutil.which(fmu_binary.MINGW) is None:
        assert of_linux <= exports
        assert "python3.dll" in needs
        return
    assert exports == of_linux
    assert needs <= OF_WINDOWS
    beside = [p for p in (files / "binaries" / "win64").iterdir() if p.name != "RlvLanding.dll"]
    assert [p.read_bytes() for p in beside] == [PYTHONFMUS_DLL.read_bytes()]
    assert beside[0].name.encode() in (files / "binaries" / "win64" / "RlvLanding.dll").read_bytes()


def test_the_front_for_windows_compiles_without_a_warning_or_names_the_missing_compiler(
    fmu_binary, unpacked, tmp_path, monkeypatch
):
    root = ElementTree.parse(unpacked / "modelDescription.xml").getroot()
    (tmp_path / "variables.h").write_text(fmu_binary.variables_header(root, "pythonfmu.dll"))
    monkeypatch.setattr(fmu_binary, "FLAGS", [*fmu_binary.FLAGS, "-Werror", "-Wpedantic"])
    if shutil.which(fmu_binary.MINGW) is None:
        with pytest.raises(FileNotFoundError, match=fmu_binary.MINGW):
            fmu_binary.compile_front(tmp_path / "front.dll", tmp_path)
        return
    fmu_binary.compile_front(tmp_path / "front.dll", tmp_path)
    assert (tmp_path / "front.dll").read_bytes()[:2] == b"MZ"
