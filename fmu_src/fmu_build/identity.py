"""The FMU's identity: a GUID, and names of its modules, that no other build has.

All modules of a process share `sys.modules`, so two FMUs with modules of equal names would compute
with the code of the one that was loaded first. Both come from a hash of all that the FMU carries.
The front contains the GUID, so what it is made of is hashed in its place.
"""

from __future__ import annotations

import hashlib
import uuid
from pathlib import Path
from xml.etree import ElementTree

from .binary import made_of, makers
from .targets import OWN

# what stands in the files until the GUID is known
NO_GUID = "00000000-0000-0000-0000-000000000000"
TAG_LENGTH = 12


def digest(files: Path, root: ElementTree.Element, platforms: str = OWN) -> bytes:
    """SHA-256 of the FMU's files, without pythonfmu's binaries, and of the front's sources.

    Args:
        files: Folder of the unpacked FMU, with NO_GUID for the GUID.
        root: Root of its description in FMI 2.0.
        platforms: Which platforms it is for, this machine's or all.
    """
    made_from = {"front": made_of(root)} | {
        f"compiler/{platform}": text.encode() for platform, text in makers(root, platforms).items()
    }
    carried = {
        p.relative_to(files).as_posix(): p.read_bytes()
        for p in files.rglob("*")
        if p.is_file() and p.relative_to(files).parts[0] != "binaries"
    }
    found = hashlib.sha256()
    for name, content in sorted({**carried, **made_from}.items()):
        found.update(f"{name}\0{len(content)}\0".encode())
        found.update(content)
    return found.digest()


def identify(
    files: Path, package: str, script: str, root: ElementTree.Element, platforms: str = OWN
) -> str:
    """Put the GUID in its places, and the tag of the build at the end of the modules' names.

    Args:
        files: Folder of the unpacked FMU, with NO_GUID for the GUID.
        package: Name of the package in `resources`.
        script: Name of pythonfmu's script there, without `.py`, which imports the package.
        root: Root of the description in FMI 2.0.
        platforms: Which platforms the FMU is for, this machine's or all.

    Returns:
        The GUID.
    """
    found = digest(files, root, platforms)
    guid = str(uuid.UUID(bytes=found[:16], version=5))
    tag = found.hex()[:TAG_LENGTH]
    for path in (files / "modelDescription.xml", files / "documentation" / "index.html"):
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace(NO_GUID, guid), encoding="utf-8")
    resources = files / "resources"
    (resources / package).rename(resources / f"{package}_{tag}")
    old, new = resources / f"{script}.py", resources / f"{script}_{tag}.py"
    new.write_text(old.read_text().replace(package, f"{package}_{tag}"))
    old.unlink()
    (resources / "slavemodule.txt").write_text(new.stem)
    return guid
