"""Identity of the model's build and of the machine: together they decide the computed bits."""

from __future__ import annotations

import hashlib
import platform
import re
import zipfile
import zlib
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import rlv_landing

# The source files that decide the computed bits. The FMU carries the same files. Those that older
# builds had as files are among them, so that such a build has the digest that its logs hold.
MODEL_FILE = re.compile(
    r"(?:^|/)rlv_landing[^/]*/((?:(?:assembly|core|events|inputs|parameters|quantities)/(?:\w+/)*\w+"
    r"|assembly|outputs|state|landing|touchdown"
    r"|parameters|quantities|driven|driven_inputs|extremes|ground_way)\.py)$"
)


def build_metadata(fmu: Path) -> dict[str, str]:
    """Digest of the model's source files in `fmu`, and this machine, by name as a log keeps them.

    The digest is empty where `fmu` cannot be read.
    """
    sources = {}
    # a device has no end, and no archive's directory there; a damaged archive has errors of many
    # kinds
    with suppress(OSError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error):
        if fmu.is_file():
            with zipfile.ZipFile(fmu) as archive:
                sources = {
                    m[1]: archive.read(name)
                    for name in archive.namelist()
                    if (m := MODEL_FILE.search(name))
                }
    return {"model": _digest(sources), "machine": machine_name()}


def installed_model() -> str:
    """Digest of the source files of the model that is installed here."""
    root = Path(rlv_landing.__file__).parent
    sources = {
        m[1]: f.read_bytes()
        for f in root.rglob("*.py")
        if (m := MODEL_FILE.search(f"rlv_landing/{f.relative_to(root).as_posix()}"))
    }
    return _digest(sources)


def machine_name() -> str:
    """Processor, system and C library, whose mathematical functions decide the last bits."""
    return " ".join(
        part for part in (platform.machine(), platform.system(), *platform.libc_ver()) if part
    )


def inexact_reason(metadata: Mapping[str, str], fmu: Path | None = None) -> str:
    """Reason why a rerun here need not give the bits of the log; empty where it must.

    Args:
        metadata: the log's metadata by name.
        fmu: the FMU that reruns it; None: the installed Python model.
    """
    here = (
        build_metadata(fmu)
        if fmu is not None
        else {"model": installed_model(), "machine": machine_name()}
    )
    reasons = {
        "model": "the log was computed by another version of the model",
        "machine": "the log was computed on another machine",
    }
    for name, value in here.items():
        if not metadata.get(name):
            return f"the log does not say by which {name} it was computed"
        if metadata[name] != value:
            return f"{reasons[name]} ({metadata[name]}; here {value})"
    return ""


def _digest(sources: Mapping[str, bytes]) -> str:
    if not sources:
        return ""
    return hashlib.sha256(
        b"".join(name.encode() + b"\0" + sources[name] for name in sorted(sources))
    ).hexdigest()[:16]
