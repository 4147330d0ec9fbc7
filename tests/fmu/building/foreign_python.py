"""Pythons of other processors and of later Debian releases, unpacked into a folder.

They come from Debian's packages by the machine's own sources; nothing of it is changed. A test that
needs one skips with the reason where they are not to be had.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "build" / "foreign"
# what libpython needs, besides the packages of Python itself
LIBRARIES = ("libc6", "zlib1g", "libexpat1")
KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"


def unpacked_python(architecture: str, release: str, minor: int) -> Path:
    """The root folder of an unpacked Python, with its C library.

    Args:
        architecture: Debian's name: amd64, arm64.
        release: Debian's name: bookworm, sid.
        minor: The version's minor number.
    """
    folder = FOLDER / f"{architecture}-{release}-python3.{minor}"
    if (folder / "complete").exists():
        return folder / "root"
    folder.mkdir(parents=True, exist_ok=True)
    options = _options(folder, architecture, release)
    _apt(folder, "update", *options)
    python = [f"libpython3.{minor}{part}" for part in ("", "-minimal", "-stdlib")]
    _apt(folder, "download", *options, *python, *LIBRARIES)
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg-deb", "-x", package, folder / "root"], check=True)
    (folder / "complete").touch()
    return folder / "root"


def libpython(root: Path, minor: int) -> Path:
    """The library of the Python unpacked in `root`."""
    (found,) = root.glob(f"usr/lib/*/libpython3.{minor}.so.1.0")
    return found


def _options(folder: Path, architecture: str, release: str) -> list[str]:
    """Options by which apt works in `folder`, on one release and architecture."""
    place = _mirror()
    signed = f" [signed-by={KEYRING}]" if Path(KEYRING).is_file() else ""
    (folder / "sources.list").write_text(f"deb{signed} {place} {release} main\n")
    for name in ("lists/partial", "cache/archives/partial"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    values = {
        "Dir::Etc::sourcelist": folder / "sources.list",
        "Dir::Etc::sourceparts": "/dev/null",
        "Dir::State::lists": folder / "lists",
        "Dir::Cache": folder / "cache",
        "APT::Architecture": architecture,
        "APT::Architectures": architecture,
        "APT::Sandbox::User": "root",
    }
    return [text for name, value in values.items() for text in ("-o", f"{name}={value}")]


def _mirror() -> str:
    """The place of Debian's packages that this machine uses."""
    try:
        done = subprocess.run(
            ["apt-get", "indextargets", "--format", "$(REPO_URI)", "Label: Debian"],
            capture_output=True,
            text=True,
        )
    except OSError:
        pytest.skip("this machine has no apt")
    if not done.stdout.strip():
        pytest.skip("this machine knows no place of Debian's packages: run apt-get update")
    return done.stdout.split()[0]


def _apt(folder: Path, *arguments: str) -> None:
    done = subprocess.run(
        ["apt-get", "-q", *arguments], cwd=folder, capture_output=True, text=True, timeout=300
    )
    if done.returncode != 0:
        pytest.skip(f"apt-get {arguments[0]} fails: {done.stderr.strip()}")
