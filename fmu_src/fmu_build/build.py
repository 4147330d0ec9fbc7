"""Builds `build/RlvLanding.fmu`, or with `--fmi 3` `build/RlvLanding3.fmu`; run by `build_fmu.sh`.

pythonfmu builds an FMU of the slave and its own copy of the package. This unpacks it, completes its
description, adds the documentation, gives it an identity of its own, puts the front in place of
pythonfmu's binary, and packs it again. The same sources and compilers give the same bytes. FMPy
validates the FMU and simulates one landing before it replaces an older file.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import tempfile
import zipfile
from datetime import datetime, timezone
from pathlib import Path
from xml.etree import ElementTree

import fmpy
from fmpy.validation import validate_fmu
from pythonfmu.builder import FmuBuilder

from .binary import record_libpython, replace_binaries
from .core_source import package_name
from .description import describe
from .description3 import describe3
from .documentation import write_documentation
from .identity import NO_GUID, identify
from .terminals import faults, write_terminals

HERE = Path(__file__).parent.parent
ROOT = HERE.parent
PACKAGE = HERE / "rlv_landing"
MODULES = (
    "__init__.py",
    "errors.py",
    "quantities.py",
    "parameters.py",
    "touchdown.py",
    "inputs/__init__.py",
    "inputs/ground_way.py",
    "inputs/driven.py",
    "assembly.py",
    "extremes.py",
    "state.py",
    "stints.py",
    "events/__init__.py",
    "events/search.py",
    "landing.py",
)
# pythonfmu's command line, CSV tool and builder, which no slave needs
NOT_NEEDED = ("__main__.py", "csvbuilder.py", "deploy.py", "builder.py", "osutil.py")
# the line of pythonfmu's `__init__.py` that imports the builder, and with it argparse, logging and
# minidom: a third of the time that the first instance takes
IMPORTS_BUILDER = "from .builder import FmuBuilder\n"
# modules that its slave needs to write a description only; Python 3.12.1 crashes when it imports
# datetime after it was ended and started again
IMPORTS_OF_SLAVE = "import datetime\n"
# dates that a zip file can hold, 1980 to 2107 [s since 1970]; 1980 also for sources without a date
OLDEST, NEWEST = 315532800, 4354819199

SCRIPT = """\
from {package}.slave import RlvLanding

__all__ = ["RlvLanding"]
"""


def version() -> str:
    """The package's version, from its `__init__.py`."""
    found = re.search(r'^__version__ = "(.+)"$', (PACKAGE / "__init__.py").read_text(), re.M)
    if found is None:
        raise SystemExit("error: rlv_landing/__init__.py states no __version__")
    return found[1]


def source_date() -> datetime:
    """The date of the sources [UTC].

    SOURCE_DATE_EPOCH of the environment, else the date of the last git commit, else 1980-01-01.

    Raises:
        SystemExit: SOURCE_DATE_EPOCH is no number of seconds that a zip file can hold.
    """
    text = os.environ.get("SOURCE_DATE_EPOCH", "")
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


def copy_sources(folder: Path, *, pure: bool) -> tuple[Path, Path]:
    """Copy slave and package to `folder`; return pythonfmu's script and the package.

    Their names carry the version; `identify` adds the build. `pure` leaves the compiled core out.

    Raises:
        SystemExit: There is no compiled core of the present kernels, and `pure` is not set.
    """
    name = "rlv_landing_" + re.sub(r"\W", "_", version())
    package = folder / name
    package.mkdir()
    for module in MODULES:
        target = package / module
        target.parent.mkdir(exist_ok=True)
        shutil.copy(PACKAGE / module, target)
    cores = [] if pure else compiled_cores()
    if not cores and not pure:
        raise SystemExit(
            "error: there is no compiled core of the present kernels: see why the compiler failed, "
            "or run ./build_fmu.sh; --pure builds an FMU without it, which lands to the same "
            "digits and takes ten times as long"
        )
    for file in [*sorted((PACKAGE / "core").rglob("*.py")), *cores]:
        target = package / file.relative_to(PACKAGE)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)
    text = (HERE / "landing_fmu.py").read_text()
    (package / "slave.py").write_text(re.sub(r"^from rlv_landing\.?", "from .", text, flags=re.M))
    script = folder / f"{name.replace('rlv_landing', 'landing_fmu')}.py"
    script.write_text(SCRIPT.format(package=name))
    return script, package


def build_with_pythonfmu(folder: Path, *, pure: bool) -> tuple[Path, Path, str]:
    """Build an FMU of slave and package by pythonfmu, and unpack it.

    Args:
        folder: Empty folder to work in.
        pure: Whether to leave the compiled core out.

    Returns:
        Folder of the FMU's files; in it the package; name of the script that imports it.

    Raises:
        SystemExit: pythonfmu is of a version whose files differ.
    """
    script, package = copy_sources(folder, pure=pure)
    built = FmuBuilder.build_FMU(
        script, dest=folder / "out" / "RlvLanding.fmu", project_files=[package]
    )
    files = folder / "files"
    with zipfile.ZipFile(built) as archive:
        archive.extractall(files)
    package = files / "resources" / package.name
    take_pythonfmu(files / "resources" / "pythonfmu", package)
    return files, package, script.stem


def take_pythonfmu(own: Path, package: Path) -> None:
    """Move the FMU's copy of pythonfmu into its package, without what a slave does not need.

    There it has a name that no other pythonfmu in the process has.

    Raises:
        SystemExit: pythonfmu is of a version whose files differ.
    """
    for name in NOT_NEEDED:
        (own / name).unlink()
    for name, line in (("__init__.py", IMPORTS_BUILDER), ("fmi2slave.py", IMPORTS_OF_SLAVE)):
        text = (own / name).read_text()
        if text.count(line) != 1:
            raise SystemExit(
                f"error: pythonfmu's {name} has no line {line.strip()!r}, as that of 0.7.0 has; "
                "change the lines in fmu_build/build.py"
            )
        (own / name).write_text(text.replace(line, ""))
    own.rename(package / "pythonfmu")
    slave = package / "slave.py"
    slave.write_text(re.sub(r"^from pythonfmu", "from .pythonfmu", slave.read_text(), flags=re.M))


def complete_description(files: Path, date: datetime) -> ElementTree.Element:
    """The root of pythonfmu's modelDescription.xml in `files`, completed."""
    root = ElementTree.parse(files / "modelDescription.xml").getroot()
    root.set("guid", NO_GUID)
    describe(root, date.strftime("%Y-%m-%dT%H:%M:%SZ"))
    return root


def write_description(files: Path, root: ElementTree.Element) -> None:
    """Write the modelDescription.xml with this root."""
    tree = ElementTree.ElementTree(root)
    ElementTree.indent(tree, "\t")
    tree.write(files / "modelDescription.xml", encoding="UTF-8", xml_declaration=True)


def pack(files: Path, target: Path, date: datetime) -> None:
    """Zip all of `files`, sorted by name and dated `date`: the same files give the same bytes."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(
            p.relative_to(files).as_posix() for p in files.rglob("*") if p.is_file()
        ):
            entry = zipfile.ZipInfo(name, date.timetuple()[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whose modes these are
            entry.external_attr = (0o100755 if name.endswith((".so", ".dll")) else 0o100644) << 16
            archive.writestr(entry, (files / name).read_bytes())


def check(fmu: Path, fmi: int) -> str:
    """Validate the FMU's description and simulate one landing; return a line with the results.

    Raises:
        SystemExit: The description is not valid, or the landing's numbers are not plausible.
    """
    problems = validate_fmu(str(fmu)) + (faults(fmu) if fmi == 3 else [])
    if problems:
        raise SystemExit("error: the FMU is not valid: " + "; ".join(problems))
    strut = "leg.main_strut.force" if fmi == 3 else "leg[1].main_strut.force"
    result = fmpy.simulate_fmu(
        str(fmu), stop_time=0.2, output_interval=1e-3, output=[strut, "energy.balance"]
    )
    forces = result[strut][:, 0] if fmi == 3 else result[strut]
    force, balance = forces.min(), abs(result["energy.balance"]).max()
    if not (force < -1000.0 and balance < 1e-3):
        raise SystemExit(
            f"error: the FMU's trial landing is not plausible: strut force {force:g} N, "
            f"energy balance {balance:g} J"
        )
    return (
        f"valid; trial landing: main strut 1 down to {force:.0f} N, "
        f"energy balance within {balance:.1e} J"
    )


def build(target: Path, *, fmi: int = 2, pure: bool) -> None:
    """Build and check the FMU, then put it at `target` in one step; print what was done.

    Args:
        target: The FMU's file.
        fmi: Version of FMI, 2 or 3.
        pure: Whether to leave the compiled core out.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    date = source_date()
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        files, package, script = build_with_pythonfmu(folder, pure=pure)
        record_libpython(files)
        root = complete_description(files, date)
        description = describe3(root) if fmi == 3 else root
        write_description(files, description)
        write_documentation(files, description)
        if fmi == 3:
            write_terminals(files, description)
        root.set("guid", identify(files, package.name, script))
        compilers = replace_binaries(files, root, fmi)
        made = folder / "RlvLanding.fmu"
        pack(files, made, date)
        found = check(made, fmi)
        shutil.copy(made, target.with_suffix(".part"))
        target.with_suffix(".part").replace(target)
    for platform, compiler in compilers.items():
        print(f"{platform}: front compiled by {compiler}")
    cores = [] if pure else [file.name for file in compiled_cores()]
    print(f"core: {', '.join(cores) or 'not compiled, as --pure asks for'}")
    print(f"{target}: {found}")


def main() -> None:
    """Build the FMU that the command line asks for."""
    parser = argparse.ArgumentParser(
        prog="build_fmu.sh",
        description="Builds the FMU and checks it: FMPy validates it and simulates one landing.",
        epilog="The front is compiled by ziglang where it is installed, else by gcc, or by the "
        "compiler that CC names. The same sources and compilers give the same bytes.",
    )
    parser.add_argument(
        "file",
        nargs="?",
        type=Path,
        help="the FMU's file [default: build/RlvLanding.fmu, for FMI 3.0 build/RlvLanding3.fmu]",
    )
    parser.add_argument(
        "--fmi",
        type=int,
        choices=(2, 3),
        default=2,
        help="version of FMI: 2.0 or 3.0, both for co-simulation [default: 2]",
    )
    parser.add_argument(
        "--pure",
        action="store_true",
        help="leave the compiled core out: the same digits, ten times as slow",
    )
    arguments = parser.parse_args()
    name = "RlvLanding3.fmu" if arguments.fmi == 3 else "RlvLanding.fmu"
    build(arguments.file or ROOT / "build" / name, fmi=arguments.fmi, pure=arguments.pure)


if __name__ == "__main__":
    main()
