"""The ROS 2 lifecycle node that lands: configure loads the FMU, activate lands, deactivate pauses,
cleanup frees.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from rlv_landing.errors import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import INPUT_QUANTITIES, OUTPUT_QUANTITIES

from ..messages import topics
from ..messages.message_types import is_installed, message_class
from ..messages.qos import CLOCK, LATCHED, PROFILES, TELEMETRY, Qos
from ..messages.rclpy_qos import qos_profile
from ..messages.robot_description import robot_description, variables
from ..messages.topics import Topic, resolve
from ..ros.setup import wait_for_acknowledgement, wait_until_matched
from .input_queue import InputQueue
from .landing_run import LandingRun
from .landing_services import create_landing_services
from .parameters import NodeParameters
from .publisher import LivePublisher, Outlet
from .run_summary import RunSummary
from .settings import unused

NAMESPACE = "landing"
SUCCESS, FAILURE, ERROR = (
    TransitionCallbackReturn.SUCCESS,
    TransitionCallbackReturn.FAILURE,
    TransitionCallbackReturn.ERROR,
)
# A warning of one kind is repeated at most this often [s].
WARN_SECONDS = 1.0


class LandingNode(LifecycleNode):
    """Lands when it is activated, in a thread of its own.

    Its ROS parameters are those of `rlv_ros_bridge.node.settings` and the model's own.

    `changes` are parameters that win over the command line's. `failure` is the error that the last
    transition or the landing met with. `over` is set when the landing has come to its end or to an
    error, and when the node is shut down. Raises LandingError for bad parameters.
    """

    def __init__(
        self, changes: Mapping[str, Any] | None = None, namespace: str = NAMESPACE
    ) -> None:
        given = [Parameter(name, value=value) for name, value in (changes or {}).items()]
        super().__init__("landing_node", namespace=namespace, parameter_overrides=given)
        self.failure: LandingError | None = None
        self.over = threading.Event()
        self.landing: LandingRun | None = None
        self._thread: threading.Thread | None = None
        self.values = NodeParameters(
            self, lambda: self._thread is not None, self._parameters_changed
        )
        self._pause = threading.Event()
        self._fatal: LandingError | None = None
        self._last: LandingRun | None = None
        self._landings = 0
        self._warned: dict[str, float] = {}
        self._qos = PROFILES[self.values["qos"]]
        self._live = LivePublisher()
        self._names: dict[Topic, str] = {}
        self._outlets: dict[Topic, Outlet] = {}
        # `struts` last: who waits for a match on it finds the others matched.
        for topic in (
            *topics.LATCHED,
            *reversed([t for t in topics.RECORDED if t not in topics.LATCHED]),
        ):
            self._add_outlet(topic, LATCHED if topic in topics.LATCHED else self._qos)
        if self.values["clock"]:
            self._add_outlet(topics.CLOCK, CLOCK)
        self._inputs = InputQueue(self.values["input_timeout"], self._warn)
        self.create_subscription(
            WrenchStamped, "external_wrench", self._inputs.take_wrench, qos_profile(TELEMETRY)
        )
        self.create_subscription(
            JointState, "ground", self._inputs.take_ground, qos_profile(TELEMETRY)
        )
        create_landing_services(self, self.reset, self.step)

    def _add_outlet(self, topic: Topic, qos: Qos) -> None:
        name = self._names[topic] = resolve(self.get_namespace(), topic.name)
        if topic is not topics.TF or is_installed(topic.type_name):
            self._outlets[topic] = self._live.add(
                Outlet(
                    self.create_publisher(message_class(topic.type_name), name, qos_profile(qos))
                )
            )

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Loads the FMU, tells what it has, and describes the vehicle.

        Fails, with the reason in the node's log, where that cannot be.
        """
        return self._transition(self._make_landing, FAILURE)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Lands, or goes on after a pause, in the pace of `realtime_factor`.

        The first time it begins the log.
        """
        return self._transition(self._start, FAILURE)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Pauses. After an error of the landing it leads to the error's processing."""
        return self._transition(self._stop_or_raise, ERROR)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Completes the log and frees the FMU."""
        return self._transition(self._free, ERROR)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """As cleanup, from any state; the node can do nothing afterwards."""
        result = self._transition(self._free, ERROR)
        self.over.set()
        return result

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Frees everything: the node is unconfigured afterwards, with its log complete as far as it
        got.
        """
        failure = self.failure
        result = self._transition(self._free, FAILURE)
        self.failure = failure
        self.over.set()
        return result

    def _transition(
        self, action: Callable[[], None], otherwise: TransitionCallbackReturn
    ) -> TransitionCallbackReturn:
        # rclpy takes exceptions from transitions without a word.
        self.failure = None
        try:
            action()
            return SUCCESS
        except LandingError as e:
            self.failure = e
        except Exception as e:
            self.failure = LandingError(f"{type(e).__name__}: {e}")
        # The command that walks the states by itself says it.
        if not self.values["autostart"]:
            self.get_logger().error(str(self.failure))
        return otherwise

    def _make_landing(self) -> None:
        settings = self.values.settings()
        folder = settings.folder()
        for topic, outlet in self._outlets.items():
            outlet.every = settings.every.get(topic, 1) if topic not in topics.OCCASIONAL else 1
        self.landing = LandingRun(
            settings,
            folder if folder is None or not self._landings else unused(folder),
            self._live,
            self._outlets,
            self._names,
            self._qos,
            self._inputs,
            self.get_fully_qualified_name().strip("/"),
            self.get_namespace(),
            lambda text: self.get_logger().error(text),
        )
        fmu = self.landing.fmu
        counts = f"{len(PARAMETER_QUANTITIES)} parameters, {len(INPUT_QUANTITIES)} inputs, {len(OUTPUT_QUANTITIES)} outputs"
        self.get_logger().info(
            f"{fmu.path}, version {fmu.version}: {counts}, listed on {self._names[topics.VARIABLES]}"
        )
        for topic, text in (
            (topics.VARIABLES, variables()),
            (topics.ROBOT_DESCRIPTION, robot_description(settings.parameters)),
        ):
            data = serialize_message(String(data=text))
            self._outlets[topic].publish(data)
            if topic is topics.ROBOT_DESCRIPTION:
                self.landing.description = data

    def _start(self) -> None:
        landing = self._need_landing()
        self._begin(landing)
        self._pause.clear()
        self.over.clear()
        self._thread = threading.Thread(
            target=self._land, args=(landing,), name="landing", daemon=True
        )
        self._thread.start()

    def _begin(self, landing: LandingRun) -> None:
        if landing.recorder is None and not landing.samples:
            landing.open_log()
            self._landings += 1

    def _land(self, landing: LandingRun) -> None:
        try:
            if not landing.samples:
                s = landing.settings
                wait_until_matched(
                    self._outlets[topics.STRUTS].publisher,
                    s.wait_for_subscribers,
                    s.wait_timeout,
                    self._pause.is_set,
                )
            landing.go_on(self._pause.is_set)
            if landing.end:
                self.get_logger().debug(f"{landing.end} after {landing.time:g} s")
                landing.close_log()
                self.over.set()
        except Exception as e:
            self._fatal = (
                e if isinstance(e, LandingError) else LandingError(f"{type(e).__name__}: {e}")
            )
            # Transitions belong to the executor's thread.
            if self.executor is not None:
                self.executor.create_task(self.trigger_deactivate)

    def _stop(self) -> None:
        thread, self._thread = self._thread, None
        if thread is not None:
            self._pause.set()
            thread.join()

    def _stop_or_raise(self) -> None:
        self._stop()
        fatal, self._fatal = self._fatal, None
        if fatal is not None:
            raise fatal

    def _free(self) -> None:
        self._stop()
        landing, self.landing = self.landing, None
        if landing is not None:
            self._last = landing
            landing.close()

    def _need_landing(self) -> LandingRun:
        if self.landing is None:
            raise LandingError("there is no landing; configure the node first")
        return self.landing

    def reset(self) -> str:
        """Back to time 0 with the parameters as they are now, and a log of its own; a node that
        lands lands on from there.
        """
        self._need_landing()
        lands = self._thread is not None
        self._free()
        self._make_landing()
        if lands:
            self._start()
        return f"back to 0 s{', landing' if lands else ''}"

    def step(self) -> str:
        """`step_count` steps of a node that is configured and does not land; the time reached.

        Raises LandingError in another state.
        """
        landing = self._need_landing()
        if self._thread is not None:
            raise LandingError("the node lands; deactivate it, then it can be stepped")
        if landing.end:
            raise LandingError(
                f"the landing has {landing.end} at {landing.time:g} s; ~/reset begins another"
            )
        self._begin(landing)
        landing.step(self.values["step_count"])
        if landing.end:
            landing.close_log()
        return f"at {landing.time:.9g} s{f', {landing.end}' if landing.end else ''}"

    def _parameters_changed(self, changed: dict[str, Any]) -> None:
        if "realtime_factor" in changed and self.landing is not None:
            self.landing.realtime_factor = changed["realtime_factor"]
        self._inputs.timeout = self.values["input_timeout"]

    def _warn(self, text: str) -> None:
        now, kind = time.monotonic(), text.split(":")[0]
        if now - self._warned.get(kind, -WARN_SECONDS) >= WARN_SECONDS:
            self._warned[kind] = now
            self.get_logger().warning(text)

    @property
    def state(self) -> str:
        """The lifecycle's state: unconfigured, inactive, active, finalized, or on the way between
        two of them.
        """
        return str(self._state_machine.current_state[1])

    @property
    def has_landed(self) -> bool:
        """Whether there is a landing of which there is something to tell."""
        landing = self.landing or self._last
        return landing is not None and landing.samples > 0

    def summary(self, signal: int) -> RunSummary:
        """How the last landing went, once it has ended or is paused; `signal` is the one that
        interrupted it, or 0.
        """
        landing = self.landing or self._last
        if landing is None:
            raise LandingError("nothing has landed; configure and activate the node")
        publishers = [
            o.publisher
            for t, o in self._outlets.items()
            if t not in topics.LATCHED and t is not topics.CLOCK
        ]
        acknowledged = wait_for_acknowledgement(publishers, interrupted=bool(signal))
        return landing.summary(landing.end or "interrupted", signal, acknowledged)

    def destroy_node(self) -> None:
        """Also ends the landing, completes its log and frees the FMU."""
        self._free()
        super().destroy_node()
