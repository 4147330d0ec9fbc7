"""The parameters that files of ROS arguments give to every node."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

VALUES = "ros__parameters"


def shared_names(args: Sequence[str]) -> frozenset[str]:
    """The parameters that `args` give to every node, and to no node by its own name.

    They stand in a section such as `/**` of a parameter file, which other nodes read, too.

    Args:
        args: ROS arguments, whose parameter files ROS 2 has read.
    """
    shared: set[str] = set()
    own: set[str] = set()
    for option, value in pairwise(args):
        if option in ("-p", "--param"):
            own.add(value.split(":=", 1)[0].rpartition(":")[2])
        elif option == "--params-file":
            for node, name in _given(Path(value)):
                (shared if "*" in node.rpartition("/")[2] else own).add(name)
    return frozenset(shared - own)


def _given(file: Path) -> Iterator[tuple[str, str]]:
    """Each parameter in `file` with the name of its section."""
    import yaml

    # What ROS 2 reads, and YAML's library does not, is nobody's.
    with suppress(yaml.YAMLError, OSError, UnicodeDecodeError):
        yield from _in_sections(yaml.safe_load(file.read_text(encoding="utf-8")), "")


def _in_sections(tree: Any, node: str) -> Iterator[tuple[str, str]]:
    for key, below in tree.items() if isinstance(tree, dict) else ():
        if key == VALUES:
            yield from ((node, name) for name in _names(below, ""))
        else:
            yield from _in_sections(below, f"{node}/{key}")


def _names(values: Any, prefix: str) -> Iterator[str]:
    for key, value in values.items() if isinstance(values, dict) else ():
        if isinstance(value, dict):
            yield from _names(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}"
