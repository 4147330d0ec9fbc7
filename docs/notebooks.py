"""Runs notebooks of the examples, and stores what they print and draw; run by `make docs`."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode
from traitlets.config import Config

FOLDER = Path(__file__).resolve().parent.parent / "examples" / "notebooks"


def run(notebook: Path, folder: Path) -> NotebookNode:
    """The notebook with the outputs of a run by this Python.

    Args:
        notebook: The file, which is left as it is.
        folder: An empty folder, in which it runs.

    Raises:
        CellExecutionError: A cell fails.
    """
    made = nbformat.read(notebook, as_version=4)
    # its commands are those beside this Python, its pictures in the page
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
    environment["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    with TemporaryDirectory(prefix="rlv_landing_") as sockets:
        # files, not ports, which others may take
        manager = {"transport": "ipc", "ip": str(Path(sockets) / "kernel")}
        client = NotebookClient(
            made,
            config=Config({"KernelManager": manager}),
            kernel_name="python3",
            timeout=300,
            resources={"metadata": {"path": str(folder)}},
        )
        client.execute(env=environment)
    made.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}
    for cell in made.cells:
        # times of the execution
        cell.metadata.pop("execution", None)
    return made


def main() -> None:
    """Run all, and store their outputs."""
    for notebook in sorted(FOLDER.glob("*.ipynb")):
        with TemporaryDirectory(prefix="rlv_landing_") as folder:
            nbformat.write(run(notebook, Path(folder)), notebook)
        print(notebook)


if __name__ == "__main__":
    main()
