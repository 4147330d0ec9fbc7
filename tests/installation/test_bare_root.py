"""`make run` on a bare Debian, as README says it: what is missing is named, and it goes on.

Part of `make torture`: debootstrap makes the system, and all packages come from the network.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="installs a system: make torture"),
    pytest.mark.skipif(
        shutil.which("debootstrap") is None or os.getuid() != 0, reason="needs debootstrap and root"
    ),
]
ROOT = Path(__file__).resolve().parents[2]
# README's prerequisites, without what Debian keeps in packages of its own
PACKAGES = "python3,git,gcc,libc6-dev,make,ca-certificates"
CERTIFICATES = "/etc/ssl/certs/ca-certificates.crt"
HOME = "home/me/für alle"


@pytest.fixture(scope="module")
def system(tmp_path_factory) -> Iterator[Path]:
    """A bare Debian with a checkout of an ordinary user."""
    root = tmp_path_factory.mktemp("debian")
    line = ["debootstrap", "--variant=minbase", f"--include={PACKAGES}", "bookworm", str(root)]
    subprocess.run(line, check=True, capture_output=True, timeout=3600)
    # pytest's folders are for one user
    root.chmod(0o755)
    for file in ("/etc/resolv.conf", "/etc/pip.conf", CERTIFICATES):
        if Path(file).is_file():
            shutil.copy(file, root / file[1:])
    shutil.copytree("/etc/apt/apt.conf.d", root / "etc/apt/apt.conf.d", dirs_exist_ok=True)
    files = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    for name in filter(None, files.split("\0")):
        target = root / HOME / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, target)
    run(root, "root", "useradd -m me; chown -R me /home/me")
    yield root
    shutil.rmtree(root, ignore_errors=True)


def run(root: Path, user: str, command: str) -> subprocess.CompletedProcess[str]:
    """Run a command in the system; its /proc goes with it."""
    inside = "mount -t proc proc /proc && su " + user + ' -c "$0"'
    return subprocess.run(
        ["unshare", "--mount", "chroot", str(root), "sh", "-c", inside, command],
        env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "HOME": "/root",
             "PIP_CERT": CERTIFICATES, "PIP_DEFAULT_TIMEOUT": "180"},
        capture_output=True,
        text=True,
        timeout=3600,
        check=False,
    )  # fmt: skip


def test_make_names_what_is_missing_and_runs_after_that(system):
    make = f"cd '/{HOME}' && make run"
    refused = run(system, "me", make)
    assert refused.returncode != 0
    assert refused.stderr.splitlines()[0] == (
        "error: venv and Python.h are missing; on Debian and Ubuntu: "
        "apt install python3-venv python3-dev; then run make again"
    )
    install = "apt-get update -qq && apt-get install -y -qq python3-venv python3-dev"
    done = run(system, "root", install)
    assert done.returncode == 0, done.stderr
    # what a venv without ensurepip leaves
    run(
        system,
        "me",
        f"cd '/{HOME}' && mkdir -p .venv/bin && ln -s /usr/bin/python3 .venv/bin/python",
    )
    done = run(system, "me", make)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "outcome" in done.stdout or "settled" in done.stdout
    assert "picture: logs/" in done.stdout
