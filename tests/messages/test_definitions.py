"""Message definitions, against those that rosbags carries."""

from __future__ import annotations

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rlv_landing.errors import LandingError
from rlv_ros_bridge.messages.definitions import definition, dependencies
from rlv_ros_bridge.messages.topics import RECORDED

TYPES = sorted({t.type_name for t in RECORDED})


@pytest.mark.parametrize("name", TYPES)
def test_hash_and_fields_agree_with_an_independent_type_store(name: str) -> None:
    store = get_typestore(Stores.ROS2_KILTED)
    found = definition(name)
    assert found.type_hash == store.hash_rihs01(name)
    parsed = get_types_from_msg(found.text, name)
    assert all(parsed[dependency] == store.fielddefs[dependency] for dependency in parsed)


def test_arrays_bounds_constants_and_comments_are_read_as_ros_does() -> None:
    text = (
        "uint8 A=1\nPose[] poses # Twist t\nstd_msgs/Header header\n"
        "float64<=3[4] x\nstring<=5 name\nPoint<=2[<=3] p\n# Point q\n"
    )
    assert dependencies("geometry_msgs/msg/Any", text) == [
        "geometry_msgs/msg/Pose",
        "std_msgs/msg/Header",
        "geometry_msgs/msg/Point",
    ]


def test_a_type_that_is_not_installed_is_named() -> None:
    with pytest.raises(LandingError, match=r"nosuch_msgs/msg/Thing is not installed"):
        definition("nosuch_msgs/msg/Thing")
