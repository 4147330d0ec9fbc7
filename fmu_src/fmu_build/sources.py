"""The files that an FMU is made of, in a checkout and in an installed package.

The package's wheel carries those that are no part of a Python package in the folder `carried`
(`carry`, called by setup.py), by the same paths as in the checkout.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from datetime import datetime, timezone
from pathlib import Path

from .core_source import package_name
from .wanted import Wanted

HERE = Path(__file__).parent.parent
ROOT = HERE.parent
PACKAGE = HERE / "rlv_landing"
CARRIED = Path(__file__).parent / "carried"
TO_CARRY = ("CHANGELOG.md", "LICENSE", "fmu_src/landing_fmu.py", "fmu_src/fmu_front")
# of the bridge, those that users copy and edit
ROS_FILES = ("launch", "config")
DATE = "date.txt"
# what the slave needs of the package: files, and folders with all their files
MODULES = (
    "__init__.py",
    "errors.py",
    "touchdown.py",
    "outputs.py",
    "state.py",
    "interruptible.py",
    "landing.py",
    "hosted.py",
)
FOLDERS = ("quantities", "parameters", "assembly", "inputs", "events", "core")
# dates that a zip file can hold, 1980 to 2107 [s since 1970]; 1980 also for sources without a date
OLDEST, NEWEST = 315532800, 4354819199


SCRIPT = """\
from {package}.slave import RlvLanding

__all__ = ["RlvLanding"]
"""


def source(path: str) -> Path:
    """A file or folder of the sources.

    Args:
        path: Its path in the checkout.
    """
    return (CARRIED if CARRIED.is_dir() else ROOT) / path


def carry(package: Path) -> None:
    """Copy what the FMU's build needs into an `fmu_build` that is to be installed.

    Args:
        package: The folder of that `fmu_build`.
    """
    folder = package / CARRIED.name
    shutil.rmtree(folder, ignore_errors=True)
    for path in TO_CARRY:
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if source(path).is_dir():
            shutil.copytree(source(path), target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copyfile(source(path), target)
    (folder / DATE).write_text(f"{int(source_date().timestamp())}\n")


def carry_examples(folder: Path) -> None:
    """Copy the examples, and launch file and layouts of the bridge, into a package.

    Args:
        folder: The folder for them, which is made anew.
    """
    shutil.rmtree(folder, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "examples", folder, ignore=ignored)
    for part in ROS_FILES:
        shutil.copytree(ROOT / "ros_bridge" / part, folder / "ros2" / part, ignore=ignored)


def version() -> str:
    """The package's version, from its `__init__.py`."""
    found = re.search(r'^__version__ = "(.+)"$', (PACKAGE / "__init__.py").read_text(), re.M)
    if found is None:
        raise SystemExit("error: rlv_landing/__init__.py states no __version__")
    return found[1]


def source_date() -> datetime:
    """The date of the sources [UTC].

    SOURCE_DATE_EPOCH of the environment, else the date of the last git commit, or the one that an
    installed package or a source distribution carries, else 1980-01-01.

    Raises:
        SystemExit: SOURCE_DATE_EPOCH is no number of seconds that a zip file can hold.
    """
    text = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not text and source(DATE).is_file():
        text = source(DATE).read_text()
    if not text and (ROOT / ".git").exists():
        try:
            text = subprocess.run(
                ["git", "log", "-1", "--format=%ct"],
                cwd=ROOT,
                capture_output=True,
                text=True,
                check=True,
            ).stdout
        except (OSError, subprocess.CalledProcessError):
            text = ""
    if text and not (re.fullmatch(r"\d+\s*", text) and int(text) <= NEWEST):
        raise SystemExit(
            f"error: SOURCE_DATE_EPOCH = {text!r} is not a number of seconds from 1970-01-01 "
            "to 2107; leave it out or correct it"
        )
    return datetime.fromtimestamp(max(int(text or OLDEST), OLDEST), timezone.utc)


def compiled_cores() -> list[Path]:
    """The compiled cores for all Python versions, but none that older kernels were compiled to."""
    return [
        file
        for file in sorted((PACKAGE / "core").iterdir())
        if file.suffix in (".so", ".pyd") and package_name().encode() in file.read_bytes()
    ]


def copy_sources(folder: Path, wanted: Wanted) -> tuple[Path, Path]:
    """Copy slave and package to `folder`; return pythonfmu's script and the package.

    Their names carry the version; `identify` adds the build.

    Raises:
        SystemExit: There is no compiled core of the present kernels, though one is wanted.
    """
    name = "rlv_landing_" + re.sub(r"\W", "_", version())
    package = folder / name
    package.mkdir()
    cores = [] if wanted.pure else compiled_cores()
    if not cores and not wanted.pure:
        from rlv_landing.core.freshness import how_to_compile

        raise SystemExit(
            "error: there is no compiled core of the present kernels: see why the compiler failed, "
            f"or compile it: {how_to_compile()}; --pure builds an FMU without "
            "it, which lands to the same digits and takes ten times as long"
        )
    modules = [PACKAGE / name for name in MODULES]
    in_folders = [file for name in FOLDERS for file in sorted((PACKAGE / name).rglob("*.py"))]
    for file in [*modules, *in_folders, *cores]:
        target = package / file.relative_to(PACKAGE)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)
    if wanted.values:
        (package / "vehicle.json").write_text(json.dumps(wanted.values, indent=1) + "\n")
    text = source("fmu_src/landing_fmu.py").read_text()
    (package / "slave.py").write_text(re.sub(r"^from rlv_landing\.?", "from .", text, flags=re.M))
    script = folder / f"{name.replace('rlv_landing', 'landing_fmu')}.py"
    script.write_text(SCRIPT.format(package=name))
    return script, package
