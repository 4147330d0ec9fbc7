"""Lands once: the node, its log, and on request a view of it.

ros2 launch rlv_ros_bridge landing.launch.py fmu:=/path/RlvLanding.fmu mode:=1-2-1 record:=true
view:=true
"""

from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

SHARE = FindPackageShare("rlv_ros_bridge")
# name, default, meaning
ARGUMENTS = (
    ("namespace", "landing", "namespace of node and topics"),
    ("fmu", "build/RlvLanding.fmu", "the FMU to step"),
    ("mode", "2-2", "landing mode: 2-2 or 1-2-1"),
    ("realtime_factor", "1.0", "simulated seconds per second of wall time; 0: as fast as possible"),
    ("parameters", PathJoinSubstitution([SHARE, "config", "landing.yaml"]), "ROS parameter file"),
    ("record", "true", "whether the landing is recorded"),
    ("log_root", "logs", "folder below which it is recorded"),
    ("autostart", "true", "land at once and end; false: wait for lifecycle transitions"),
    ("view", "false", "whether RViz shows it"),
)


def generate_launch_description() -> LaunchDescription:
    """The node with what was asked for; when it ends, so does the launch."""
    value = {name: LaunchConfiguration(name) for name, _, _ in ARGUMENTS}
    node = Node(
        package="rlv_ros_bridge",
        executable="landing_node",
        namespace=value["namespace"],
        output="screen",
        parameters=[
            value["parameters"],
            {
                "fmu": value["fmu"],
                "mode": ParameterValue(value["mode"], value_type=str),
                "realtime_factor": ParameterValue(value["realtime_factor"], value_type=float),
                "log_root": ParameterValue(
                    PythonExpression(
                        [
                            "'",
                            value["log_root"],
                            "' if '",
                            value["record"],
                            "'.lower() == 'true' else ''",
                        ]
                    ),
                    value_type=str,
                ),
                "autostart": ParameterValue(value["autostart"], value_type=bool),
            },
        ],
    )
    view = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([SHARE, "config", "landing.rviz"])],
        condition=IfCondition(value["view"]),
    )
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=meaning)
                for name, default, meaning in ARGUMENTS
            ),
            node,
            view,
            RegisterEventHandler(
                OnProcessExit(
                    target_action=node, on_exit=[EmitEvent(event=Shutdown(reason="landed"))]
                )
            ),
        ]
    )
