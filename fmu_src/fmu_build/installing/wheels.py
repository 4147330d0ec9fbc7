"""Makes the source distribution and a wheel for each platform; run by `make wheels`.

The wheel of this machine is built by pip from the source distribution. The others are the same but
for the compiled core and the FMU's front, which Zig compiles for them. The cores are of Python's
limited API, so a wheel serves Python 3.11 and later.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from ..binary import compile_fronts, made_of
from ..compilers import for_target
from ..cross.cores import compile_cores
from ..fronts.header import neutral_header
from ..fronts.prebuilt import keep
from ..sources import ROOT, source_date
from ..targets import ALL, OWN, TARGETS, own_machine, own_platform
from .neutral_fronts import describe_slave

PYTHON = "cp311-abi3"
# of each target's libraries, the platform that wheels name
TAGS = {
    "x86_64-linux": "manylinux_2_17_x86_64.manylinux2014_x86_64",
    "aarch64-linux": "manylinux_2_17_aarch64.manylinux2014_aarch64",
    "x86_64-windows": "win_amd64",
    "x86_64-darwin": "macosx_11_0_x86_64",
    "aarch64-darwin": "macosx_11_0_arm64",
}
CORE = "rlv_landing/core/"
FRONTS = "fmu_build/fronts/compiled/"


def make(folder: Path, platforms: str) -> list[Path]:
    """Make the source distribution and the wheels.

    Args:
        folder: The folder for them, which is made anew.
        platforms: This machine's or all.

    Returns:
        The files.

    Raises:
        SystemExit: This is no checkout, Python is older than 3.11, or a build fails.
    """
    if not (ROOT / "setup.py").is_file() or sys.version_info < (3, 11):
        raise SystemExit("error: wheels are made in a checkout, by Python 3.11 or newer")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    epoch = str(int(source_date().timestamp()))
    python = [sys.executable, "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps"]
    _run([sys.executable, "setup.py", "-q", "sdist", "-d", str(folder.resolve())], epoch)
    (sources,) = folder.glob("*.tar.gz")
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        work = Path(name)
        _run([*python, "-w", name, str(sources.resolve())], epoch)
        (own,) = work.glob("*.whl")
        entries = _entries(own)
        others = [t for t in TARGETS.values() if platforms == ALL and t.name != own_machine()]
        libraries = compile_cores(others, work / "cores")
        made = [_write(folder, own.name, own_machine(), entries)]
        for target, library in zip(others, libraries):
            kept = {n: c for n, c in entries.items() if not n.startswith((CORE + "comp", FRONTS))}
            kept[CORE + library.name] = library.read_bytes()
            if target.system == "linux":
                kept.update(_front(target.name, work / f"{target.name}.front"))
            made.append(_write(folder, own.name, target.name, kept))
    return [sources, *made]


def _run(command: Sequence[str], epoch: str) -> None:
    environment = {**os.environ, "SOURCE_DATE_EPOCH": epoch}
    done = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise SystemExit(f"error: {' '.join(command[1:5])} fails:\n{done.stdout}{done.stderr}")


def _entries(wheel: Path) -> dict[str, bytes]:
    """The files of a wheel, by name."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _front(target: str, folder: Path) -> dict[str, bytes]:
    """The FMU's front for another machine's Linux, as the wheel has it."""
    compiler = for_target(TARGETS[target])
    assert compiler is not None
    root: Element = describe_slave()
    folder.mkdir()
    used = compile_fronts(
        neutral_header(root), lambda platform: folder / platform, {own_platform(): [compiler]}
    )
    keep(folder, made_of(root), used)
    return {FRONTS + file.name: file.read_bytes() for file in sorted(folder.iterdir())}


def _write(folder: Path, own_name: str, target: str, entries: dict[str, bytes]) -> Path:
    """Write the wheel of a target: its name, its tags, its record.

    Args:
        folder: The folder for it.
        own_name: The name of this machine's wheel, as pip made it.
        target: The target's name.
        entries: The files of the wheel, by name.

    Returns:
        The wheel.
    """
    tag = TAGS[target]
    distribution, version, *_ = own_name.split("-")
    info = f"{distribution}-{version}.dist-info"
    lines = [n for n in entries[f"{info}/WHEEL"].decode().splitlines() if n and n[:4] != "Tag:"]
    lines += [f"Tag: {PYTHON}-{platform}" for platform in tag.split(".")]
    record = f"{info}/RECORD"
    contents = {n: c for n, c in sorted(entries.items()) if n != record}
    contents[f"{info}/WHEEL"] = ("\n".join(lines) + "\n").encode()
    rows = [f"{name},{_digest(content)},{len(content)}" for name, content in contents.items()]
    contents[record] = ("\n".join([*rows, f"{record},,"]) + "\n").encode()
    wheel = folder / f"{distribution}-{version}-{PYTHON}-{tag}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name, source_date().timetuple()[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whose modes these are
            runs = ".data/data/lib/" in name
            entry.external_attr = (0o100755 if runs else 0o100644) << 16
            archive.writestr(entry, content)
    return wheel


def _digest(content: bytes) -> str:
    """The digest of a file, as a wheel's record has it."""
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
    return f"sha256={digest}"


def main() -> None:
    """Make them in the folder that the command line names."""
    parser = argparse.ArgumentParser(prog="python -m fmu_build.installing.wheels")
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "build" / "dist")
    parser.add_argument("--platforms", choices=(OWN, ALL), default=ALL)
    arguments = parser.parse_args()
    for file in make(arguments.folder, arguments.platforms):
        target = next((t for t, tag in TAGS.items() if file.name.endswith(f"{tag}.whl")), "")
        tried = "" if not target else f" ({'' if target == own_machine() else 'built, not '}run)"
        print(f"{file}{tried}")


if __name__ == "__main__":
    main()
