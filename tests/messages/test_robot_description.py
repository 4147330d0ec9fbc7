"""The vehicle's URDF, read by an independent parser."""

from __future__ import annotations

import io

import numpy as np
import pytest
import yourdfpy
from scipy.spatial.transform import Rotation

from rlv_landing import Landing, load_preset
from rlv_ros_bridge.messages.markers import Wireframe
from rlv_ros_bridge.messages.robot_description import robot_description
from rlv_ros_bridge.messages.topics import BODY_FRAME, JOINTS, TOP_FRAME, topics_of
from rlv_ros_bridge.viewer.rerun_live import kind_of


def parsed(text: str) -> yourdfpy.URDF:
    robot = yourdfpy.URDF.load(io.StringIO(text), load_meshes=False, build_scene_graph=True)
    assert robot.validate(), robot.errors
    return robot


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_the_urdf_has_the_struts_as_joints_and_its_feet_where_the_model_has_them(mode: str) -> None:
    parameters = load_preset("yue2022-figures", mode)
    robot = parsed(robot_description(parameters))
    assert robot.base_link == BODY_FRAME
    moving = {name: j for name, j in robot.joint_map.items() if j.type == "prismatic"}
    assert set(moving) == set(JOINTS)
    assert set(robot.actuated_joint_names) == set(JOINTS)
    for name, joint in moving.items():
        assert joint.limit.lower <= 0.0 < joint.limit.upper, name
    assert moving["leg_1_main_strut"].limit.upper == parameters.main_strut.stroke_max
    assert robot.get_transform(TOP_FRAME, BODY_FRAME)[2, 3] == pytest.approx(
        parameters.vehicle.top_height
    )
    # At the start all struts are extended.
    landing = Landing(parameters)
    x, y, pitch = (landing.get(f"body.{name}") for name in ("x", "y", "pitch"))
    c, s = np.cos(pitch), np.sin(pitch)
    for leg in (1, 2, 3, 4):
        px, py, pz = (landing.get(f"leg[{leg}].footpad.{axis}") for axis in "xyz")
        # From the world to the body, the paper's axes; then to ROS's.
        forward, up = c * (px - x) - s * (py - y), s * (px - x) + c * (py - y)
        for strut in ("main_strut", "auxiliary_strut"):
            foot = robot.get_transform(f"leg_{leg}_{strut}_rod", BODY_FRAME)[:3, 3]
            assert foot == pytest.approx([forward, -pz, up], abs=1e-9), (leg, strut)


def test_a_stroke_shortens_its_strut() -> None:
    robot = parsed(robot_description(load_preset("yue2022-figures")))
    robot.update_cfg({"leg_1_main_strut": 0.03})
    rod, mount = (
        robot.get_transform(f"leg_1_main_strut_{part}", BODY_FRAME)[:3, 3]
        for part in ("rod", "cylinder")
    )
    assert np.linalg.norm(rod - mount) == pytest.approx(
        load_preset("yue2022-figures").main_strut.length - 0.03, abs=1e-9
    )


def test_a_tripod_has_three_struts_that_meet_at_its_footpad() -> None:
    values = {"drop.mode": "space", "leg.kind": "tripod", "vehicle.cg_offset_x": 0.1}
    parameters = load_preset("yue2022-figures").with_values(values)
    robot, landing = parsed(robot_description(parameters)), Landing(parameters)
    joints = topics_of((1, 2, 3, 4), "tripod").joints
    assert len(joints) == 12
    assert set(robot.actuated_joint_names) == set(joints)
    now = landing.outputs()
    seen = Rotation.from_quat([now[f"body.q_{part}"] for part in "xyzw"]).inv()
    for leg in (1, 2, 3, 4):
        way = [now[f"leg[{leg}].footpad.{axis}"] - now[f"body.{axis}"] for axis in "xyz"]
        x, y, z = seen.apply(way)
        places = []
        for strut in ("main_strut", "auxiliary_strut", "auxiliary_strut_2"):
            name = f"leg_{leg}_{strut}"
            foot = robot.get_transform(f"{name}_rod", BODY_FRAME)[:3, 3]
            assert foot == pytest.approx([x, -z, y], abs=1e-9), name
            places.append(robot.get_transform(f"{name}_cylinder", BODY_FRAME)[:3, 3])
        spread = parameters.auxiliary_strut.joint_spread
        assert np.linalg.norm(places[1] - places[2]) == pytest.approx(2.0 * spread)
    markers = Wireframe(parameters).fill(0, landing.values()).markers
    assert [len(marker.points) for marker in markers] == [2, 8, 16, 4]
    # leg 1 looks backwards, and the side of e_t, that of its first auxiliary strut, is the left
    first, second = (markers[2].points[k].y for k in (0, 2))
    assert first - second == pytest.approx(2.0 * spread)
    assert kind_of(Wireframe(parameters).message) == ("space", 4, "tripod")
