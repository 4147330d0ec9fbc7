"""Quality of service (QoS) of topics, in rosbag2's terms."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

# rosbag2's values for "no deadline, no lifespan, infinite lease".
INFINITE = {"sec": 9223372036, "nsec": 854775807}
# Logs older than metadata version 9 hold rmw's enumeration values.
HISTORY = {1: "keep_last", 2: "keep_all"}
RELIABILITY = {1: "reliable", 2: "best_effort"}
DURABILITY = {1: "transient_local", 2: "volatile"}
# Profiles longer, and nested deeper, than these are none [characters].
LONGEST, DEEPEST = 64 * 1024, 16
# A publisher that keeps more than this is one whose log was changed.
MOST_KEPT = 100_000


@dataclass(frozen=True)
class Qos:
    """The quality of service that a publisher offers.

    Args:
        reliability: `reliable` or `best_effort`.
        durability: `volatile` or `transient_local`.
        depth: number of last samples that are kept.
    """

    reliability: str = "reliable"
    durability: str = "volatile"
    depth: int = 5000

    def record(self) -> dict[str, Any]:
        """As one entry of rosbag2's `offered_qos_profiles`, metadata version 9."""
        return {
            "history": "keep_last",
            "depth": self.depth,
            "reliability": self.reliability,
            "durability": self.durability,
            "deadline": dict(INFINITE),
            "lifespan": dict(INFINITE),
            "liveliness": "automatic",
            "liveliness_lease_duration": dict(INFINITE),
            "avoid_ros_namespace_conventions": False,
        }


# What a reader lacks is sent again while it is kept: the last 5 s at 1 kHz, for Fast DDS tells its
# readers every 3 s what there is. One that has just started, and knows of the writer later than the
# writer of it, also gets the first messages so. Never everything is kept: a writer that keeps all
# waits for its slowest reader.
TELEMETRY = Qos()
# ROS's own profile for sensors: lost messages are not sent again.
SENSOR_DATA = Qos(reliability="best_effort", depth=5)
CLOCK = Qos(depth=1)
# A subscription of best effort matches publishers of either kind.
INPUT = Qos(reliability="best_effort")
# For what is published once: later subscribers get it as well.
LATCHED = Qos(durability="transient_local", depth=1)
PROFILES = {"telemetry": TELEMETRY, "sensor_data": SENSOR_DATA}


def parse_qos(text: str) -> Qos:
    """The first of the `offered_qos_profiles` of a log's channel.

    Args:
        text: the profiles as YAML.

    Returns:
        The profile, or `TELEMETRY` where the text has none that can be read.
    """
    try:
        first = profiles(text)[0]
        return Qos(
            reliability=RELIABILITY.get(first["reliability"], first["reliability"]),
            durability=DURABILITY.get(first["durability"], first["durability"]),
            depth=min(max(1, int(first["depth"])), MOST_KEPT)
            if HISTORY.get(first["history"], first["history"]) == "keep_last"
            else TELEMETRY.depth,
        )
    except (LookupError, TypeError, ValueError, OverflowError):
        return TELEMETRY


def resending(qos: Qos, rate: float = 1.0) -> Qos:
    """The quality of service of a replay's publisher: a reliable one keeps what the landing's does.

    A recorder notes depths that were enough for others, such as 10.

    Args:
        qos: as recorded.
        rate: of the replay, seconds of the log per second.
    """
    if qos.reliability != TELEMETRY.reliability or qos.durability != TELEMETRY.durability:
        return qos
    kept = min(round(TELEMETRY.depth * max(1.0, rate)), MOST_KEPT)
    return replace(qos, depth=max(qos.depth, kept))


def profiles(text: str) -> list[dict[str, Any]]:
    """The `offered_qos_profiles` of a log's channel; none where they cannot be read.

    Args:
        text: the profiles as YAML.
    """
    try:
        found = read_yaml(text, LONGEST)
    except ValueError:
        return []
    return found if isinstance(found, list) and all(isinstance(p, dict) for p in found) else []


def read_yaml(text: str, longest: int) -> Any:
    """What a YAML text of rosbag2 says; it has no aliases, by which a short text grows huge.

    Args:
        text: the text.
        longest: the most characters that it may have.

    Raises:
        ValueError: it is no YAML, is longer, nested deeper than 16, or has aliases.
    """
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    if len(text) > longest:
        raise ValueError(f"it has {len(text)} characters, more than {longest}")
    depth = 0
    try:
        for event in yaml.parse(text, Loader=loader):
            if isinstance(event, yaml.AliasEvent):
                raise ValueError("it has YAML aliases")
            opens = isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent))
            depth += opens - isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent))
            if depth > DEEPEST:
                raise ValueError(f"it is nested deeper than {DEEPEST}")
        return yaml.load(text, Loader=loader)
    except (yaml.YAMLError, OverflowError, AttributeError, TypeError) as e:
        raise ValueError(" ".join(str(e).split())) from None
