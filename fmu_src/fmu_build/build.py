"""Builds the FMU; run by `rlv-landing fmu build`, and by `build_fmu.sh`.

pythonfmu builds an FMU of the slave and its own copy of the package. This unpacks it, completes its
description, adds the documentation, gives it an identity of its own, puts the front in place of
pythonfmu's binary, and packs it again. The same sources and compilers give the same bytes. FMPy
validates the FMU and simulates one landing before it replaces an older file.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from xml.etree import ElementTree

from pythonfmu.builder import FmuBuilder

from rlv_landing import MODEL_NAME
from rlv_landing.errors import LandingError
from rlv_landing.text.durable import NO_ROOM, unwritable, write_durably, writing

from .binary import record_libpython, replace_binaries
from .cross.cores import compile_cores
from .description import describe
from .fmi3.description import describe3
from .identity import NO_GUID, identify
from .pages.documentation import write_documentation
from .sources import ROOT, compiled_cores, copy_sources, source_date
from .targets import ALL, OWN, tried
from .terminals import write_terminals
from .trial import check, expected
from .wanted import FMI_VERSIONS, Wanted

# endings of files that can be run, or be loaded
LIBRARIES = (".so", ".dll", ".dylib", ".pyd")
# pythonfmu's command line, CSV tool and builder, which no slave needs
NOT_NEEDED = ("__main__.py", "csvbuilder.py", "deploy.py", "builder.py", "osutil.py")
# the line of pythonfmu's `__init__.py` that imports the builder, and with it argparse, logging and
# minidom: a third of the time that the first instance takes
IMPORTS_BUILDER = "from .builder import FmuBuilder\n"
# modules that its slave needs to write a description only; Python 3.12.1 crashes when it imports
# datetime after it was ended and started again
IMPORTS_OF_SLAVE = "import datetime\n"


def build_with_pythonfmu(folder: Path, wanted: Wanted) -> tuple[Path, Path, str]:
    """Build an FMU of slave and package by pythonfmu, and unpack it.

    Args:
        folder: Empty folder to work in.
        wanted: The FMU that is wanted.

    Returns:
        Folder of the FMU's files; in it the package; name of the script that imports it.

    Raises:
        SystemExit: pythonfmu is of a version whose files differ.
    """
    script, package = copy_sources(folder, wanted)
    with _forgotten(folder, script.stem, package.name):
        built = FmuBuilder.build_FMU(
            script, dest=folder / "out" / "RlvLanding.fmu", project_files=[package]
        )
    files = folder / "files"
    with zipfile.ZipFile(built) as archive:
        archive.extractall(files)
    package = files / "resources" / package.name
    move_pythonfmu(files / "resources" / "pythonfmu", package)
    return files, package, script.stem


@contextmanager
def _forgotten(folder: Path, *names: str) -> Iterator[None]:
    """Forget afterwards the modules of these `names` that pythonfmu imports from `folder`.

    Another build in this process has modules of the same names, with other start values.
    """
    try:
        yield
    finally:
        sys.path[:] = [path for path in sys.path if str(path) != str(folder)]
        for module in [m for m in sys.modules if m.split(".")[0] in names]:
            del sys.modules[module]


def move_pythonfmu(own: Path, package: Path) -> None:
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


def complete_description(files: Path, date: datetime, wanted: Wanted) -> ElementTree.Element:
    """The root of pythonfmu's modelDescription.xml in `files`, completed."""
    root = ElementTree.parse(files / "modelDescription.xml").getroot()
    root.set("guid", NO_GUID)
    describe(root, date.strftime("%Y-%m-%dT%H:%M:%SZ"), wanted)
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
            entry.external_attr = (0o100755 if name.endswith(LIBRARIES) else 0o100644) << 16
            archive.writestr(entry, (files / name).read_bytes())


@contextmanager
def _temporary_folder() -> Iterator[Path]:
    """A temporary folder to build in.

    Raises:
        LandingError: Its disk is full.
    """
    try:
        with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
            yield Path(name)
    except OSError as e:
        # where whole folders are copied the error has a list of errors, and no number
        numbers = [e.errno, *(n for n in NO_ROOM if os.strerror(n) in str(e))]
        full = next((n for n in numbers if n in NO_ROOM), None)
        if full is None:
            raise
        remedy = "name another folder by TMPDIR"
        error = OSError(full, os.strerror(full))
        raise unwritable(Path(tempfile.gettempdir()), error, remedy) from None


def build(target: Path, wanted: Wanted) -> list[str]:
    """Build and check the FMU, then put it at `target` in one step.

    Args:
        target: The FMU's file.
        wanted: The FMU that is wanted.

    Returns:
        Lines on what was done.

    Raises:
        LandingError: The vehicle cannot land, or `target` or the temporary folder cannot be
            written.
        SystemExit: The FMU cannot be built; the message is the error.
    """
    ends = expected(wanted)
    date = source_date()
    with _temporary_folder() as folder:
        files, package, script = build_with_pythonfmu(folder, wanted)
        core_names = [] if wanted.pure else [file.name for file in compiled_cores()]
        others = wanted.other_targets
        compile_cores(others, package / "core" / "compiled_for")
        record_libpython(files)
        root = complete_description(files, date, wanted)
        description = describe3(root, wanted) if wanted.fmi == "3" else root
        write_description(files, description)
        write_documentation(files, description, wanted)
        if wanted.fmi == "3":
            write_terminals(files, description)
        root.set("guid", identify(files, package.name, script, root, wanted.platforms))
        compilers = replace_binaries(files, root, wanted.platforms, wanted.fmi)
        made = folder / "made.fmu"
        pack(files, made, date)
        found = check(made, wanted, ends)
        with writing(target):
            target.parent.mkdir(parents=True, exist_ok=True)
            write_durably(target, made.read_bytes())
    return [
        *(
            f"{platform}: front compiled by {compiler}; {tried(platform)}"
            for platform, compiler in compilers.items()
        ),
        f"core: {', '.join(core_names) or 'not compiled, as --pure asks for'}",
        *(f"{target.name}: core compiled by Zig; {target.tried}" for target in others),
        f"{target}: {found}",
    ]


def _end(number: int, _frame: object) -> None:
    raise KeyboardInterrupt(number)


def _arguments() -> argparse.Namespace:
    """The arguments of the command line."""
    parser = argparse.ArgumentParser(
        prog="build_fmu.sh",
        description="Builds the FMU and checks it: FMPy validates it and simulates one landing.",
        epilog="The front is compiled by ziglang where it is installed, else by gcc, or by the "
        "compiler that CC names. The same sources and compilers give the same bytes. "
        "`rlv-landing fmu build` builds the FMU of another vehicle.",
    )
    parser.add_argument(
        "file",
        nargs="?",
        type=Path,
        help="the FMU's file [default: build/RlvLanding.fmu, for FMI 3.0 build/RlvLanding3.fmu]",
    )
    parser.add_argument(
        "--fmi",
        choices=FMI_VERSIONS,
        default=FMI_VERSIONS[0],
        help="version of FMI: 2.0 or 3.0, both for co-simulation [default: 2]",
    )
    parser.add_argument(
        "--pure",
        action="store_true",
        help="leave the compiled core out: the same digits, ten times as slow",
    )
    parser.add_argument(
        "--platforms",
        choices=(OWN, ALL),
        default=OWN,
        help="binaries for this machine's platform, or for all that Zig compiles for: Linux on "
        "x86-64 and Arm, Windows, macOS [default: own]",
    )
    return parser.parse_args()


def main() -> None:
    """Build the FMU of the default vehicle that the command line asks for.

    An end from outside is as Ctrl-C: it leaves no temporary folder. The exit code is 128 and the
    signal's number.
    """
    arguments = _arguments()
    wanted = Wanted(fmi=arguments.fmi, pure=arguments.pure, platforms=arguments.platforms)
    name = f"{MODEL_NAME}{'3' if wanted.fmi == '3' else ''}.fmu"
    for ending in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(ending, _end)
    try:
        lines = build(arguments.file or ROOT / "build" / name, wanted)
    except LandingError as e:
        raise SystemExit(f"error: {e}") from None
    except KeyboardInterrupt as e:
        print("interrupted", file=sys.stderr)
        raise SystemExit(128 + (e.args[0] if e.args else signal.SIGINT)) from None
    print("\n".join(lines))


if __name__ == "__main__":
    main()
