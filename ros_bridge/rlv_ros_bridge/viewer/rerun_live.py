"""The live topics of a landing as Rerun scenes, one for each landing that is heard.

Needs rerun-sdk and ROS 2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.parameter_client import AsyncParameterClient

from rlv_landing.errors import LandingError
from rlv_landing.quantities import LEGS, MODES

from ..messages.axes import to_ros
from ..messages.columns import READINGS
from ..messages.legs import around
from ..messages.message_types import message_class
from ..messages.qos import Qos
from ..messages.rclpy_qos import qos_profile
from ..messages.topics import CONTACTS, MARKERS, RPY, STRUTS, TWIST, Topic, resolve
from ..ros.setup import StopFlag, ros_context
from ..ros.spinner import Spinner
from .rerun_scene import AUXILIARY, BODY, MAIN, Scene

WATCHED: tuple[Topic, ...] = (STRUTS, RPY, TWIST, *CONTACTS)
# What is shown must not hold the landing up, so nothing is sent again; a second of it may wait
# here.
QOS = Qos(reliability="best_effort", depth=1000)
# Samples that lack a topic longer than this are given up [ns].
PATIENCE = 100_000_000
NANOSECONDS = 1_000_000_000
# How often what was heard is shown [s], and how often signals are looked after.
SHOW_SECONDS, LOOK_ROUND_SECONDS = 0.05, 0.1
STILL = dict.fromkeys((f"leg[{leg}].contact.force_{axis}" for leg in LEGS for axis in "xyz"), 0.0)


class LiveScenes:
    """Subscribes `node` to the landing below `namespace`; `begin` is told of each new scene, once
    its first markers are there.

    A stamp that lies before the one before begins a new scene: somebody has reset the landing.
    `samples` counts what was shown, `failure` is what went wrong.
    """

    def __init__(self, node: Node, namespace: str, begin: Callable[[Scene], object]) -> None:
        self.samples = 0
        self.scene: Scene | None = None
        self.failure: LandingError | None = None
        self._begin, self._last = begin, -1
        self._columns = sum(len(READINGS[t.name][0]) for t in WATCHED)
        self._rows: dict[int, dict[str, float]] = {}
        self._marked: list[tuple[int, Any]] = []
        self._forces = STILL
        for topic in (*WATCHED, MARKERS):
            take = self._take_markers if topic is MARKERS else self._taker(topic)
            node.create_subscription(
                message_class(topic.type_name),
                resolve(namespace, topic.name),
                take,
                qos_profile(QOS),
            )
        self._asking = AsyncParameterClient(node, resolve(namespace, "landing_node"))
        node.create_timer(SHOW_SECONDS, self._show)

    def _taker(self, topic: Topic) -> Callable[[Any], None]:
        names, reading = READINGS[topic.name]

        def take(message: Any) -> None:
            self._rows.setdefault(stamp_of(message.header), {}).update(zip(names, reading(message)))

        return take

    def _take_markers(self, message: Any) -> None:
        at = stamp_of(message.markers[0].header)
        if at < self._last or self.scene is None:
            self._show()
            try:
                self.scene = Scene(mode_of(message))
                self._begin(self.scene)
            except LandingError as e:
                self.failure = e
                return
            self._rows = {t: row for t, row in self._rows.items() if t <= at}
            self._ask_for_the_slope(self.scene)
        self._last = at
        self._marked.append((at, message))

    def _ask_for_the_slope(self, scene: Scene) -> None:
        # A replay has no such parameter: its ground is drawn level.
        if self._asking.services_are_ready():

            def draw(answer: Any) -> None:
                for slope in answer.result().values:
                    scene.ground(slope.double_value)

            self._asking.get_parameters(["ground.slope"]).add_done_callback(draw)

    def _show(self) -> None:
        complete = {t: row for t, row in sorted(self._rows.items()) if len(row) == self._columns}
        newest = max(self._rows, default=0)
        self._rows = {
            t: row for t, row in self._rows.items() if t not in complete and t > newest - PATIENCE
        }
        if self.scene is None:
            return
        if complete:
            rows = list(complete.values())
            time = np.array(list(complete)) / NANOSECONDS
            self.scene.curves(
                time, {name: np.array([row[name] for row in rows]) for name in rows[0]}
            )
            self.samples += len(rows)
            self._forces = rows[-1]
        if self._marked:
            self._draw(self.scene, complete)
        self._marked = []

    def _draw(self, scene: Scene, complete: dict[int, dict[str, float]]) -> None:
        time = np.array([at for at, _ in self._marked]) / NANOSECONDS
        body, main, auxiliary, feet = (
            np.array([[(p.x, p.y, p.z) for p in m.markers[i].points] for _, m in self._marked])
            for i in range(4)
        )
        shape = (len(time), -1, 2, 3)
        for entity, points in ((BODY, body), (MAIN, main), (AUXILIARY, auxiliary)):
            scene.lines(entity, time, (points.reshape(shape),))
        scene.footpads(time, feet)
        forces = [complete.get(at, self._forces) for at, _ in self._marked]
        columns = [
            [to_ros(*(row[f"leg[{leg}].contact.force_{axis}"] for axis in "xyz")) for leg in LEGS]
            for row in forces
        ]
        scene.contacts(time, feet, np.array(columns))


def watch(
    namespace: str, begin: Callable[[Scene], object], going_on: Callable[[], object], stop: StopFlag
) -> int:
    """Shows the landings below `namespace` until a signal comes or `going_on` gets false; how many
    samples were shown.

    Raises LandingError: no ROS 2, or markers that are no landing's; and what `going_on` raises.
    """
    with ros_context() as rclpy:
        node = rclpy.create_node("landing_view")
        scenes = LiveScenes(node, namespace, begin)
        try:
            with Spinner(node):
                while not stop and going_on() and scenes.failure is None:
                    stop.wait(LOOK_ROUND_SECONDS)
        finally:
            node.destroy_node()
        if scenes.failure is not None:
            raise scenes.failure
        if scenes.scene is not None:
            scenes.scene.stream.flush()
        return scenes.samples


def stamp_of(header: Any) -> int:
    """A header's stamp [ns]."""
    return int(header.stamp.sec) * NANOSECONDS + int(header.stamp.nanosec)


def mode_of(markers: Any) -> str:
    """The landing mode, told by where the main struts of `markers` are joined to the body: legs lie
    in the body's plane, or all beside it.

    Raises LandingError where that is no mode of ours.
    """
    across = [p.y for p in markers.markers[1].points[::2]]
    radius = max(map(abs, across))
    for mode in MODES:
        reach = max(abs(y) for _, y, _ in around(mode, 1.0, 0.0))
        if np.allclose(
            across, [y * radius / reach for _, y, _ in around(mode, 1.0, 0.0)], atol=1e-6
        ):
            return mode
    raise LandingError(
        f"the markers' struts are joined at y = {', '.join(f'{y:.3g}' for y in across)} m, which is no landing mode"
    )
