"""Message definitions as a log needs them: a type's hash, and the `.msg` texts of all its parts."""

from __future__ import annotations

import json
import os
import re
import sys
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rlv_landing.errors import LandingError

SEPARATOR = "=" * 80
INTEGERS = tuple(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))
PRIMITIVES = frozenset(
    ("bool", "byte", "char", "float32", "float64", "string", "wstring", *INTEGERS)
)
FIELD = re.compile(r"^\s*([A-Za-z][A-Za-z0-9_/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*")


# Types of which there is no wheel: their text and their hash.
WITHOUT_WHEEL = {
    "tf2_msgs/msg/TFMessage": (
        "geometry_msgs/TransformStamped[] transforms\n",
        "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    )
}


@dataclass(frozen=True)
class Definition:
    """A message type.

    Args:
        name: `pkg/msg/Type`.
        text: its `.msg` text and those of its parts, in the form of MCAP's `ros2msg` schema.
        type_hash: `RIHS01_...`; empty where the package does not have it.
    """

    name: str
    text: str
    type_hash: str


@cache
def definition(name: str) -> Definition:
    """The definition of the type `pkg/msg/Type`.

    Raises LandingError where its package is not installed.
    """
    done: dict[str, str] = {}
    queue = [name]
    while queue:
        current = queue.pop(0)
        if current not in done:
            done[current] = _text(current)
            queue += dependencies(current, done[current])
    parts = [done.pop(name)]
    for dependency, text in done.items():
        package, _, short = dependency.split("/")
        parts.append(f"{SEPARATOR}\nMSG: {package}/{short}\n{text}")
    return Definition(name, "\n".join(parts), _type_hash(name))


def dependencies(name: str, text: str) -> list[str]:
    """The types `pkg/msg/Type` that the `.msg` text of the type `name` mentions, in its order."""
    package = name.split("/")[0]
    found: list[str] = []
    for line in text.splitlines():
        match = FIELD.match(line.split("#", 1)[0])
        if match is None or match[1] in PRIMITIVES:
            continue
        parts = match[1].split("/")
        found.append(
            f"{parts[0]}/msg/{parts[-1]}" if len(parts) > 1 else f"{package}/msg/{parts[0]}"
        )
    return list(dict.fromkeys(found))


def _text(name: str) -> str:
    if name in WITHOUT_WHEEL:
        return WITHOUT_WHEEL[name][0]
    return _folder(name).joinpath(name.rsplit("/", 1)[1] + ".msg").read_text(encoding="utf-8")


def _type_hash(name: str) -> str:
    if name in WITHOUT_WHEEL:
        return WITHOUT_WHEEL[name][1]
    file = _folder(name) / (name.rsplit("/", 1)[1] + ".json")
    try:
        hashes = json.loads(file.read_text(encoding="utf-8"))["type_hashes"]
        return next(str(h["hash_string"]) for h in hashes if h["type_name"] == name)
    except (OSError, ValueError, LookupError, StopIteration):
        return ""


def _folder(name: str) -> Path:
    package, _, short = name.split("/")
    tried = _shares(package)
    for share in tried:
        if (share / "msg" / f"{short}.msg").is_file():
            return share / "msg"
    raise LandingError(
        f"the definition of {name} is not installed (looked in {', '.join(map(str, tried))}); "
        f"install the ROS 2 package {package}, or source your ROS 2"
    )


def _shares(package: str) -> list[Path]:
    shares: list[Path] = []
    if os.environ.get("AMENT_PREFIX_PATH"):
        from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

        with suppress(PackageNotFoundError):
            shares.append(Path(get_package_share_directory(package)))
    return [*shares, Path(sys.prefix) / "share" / package]
