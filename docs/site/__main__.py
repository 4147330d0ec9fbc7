"""Builds the site of the documentation; run by `make site`.

A link that leads nowhere, a page that the navigation lacks, or any other warning of Sphinx ends it
with an error. What is built needs no network: fonts are the reader's, search is in the pages.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from index import ROOT
from sphinx.cmd.build import build_main
from staging import stage

HERE = Path(__file__).resolve().parent


def build(folder: Path, work: Path) -> int:
    """Build the site in `folder`, with pages and Sphinx's own files in `work`; the exit code."""
    shutil.rmtree(work, ignore_errors=True)
    stage(work / "pages")
    made = work / "site"
    options = ["-q", "-W", "--keep-going", "-j", "auto", "-b", "html", "-c", str(HERE)]
    places = ["-d", str(work / "doctrees"), str(work / "pages"), str(made)]
    status = int(build_main([*options, *places]))
    if status == 0:
        shutil.rmtree(folder, ignore_errors=True)
        made.rename(folder)
    return status


def main() -> None:
    """Build it in the folder that the command line names."""
    parser = argparse.ArgumentParser(prog="python docs/site")
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "build" / "site")
    folder = parser.parse_args().folder
    status = build(folder, folder.with_name(f"{folder.name}_work"))
    if status == 0:
        print(folder / "index.html")
    sys.exit(status)


if __name__ == "__main__":
    main()
