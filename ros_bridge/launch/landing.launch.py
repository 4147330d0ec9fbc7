"""Lands: the node, its log, and on request a view of it.

ros2 launch rlv_ros_bridge landing.launch.py mode:=1-2-1 record:=true view:=true
"""

from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown, matches_action
from launch.events.process import ProcessExited
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity

SHARE = FindPackageShare("rlv_ros_bridge")
# name, default, meaning
ARGUMENTS = (
    ("namespace", "landing", "namespace of node and topics"),
    ("parameters", PathJoinSubstitution([SHARE, "config", "landing.yaml"]), "ROS parameter file"),
    ("record", "true", "whether the landing is recorded"),
    ("log_root", "logs", "folder below which it is recorded"),
    ("autostart", "true", "land at once and end; false: wait for transitions by others"),
    (
        "managed",
        "false",
        "configure and activate the node by this launch's events; it stays after the landing",
    ),
    ("view", "false", "whether RViz shows it"),
)
# The node's parameters of the same name; those that are not given are the parameter file's.
GIVEN = (
    ("fmu", "the FMU to step"),
    ("mode", "landing mode: 2-2 or 1-2-1"),
    ("realtime_factor", "simulated seconds per second of wall time; 0: as fast as possible"),
)


def generate_launch_description() -> LaunchDescription:
    """The node with what was asked for; when it ends, so does the launch."""
    declared = (*ARGUMENTS, *((name, "", meaning) for name, meaning in GIVEN))
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=meaning)
                for name, default, meaning in declared
            ),
            OpaqueFunction(function=_nodes),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", PathJoinSubstitution([SHARE, "config", "landing.rviz"])],
                condition=IfCondition(LaunchConfiguration("view")),
            ),
        ]
    )


def _nodes(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    value = context.launch_configurations
    record, autostart, managed = (
        IfCondition(LaunchConfiguration(name)).evaluate(context)
        for name in ("record", "autostart", "managed")
    )
    # Texts, which the node checks: it says what is wrong with them.
    given = {name: value[name] for name, _ in GIVEN if value[name]}
    given["log_root"] = value["log_root"] if record else ""
    node = LifecycleNode(
        package="rlv_ros_bridge",
        executable="landing_node",
        name="landing_node",
        namespace=value["namespace"],
        output="screen",
        parameters=[
            value["parameters"],
            {
                **{name: ParameterValue(text, value_type=str) for name, text in given.items()},
                "autostart": autostart and not managed,
            },
        ],
    )
    handlers = [OnProcessExit(target_action=node, on_exit=_shut_down)]
    if managed:
        handlers += _transitions(node)
    return [*map(RegisterEventHandler, handlers), node]


def _shut_down(_: ProcessExited, context: LaunchContext) -> EmitEvent | None:
    # After Ctrl-C the launch shuts down already; a second time is an error of launch_ros.
    if context.is_shutdown:
        return None
    return EmitEvent(event=Shutdown(reason="the landing node has ended"))


def _transitions(node: LifecycleNode) -> list[OnProcessStart | OnStateTransition]:
    """Configures the node once it runs, and activates it once it is configured."""

    def change(transition: int) -> EmitEvent:
        return EmitEvent(
            event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition)
        )

    refused = EmitEvent(event=Shutdown(reason="the landing node cannot be configured"))
    return [
        OnProcessStart(target_action=node, on_start=[change(Transition.TRANSITION_CONFIGURE)]),
        OnStateTransition(
            target_lifecycle_node=node,
            start_state="configuring",
            goal_state="inactive",
            entities=[change(Transition.TRANSITION_ACTIVATE)],
        ),
        OnStateTransition(
            target_lifecycle_node=node,
            start_state="configuring",
            goal_state="unconfigured",
            entities=[refused],
        ),
    ]
