"""The live topics of landings as Rerun scenes, one scene for each landing.

Needs rerun-sdk and ROS 2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter
from rclpy.parameter_client import AsyncParameterClient

from rlv_landing.assembly import DeckMotion
from rlv_landing.errors import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters
from rlv_landing.quantities import LEAST_LEGS, MODES, MOST_LEGS, RADIAL, SPACE, TRIPOD
from rlv_landing.touchdown import leg_directions

from ..messages.axes import to_ros
from ..messages.columns import sample_columns
from ..messages.message_types import message_class
from ..messages.qos import Qos
from ..messages.rclpy_qos import qos_profile
from ..messages.topics import MARKERS, RPY, STRUTS, TWIST, Topic, resolve, topics_of
from ..messages.wire import NANOSECONDS
from ..ros.setup import StopFlag, ros_context
from ..ros.spinner import Spinner
from .rerun_scene import AUXILIARY, BODY, MAIN, Scene

# of a landing on any number of legs
CONTACTS = topics_of(tuple(range(1, MOST_LEGS + 1))).contacts
# `struts` last: a node that waits for a subscriber of it finds the others matched.
WATCHED: tuple[Topic, ...] = (RPY, TWIST, *CONTACTS, STRUTS)
# Reliable: what is sent before the viewer has found its sender comes all the same. Five seconds of
# messages may wait. A viewer that takes none does not delay the landing.
QOS = Qos(depth=5000)
Kind = RosParameter.Type
# Samples that lack a topic are dropped when a sample is newer by this [ns].
LONGEST_GAP = 2_000_000_000
# Period of drawing [s], and of checking for signals [s].
DRAW_SECONDS, POLL_SECONDS = 0.05, 0.1
# Parameters of the node that say how its ground lies, and moves at sea.
GROUND = (
    *("ground.slope", "ground.slope_direction", "ground.terrain", "drop.contact_time"),
    *("ground.roughness", "ground.roughness_length", "ground.terrain_seed"),
    *(name for name in PARAMETER_QUANTITIES if name.startswith("sea.")),
)


class LiveScenes:
    """Subscribes to a landing's topics, and draws them.

    A stamp before the previous one starts a new scene: the landing was reset. `samples` counts what
    was drawn. `failure` is the error of a scene that could not be made.

    Args:
        node: the node of the subscriptions.
        namespace: that of the landing.
        on_scene: called with each new scene, at its first markers.
    """

    def __init__(self, node: Node, namespace: str, on_scene: Callable[[Scene], object]) -> None:
        self.samples = 0
        self.scene: Scene | None = None
        self.failure: LandingError | None = None
        self._on_scene, self._last_stamp = on_scene, -1
        # Messages by stamp and topic, and markers with their stamps, that are not drawn yet.
        self._rows: dict[int, dict[str, Any]] = {}
        self._markers: list[tuple[int, Any]] = []
        self._forces: dict[str, float] = {}
        # the deck of a landing at sea
        self._deck: DeckMotion | None = None
        for topic in (MARKERS, *WATCHED):
            callback = self._receive_markers if topic is MARKERS else self._row_callback(topic)
            node.create_subscription(
                message_class(topic.type_name),
                resolve(namespace, topic.name),
                callback,
                qos_profile(QOS),
            )
        self._parameters = AsyncParameterClient(node, resolve(namespace, "landing_node"))
        node.create_timer(DRAW_SECONDS, self.draw)

    def _row_callback(self, topic: Topic) -> Callable[[Any], None]:
        def receive(message: Any) -> None:
            self._rows.setdefault(stamp_of(message.header), {})[topic.name] = message

        return receive

    def _receive_markers(self, message: Any) -> None:
        stamp = stamp_of(message.markers[0].header)
        if stamp < self._last_stamp or self.scene is None:
            self.draw()
            if self.scene is not None:
                # what is left of the landing before
                self._rows = {t: row for t, row in self._rows.items() if t <= stamp}
            try:
                self.scene = Scene(*kind_of(message))
                self.scene.ground(Parameters())
                self._deck = None
                self._on_scene(self.scene)
            except LandingError as e:
                self.failure = e
                return
            self._request_ground(self.scene)
        self._last_stamp = stamp
        self._markers.append((stamp, message))

    def _request_ground(self, scene: Scene) -> None:
        # A replay has no such parameters, so its ground is drawn level.
        if self._parameters.services_are_ready():

            def draw_ground(answer: Any) -> None:
                told = dict(zip(GROUND, answer.result().values))
                # those that the node does not have are of no type
                given = {
                    name: v.string_value if v.type == Kind.STRING.value else v.double_value
                    for name, v in told.items()
                    if v.type in (Kind.STRING.value, Kind.DOUBLE.value)
                }
                # only landings in space have a sea; with four legs markers may not tell them
                in_space = scene.interface.in_space or "sea.wave_height" in given
                own = {"drop.mode": SPACE} if in_space else {}
                try:
                    parameters = Parameters().with_values({**own, **given})
                    scene.ground(parameters)
                    self._deck = DeckMotion.at_sea(parameters)
                except LandingError as e:
                    # rclpy's executor crashes where a callback of a future raises
                    self.failure = e

            self._parameters.get_parameters(list(GROUND)).add_done_callback(draw_ground)

    def draw(self) -> None:
        """Draws what has been received since the last time."""
        oldest = max(self._rows, default=0) - LONGEST_GAP
        if self.scene is None:
            self._rows = {t: row for t, row in self._rows.items() if t > oldest}
            return
        try:
            complete = {
                t: self._columns(row)
                for t, row in sorted(self._rows.items())
                if self._is_whole(row)
            }
        except LandingError as e:
            self.failure = e
            return
        self._rows = {t: row for t, row in self._rows.items() if t not in complete and t > oldest}
        if complete:
            rows = list(complete.values())
            time = np.array(list(complete)) / NANOSECONDS
            self.scene.curves(
                time, {name: np.array([row[name] for row in rows]) for name in rows[0]}
            )
            self.samples += len(rows)
            self._forces = rows[-1]
        if self._markers:
            self._draw_vehicle(self.scene, complete)
        self._markers = []

    def _is_whole(self, row: dict[str, Any]) -> bool:
        """Whether all topics of the landing are there."""
        assert self.scene is not None
        contacts = topics_of(self.scene.interface.legs).contacts
        return all(t.name in row for t in (RPY, TWIST, *contacts, STRUTS))

    def _columns(self, row: dict[str, Any]) -> dict[str, float]:
        """The outputs that the messages of an instant carry."""
        assert self.scene is not None
        return sample_columns(row, self.scene.interface)

    def _draw_vehicle(self, scene: Scene, complete: dict[int, dict[str, float]]) -> None:
        time = np.array([stamp for stamp, _ in self._markers]) / NANOSECONDS
        body, main, auxiliary, feet = (
            np.array([[(p.x, p.y, p.z) for p in m.markers[i].points] for _, m in self._markers])
            for i in range(4)
        )
        shape = (len(time), -1, 2, 3)
        for entity, points in ((BODY, body), (MAIN, main), (AUXILIARY, auxiliary)):
            scene.lines(entity, time, (points.reshape(shape),))
        scene.footpads(time, feet)
        if self._deck is not None:
            scene.decks(time, [self._deck.at(float(t)) for t in time])
        rows = [complete.get(stamp, self._forces) for stamp, _ in self._markers]
        forces = [
            [
                to_ros(*(row.get(f"leg[{leg}].contact.force_{axis}", 0.0) for axis in "xyz"))
                for leg in scene.interface.legs
            ]
            for row in rows
        ]
        scene.contacts(time, feet, np.array(forces))


def watch(
    namespace: str,
    on_scene: Callable[[Scene], object],
    keep_running: Callable[[], bool],
    stop: StopFlag,
) -> int:
    """Draws the landings below a namespace; the number of samples drawn.

    Args:
        namespace: that of the landing.
        on_scene: called with each new scene.
        keep_running: called at each poll; false ends it. What it raises is raised here.
        stop: notes signals, which end it.

    Raises:
        LandingError: ROS 2 is missing, or markers that are no landing's.
    """
    with ros_context():
        node = Node("landing_view")
        scenes = LiveScenes(node, namespace, on_scene)
        try:
            with Spinner(node) as spinner:
                while not stop and keep_running() and scenes.failure is None:
                    stop.wait(POLL_SECONDS)
                # what has come and waits
                spinner.call(scenes.draw)
        finally:
            node.destroy_node()
        if scenes.failure is not None:
            raise scenes.failure
        if scenes.scene is not None:
            scenes.scene.stream.flush()
        return scenes.samples


def stamp_of(header: Any) -> int:
    """The stamp of a header [ns]."""
    return int(header.stamp.sec) * NANOSECONDS + int(header.stamp.nanosec)


def kind_of(markers: Any) -> tuple[str, int, str]:
    """The mode of the landing of a vehicle in `markers`, its number of legs, and their kind.

    A landing is symmetric if its main struts are joined to the body as in a landing mode: in its
    plane of symmetry or beside it, in their order. Any other is one in space.

    Raises:
        LandingError: the legs are more or fewer than a landing has.
    """
    across = [p.y for p in markers.markers[1].points[::2]]
    if len(markers.markers[2].points) > len(markers.markers[1].points):
        return SPACE, _checked_legs(across), TRIPOD
    radius = max(map(abs, across), default=0.0)
    for mode in MODES:
        sines = [sine for sine, _ in leg_directions(Parameters().for_mode(mode)).values()]
        reach = max(map(abs, sines))
        fits = len(across) == len(sines)
        if fits and np.allclose(across, [-s * radius / reach for s in sines], atol=1e-6):
            return mode, len(sines), RADIAL
    return SPACE, _checked_legs(across), RADIAL


def _checked_legs(across: Sequence[float]) -> int:
    """The number of legs, from something of each main strut."""
    if not LEAST_LEGS <= len(across) <= MOST_LEGS:
        raise LandingError(
            f"the markers have {len(across)} main struts; a landing has {LEAST_LEGS} to {MOST_LEGS}"
        )
    return len(across)
