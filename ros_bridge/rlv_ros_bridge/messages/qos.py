"""Quality of service (QoS) of topics, in rosbag2's terms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

# rosbag2's values for "no deadline, no lifespan, infinite lease".
INFINITE = {"sec": 9223372036, "nsec": 854775807}
# Logs older than metadata version 9 hold rmw's enumeration values.
HISTORY = {1: "keep_last", 2: "keep_all"}
RELIABILITY = {1: "reliable", 2: "best_effort"}
DURABILITY = {1: "transient_local", 2: "volatile"}


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
    depth: int = 1000

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


# The last second is kept for a slow subscriber, never everything: a writer that keeps all waits for
# its slowest reader.
TELEMETRY = Qos()
# ROS's own profile for sensors: lost messages are not sent again.
SENSOR_DATA = Qos(reliability="best_effort", depth=5)
CLOCK = Qos(depth=1)
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
    import yaml

    try:
        first = yaml.safe_load(text)[0]
        return Qos(
            reliability=RELIABILITY.get(first["reliability"], first["reliability"]),
            durability=DURABILITY.get(first["durability"], first["durability"]),
            depth=max(1, int(first["depth"]))
            if HISTORY.get(first["history"], first["history"]) == "keep_last"
            else TELEMETRY.depth,
        )
    except (yaml.YAMLError, LookupError, TypeError, ValueError):
        return TELEMETRY
