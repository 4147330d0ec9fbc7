"""Which build of the model computed a log: what decides whether a repetition must give the same
bits.
"""

from __future__ import annotations

import hashlib
import platform
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path

import rlv_landing

# The files that decide the digits, as the FMU carries them, too.
MODEL_FILE = re.compile(
    r"(?:^|/)rlv_landing[^/]*/((?:core/(?:\w+/)*\w+|assembly|driven|landing|parameters|quantities|touchdown)\.py)$"
)


def build_metadata(fmu: Path) -> dict[str, str]:
    """What a log says of the build of the FMU that it was computed by: a digest of the model's
    texts, and the machine.
    """
    try:
        with zipfile.ZipFile(fmu) as archive:
            texts = {
                m[1]: archive.read(name)
                for name in archive.namelist()
                if (m := MODEL_FILE.search(name))
            }
    except (OSError, zipfile.BadZipFile):
        texts = {}
    return {"model": _digest(texts), "machine": machine()}


def own_model() -> str:
    """The digest of the model that is installed here."""
    root = Path(rlv_landing.__file__).parent
    files = [*(root / "core").rglob("*.py"), *root.glob("*.py")]
    texts = {
        m[1]: f.read_bytes()
        for f in files
        if (m := MODEL_FILE.search(f"rlv_landing/{f.relative_to(root).as_posix()}"))
    }
    return _digest(texts)


def machine() -> str:
    """Processor, system and C library: the mathematical functions that the digits come from."""
    return " ".join(
        part for part in (platform.machine(), platform.system(), *platform.libc_ver()) if part
    )


def why_not_exact(metadata: Mapping[str, str], fmu: Path | None = None) -> str:
    """Why a repetition here, by `fmu` or the model that is installed, need not give the bits of the
    log with this metadata; empty where it must.
    """
    told = build_metadata(fmu) if fmu is not None else {"model": own_model(), "machine": machine()}
    reasons = {
        "model": "the log was computed by another version of the model",
        "machine": "the log was computed on another machine",
    }
    for name, mine in told.items():
        if not metadata.get(name):
            return f"the log does not say by which {name} it was computed"
        if metadata[name] != mine:
            return f"{reasons[name]} ({metadata[name]}; here {mine})"
    return ""


def _digest(texts: Mapping[str, bytes]) -> str:
    if not texts:
        return ""
    return hashlib.sha256(
        b"".join(name.encode() + b"\0" + texts[name] for name in sorted(texts))
    ).hexdigest()[:16]
