"""`rlv-landing examples`: the examples that come with the package, to copy and to change."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import click

from ..text.new_folder import new_folder
from .options import HELP_NAMES, Group

PACKAGE = Path(__file__).resolve().parent.parent
# an installed package has them, a checkout beside the package
INSTALLED = PACKAGE / "examples"
CHECKOUT = PACKAGE.parent.parent
# what the texts say of the checkout, and what they say where the examples stand by themselves
OF_CHECKOUT = (
    (re.compile(r"(?:\.\./\.\./)?\.venv/bin/"), ""),
    (re.compile(r"\[([^\]]+)\]\((?:\.\./)+docs/[^)]*\)"), r"\1"),
    (re.compile(r"\bexamples/(?=\w)"), ""),
)


def example_folders() -> dict[str, Path]:
    """Files and folders of the examples by the name of their copy."""
    if INSTALLED.is_dir():
        return {p.name: p for p in sorted(INSTALLED.iterdir()) if p.name != "__pycache__"}
    found = {
        p.name: p for p in sorted((CHECKOUT / "examples").iterdir()) if p.name != "__pycache__"
    }
    bridge = CHECKOUT / "ros_bridge"
    return {**found, "ros2/launch": bridge / "launch", "ros2/config": bridge / "config"}


@click.group(context_settings=HELP_NAMES, cls=Group)
def examples() -> None:
    """Copy the examples: studies, an envelope, a ship's deck of FMUs, ROS 2 launch and layouts.

    \b
    rlv-landing examples copy my_examples
    """


@examples.command(context_settings=HELP_NAMES)
@click.argument("folder", type=click.Path(path_type=Path), default="examples")
def copy(folder: Path) -> None:
    """Copy all examples to a new FOLDER [default: examples].

    Commands in their pages are for that folder. ros2 has the launch file, a parameter file, and
    layouts for RViz and Foxglove.
    """
    with new_folder(folder):
        for name, path in example_folders().items():
            for source in [path] if path.is_file() else sorted(path.rglob("*")):
                place = source.relative_to(path)
                if source.is_file() and "__pycache__" not in place.parts:
                    _copy(source, folder / name / place)
    click.echo(f"{folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}")


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.suffix == ".md":
        target.write_bytes(standing_alone(source.read_text("utf-8")).encode())
    else:
        shutil.copyfile(source, target)


def standing_alone(text: str) -> str:
    """A page of the examples, for a folder outside of a checkout."""
    for pattern, by in OF_CHECKOUT:
        text = pattern.sub(by, text)
    return text
