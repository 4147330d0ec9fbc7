"""A sample of the model's outputs, and the messages of every topic for it, written out by hand.

The model: SI, x forward, y up, z right, pitch clockwise positive (nose down). ROS, REP-103: x
forward, y left, z up, positive turns by the right hand. So a vector (x, y, z) of the model is
(x, -z, y) in ROS, and the pitch is a positive turn about ROS +y. No number below is computed by the
package.
"""

from __future__ import annotations

from typing import Any

from rlv_landing.quantities import OUTPUT_NAMES

# 12 s and 345 000 006 ns.
NANOSECONDS = 12_345_000_006
HEADER = {"header.stamp.sec": 12, "header.stamp.nanosec": 345_000_006}

# cos(pitch) = 0.6, sin(pitch) = 0.8; cos(pitch / 2) = 2 / sqrt(5), sin(pitch / 2) = 1 / sqrt(5).
PITCH = 0.9272952180016122
HALF_COS, HALF_SIN = 0.8944271909999159, 0.4472135954999579

SAMPLE = {
    "body.x": 2.0,
    "body.y": 3.0,
    "body.pitch": PITCH,
    "body.vx": 5.0,
    "body.vy": -10.0,
    "body.pitch_rate": 0.25,
    "body.ax": 7.0,
    "body.ay": -8.0,
    "body.pitch_acceleration": 9.0,
    "body.top_axial_acceleration": -9.75,
    "leg[1].main_strut.stroke": 0.011,
    "leg[1].auxiliary_strut.stroke": -0.012,
    "leg[2].main_strut.stroke": 0.021,
    "leg[2].auxiliary_strut.stroke": -0.022,
    "leg[3].main_strut.stroke": 0.031,
    "leg[3].auxiliary_strut.stroke": -0.032,
    "leg[4].main_strut.stroke": 0.041,
    "leg[4].auxiliary_strut.stroke": -0.042,
    "leg[1].main_strut.stroke_rate": 1.1,
    "leg[1].auxiliary_strut.stroke_rate": -1.2,
    "leg[2].main_strut.stroke_rate": 2.1,
    "leg[2].auxiliary_strut.stroke_rate": -2.2,
    "leg[3].main_strut.stroke_rate": 3.1,
    "leg[3].auxiliary_strut.stroke_rate": -3.2,
    "leg[4].main_strut.stroke_rate": 4.1,
    "leg[4].auxiliary_strut.stroke_rate": -4.2,
    "leg[1].main_strut.force": -1100.0,
    "leg[1].auxiliary_strut.force": 1200.0,
    "leg[2].main_strut.force": -2100.0,
    "leg[2].auxiliary_strut.force": 2200.0,
    "leg[3].main_strut.force": -3100.0,
    "leg[3].auxiliary_strut.force": 3200.0,
    "leg[4].main_strut.force": -4100.0,
    "leg[4].auxiliary_strut.force": 4200.0,
    "leg[1].contact.force_x": 11.0,
    "leg[1].contact.force_y": 102.0,
    "leg[1].contact.force_z": 1.5,
    "leg[2].contact.force_x": 21.0,
    "leg[2].contact.force_y": 202.0,
    "leg[2].contact.force_z": -2.5,
    "leg[3].contact.force_x": -31.0,
    "leg[3].contact.force_y": 302.0,
    "leg[3].contact.force_z": 3.5,
    "leg[4].contact.force_x": 41.0,
    "leg[4].contact.force_y": -402.0,
    "leg[4].contact.force_z": 4.5,
    "leg[1].footpad.x": 1.25,
    "leg[1].footpad.y": 0.125,
    "leg[1].footpad.z": -0.5,
    "leg[2].footpad.x": 2.25,
    "leg[2].footpad.y": 0.225,
    "leg[2].footpad.z": -1.5,
    "leg[3].footpad.x": 3.25,
    "leg[3].footpad.y": 0.325,
    "leg[3].footpad.z": 0.75,
    "leg[4].footpad.x": 2.75,
    "leg[4].footpad.y": 0.425,
    "leg[4].footpad.z": 1.75,
}
# An output that no message should carry is 777, so that it shows where it does not belong.
VALUES = [SAMPLE.get(name, 777.0) for name in OUTPUT_NAMES]

# Topic -> what is not 0 and not empty in its message.
GOLDEN: dict[str, dict[str, Any]] = {
    "/clock": {"clock.sec": 12, "clock.nanosec": 345_000_006},
    "struts": {
        **HEADER,
        "header.frame_id": "base_link",
        "name[0]": "leg_1_main_strut",
        "name[1]": "leg_1_auxiliary_strut",
        "name[2]": "leg_2_main_strut",
        "name[3]": "leg_2_auxiliary_strut",
        "name[4]": "leg_3_main_strut",
        "name[5]": "leg_3_auxiliary_strut",
        "name[6]": "leg_4_main_strut",
        "name[7]": "leg_4_auxiliary_strut",
        "position[0]": 0.011,
        "position[1]": -0.012,
        "position[2]": 0.021,
        "position[3]": -0.022,
        "position[4]": 0.031,
        "position[5]": -0.032,
        "position[6]": 0.041,
        "position[7]": -0.042,
        "velocity[0]": 1.1,
        "velocity[1]": -1.2,
        "velocity[2]": 2.1,
        "velocity[3]": -2.2,
        "velocity[4]": 3.1,
        "velocity[5]": -3.2,
        "velocity[6]": 4.1,
        "velocity[7]": -4.2,
        "effort[0]": -1100.0,
        "effort[1]": 1200.0,
        "effort[2]": -2100.0,
        "effort[3]": 2200.0,
        "effort[4]": -3100.0,
        "effort[5]": 3200.0,
        "effort[6]": -4100.0,
        "effort[7]": 4200.0,
    },
    "pose": {
        **HEADER,
        "header.frame_id": "map",
        "pose.position.x": 2.0,
        "pose.position.z": 3.0,
        "pose.orientation.y": HALF_SIN,
        "pose.orientation.w": HALF_COS,
    },
    "rpy": {**HEADER, "header.frame_id": "map", "vector.y": PITCH},
    "twist": {
        **HEADER,
        "header.frame_id": "map",
        "twist.linear.x": 5.0,
        "twist.linear.z": -10.0,
        "twist.angular.y": 0.25,
    },
    "accel": {
        **HEADER,
        "header.frame_id": "map",
        "accel.linear.x": 7.0,
        "accel.linear.z": -8.0,
        "accel.angular.y": 9.0,
    },
    "top/accel": {**HEADER, "header.frame_id": "top_sensor", "accel.linear.z": -9.75},
    # By 10 m/s2 of gravity it feels (7, 2) in the map: 0.6 * 7 - 0.8 * 2 forward, 0.8 * 7 + 0.6 * 2
    # up in the body.
    "imu": {
        **HEADER,
        "header.frame_id": "base_link",
        "orientation.y": HALF_SIN,
        "orientation.w": HALF_COS,
        "angular_velocity.y": 0.25,
        "linear_acceleration.x": 2.6,
        "linear_acceleration.z": 6.8,
    },
    # 0.5 m above the CG, 9 rad/s2 make 4.5 m/s2 forward and 0.25 rad/s 0.03125 m/s2 down.
    "top/imu": {
        **HEADER,
        "header.frame_id": "top_sensor",
        "orientation.y": HALF_SIN,
        "orientation.w": HALF_COS,
        "angular_velocity.y": 0.25,
        "linear_acceleration.x": 7.1,
        "linear_acceleration.z": 6.76875,
    },
    "leg_1/contact": {
        **HEADER,
        "header.frame_id": "leg_1_footpad",
        "wrench.force.x": 11.0,
        "wrench.force.y": -1.5,
        "wrench.force.z": 102.0,
    },
    "leg_2/contact": {
        **HEADER,
        "header.frame_id": "leg_2_footpad",
        "wrench.force.x": 21.0,
        "wrench.force.y": 2.5,
        "wrench.force.z": 202.0,
    },
    "leg_3/contact": {
        **HEADER,
        "header.frame_id": "leg_3_footpad",
        "wrench.force.x": -31.0,
        "wrench.force.y": -3.5,
        "wrench.force.z": 302.0,
    },
    "leg_4/contact": {
        **HEADER,
        "header.frame_id": "leg_4_footpad",
        "wrench.force.x": 41.0,
        "wrench.force.y": -4.5,
        "wrench.force.z": -402.0,
    },
    "odom": {
        **HEADER,
        "header.frame_id": "odom",
        "child_frame_id": "base_link",
        "pose.pose.position.x": 2.0,
        "pose.pose.position.z": 3.0,
        "pose.pose.orientation.y": HALF_SIN,
        "pose.pose.orientation.w": HALF_COS,
        # In the body's frame. Its forward axis is (0.6, -0.8) in the map's forward and up, its up
        # axis (0.8, 0.6): 5 * 0.6 + 10 * 0.8 and 5 * 0.8 - 10 * 0.6.
        "twist.twist.linear.x": 11.0,
        "twist.twist.linear.z": -2.0,
        "twist.twist.angular.y": 0.25,
    },
}
# Topic -> the outputs that are read back from it.
CARRIED = {
    "struts": [n for n in SAMPLE if "_strut." in n],
    "pose": ["body.x", "body.y"],
    "rpy": ["body.pitch"],
    "twist": ["body.vx", "body.vy", "body.pitch_rate"],
    "accel": ["body.ax", "body.ay", "body.pitch_acceleration"],
    "top/accel": ["body.top_axial_acceleration"],
    "leg_1/contact": [n for n in SAMPLE if n.startswith("leg[1].contact")],
    "leg_2/contact": [n for n in SAMPLE if n.startswith("leg[2].contact")],
    "leg_3/contact": [n for n in SAMPLE if n.startswith("leg[3].contact")],
    "leg_4/contact": [n for n in SAMPLE if n.startswith("leg[4].contact")],
}

# lengths of a vehicle [m]
ROUND_NUMBERS = {
    "vehicle.top_height": 0.5,
    "main_strut.joint_radius": 0.5,
    "main_strut.joint_depth": 1.0,
    "main_strut.length": 1.5,
    "auxiliary_strut.joint_radius": 0.5,
    "auxiliary_strut.joint_depth": 1.5,
    "auxiliary_strut.length": 1.25,
}
