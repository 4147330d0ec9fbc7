"""The ROS 2 lifecycle node that lands.

Configure loads the FMU, activate lands, deactivate pauses, cleanup frees the FMU.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState

from rlv_landing.audit.transverse import joint_warning
from rlv_landing.errors import LandingError, first_of
from rlv_landing.parameters import parameters_of

from ..messages import topics
from ..messages.inputs import input_table_of
from ..messages.qos import INPUT, PROFILES
from ..messages.rclpy_qos import create_subscription
from ..ros.rclpy_internals import lifecycle_state
from ..ros.setup import wait_for_acknowledgement
from .input_queue import InputQueue
from .landing_run import Identity, LandingRun
from .landing_thread import LandingThread, as_landing_error, create_landing_services
from .parameters import NodeParameters, unused_overrides
from .publishing import create_publishing
from .run_summary import RunSummary
from .settings import unused_folder

NAMESPACE = "landing"
SUCCESS, FAILURE, ERROR = (
    TransitionCallbackReturn.SUCCESS,
    TransitionCallbackReturn.FAILURE,
    TransitionCallbackReturn.ERROR,
)
# Shortest time between two warnings of one kind [s].
WARN_SECONDS = 1.0


class LandingNode(LifecycleNode):
    """Lands when it is activated, in a thread of its own.

    Its ROS parameters are those of `rlv_ros_bridge.node.settings` and the model's own.

    `failure` is the error of the last transition or of the landing. `ended` is set when the landing
    has ended or failed, and when the node is shut down.

    Args:
        changes: ROS parameters by name; they override those of the command line.
        namespace: namespace of the node and its topics.
        shared: parameters that a file gives to every node; unknown ones are ignored with a warning.

    Raises:
        LandingError: bad parameters.
    """

    def __init__(
        self,
        changes: Mapping[str, Any] | None = None,
        namespace: str = NAMESPACE,
        shared: frozenset[str] = frozenset(),
    ) -> None:
        given = [Parameter(name, value=value) for name, value in (changes or {}).items()]
        super().__init__("landing_node", namespace=namespace, parameter_overrides=given)
        self.failure: LandingError | None = None
        self.ended = threading.Event()
        self.landing: LandingRun | None = None
        self._thread: LandingThread | None = None
        self.values = NodeParameters(
            self, lambda: self.is_landing, self._parameters_changed, shared
        )
        self._landing_error: LandingError | None = None
        self._previous: LandingRun | None = None
        self._landings = 0
        self._last_warning: dict[str, float] = {}
        qos = PROFILES[self.values["qos"]]
        own = self.values.parameters
        interface = own.interface
        self._publishing = create_publishing(self, qos, interface.legs, clock=self.values["clock"])
        inputs = input_table_of(interface)
        self._inputs = InputQueue(self.values["input_timeout"], self._warn, inputs)
        for kind, name, callback in (
            (WrenchStamped, "external_wrench", self._inputs.receive_wrench),
            (JointState, "ground", self._inputs.receive_ground),
        ):
            create_subscription(self, kind, name, callback, INPUT)
        create_landing_services(self, self.reset, self.step)
        foreign = unused_overrides(self, shared)
        if foreign:
            self.get_logger().warning(
                f"ignored, as no parameters of this node: {first_of(foreign)} "
                "(a parameter file gives them to every node)"
            )

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Loads the FMU, publishes its variables and the vehicle's description.

        Fails, with the reason in the node's log, where the FMU or a setting does not fit.
        """
        return self._transition(self._make_landing, FAILURE)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Starts or continues the landing at the pace of `realtime_factor`.

        The first activation opens the log.
        """
        return self._transition(self._start, FAILURE)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Pauses the landing; after an error of the landing it leads to error processing."""
        return self._transition(self._stop_or_raise, ERROR)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Completes the log and frees the FMU."""
        return self._transition(self._close_landing, ERROR)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """As cleanup, from any state; the node does nothing afterwards."""
        result = self._transition(self._close_landing, ERROR)
        self.ended.set()
        return result

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """As cleanup; the node is unconfigured afterwards, with a complete log up to the error."""
        failure = self.failure
        result = self._transition(self._close_landing, FAILURE)
        self.failure = failure
        self.ended.set()
        return result

    def _transition(
        self, action: Callable[[], None], otherwise: TransitionCallbackReturn
    ) -> TransitionCallbackReturn:
        # rclpy swallows exceptions from transitions without a message.
        self.failure = None
        try:
            action()
            return SUCCESS
        except Exception as e:
            self.failure = as_landing_error(e)
        # With `autostart` the command prints the error.
        if not self.values["autostart"]:
            self.get_logger().error(str(self.failure))
        return otherwise

    def _make_landing(self) -> None:
        settings = self.values.settings()
        folder = settings.folder()
        for topic, publisher in self._publishing.publishers.items():
            publisher.every = 1 if topic in topics.OCCASIONAL else settings.every.get(topic, 1)
        self.landing = LandingRun(
            settings,
            folder=folder if folder is None or not self._landings else unused_folder(folder),
            publishing=self._publishing,
            inputs=self._inputs,
            identity=Identity(self.get_fully_qualified_name().strip("/"), self.get_namespace()),
            on_error=lambda text: self.get_logger().error(text),
        )
        self._describe(self.landing)
        warning = joint_warning([settings.parameters])
        if warning is not None:
            self.get_logger().warning(warning)

    def _describe(self, landing: LandingRun) -> None:
        """Publishes the FMU's variables and the vehicle's description."""
        fmu, publishing = landing.fmu, self._publishing
        table, interface = parameters_of(landing.settings.mode), fmu.interface
        counts = (
            f"{len(table)} parameters, {len(interface.inputs)} inputs, "
            f"{len(interface.outputs)} outputs"
        )
        listed = publishing.names[topics.VARIABLES]
        self.get_logger().info(f"{fmu.path}, version {fmu.version}: {counts}, listed on {listed}")
        landing.description = publishing.describe(landing.settings.parameters)

    def _start(self) -> None:
        landing = self._require_landing()
        self._open_log(landing)
        self.ended.clear()
        publishers = self._publishing.publishers
        self._thread = LandingThread(
            landing,
            publishers[topics.STRUTS],
            [p.publisher for p in publishers.values()],
            self._note_end,
            self._note_error,
        )
        self._thread.start()

    def _open_log(self, landing: LandingRun) -> None:
        if landing.log.recorder is None and not landing.samples:
            landing.open_log()
            self._landings += 1

    def _note_end(self) -> None:
        landing = self._require_landing()
        # With `autostart` the command prints it.
        if not self.values["autostart"]:
            recorder = landing.log.recorder
            log = f"; log: {recorder.folder}" if recorder else ""
            self.get_logger().info(f"{landing.end} after {landing.time:g} s{log}")
        self.ended.set()

    def _note_error(self, error: LandingError) -> None:
        self._landing_error = error
        # Transitions must run in the executor's thread.
        if self.executor is not None:
            self.executor.create_task(self.trigger_deactivate)

    def _stop(self) -> None:
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.stop()

    def _stop_or_raise(self) -> None:
        self._stop()
        error, self._landing_error = self._landing_error, None
        if error is not None:
            raise error

    def _close_landing(self) -> None:
        self._stop()
        landing, self.landing = self.landing, None
        if landing is not None:
            self._previous = landing
            landing.close()

    def _require_landing(self) -> LandingRun:
        if self.landing is None:
            raise LandingError("there is no landing; configure the node first")
        return self.landing

    @property
    def is_landing(self) -> bool:
        """Whether the landing's thread runs: the node is active."""
        return self._thread is not None

    def reset(self) -> str:
        """Goes back to time 0 with the current parameters and a new log.

        An active node lands again from there. Returns a text for the service's answer.

        Raises:
            LandingError: the node is not configured, or the new parameters do not fit.
        """
        self._require_landing()
        was_landing = self.is_landing
        self._close_landing()
        self._make_landing()
        if was_landing:
            self._start()
        return f"back to 0 s{', landing' if was_landing else ''}"

    def step(self) -> str:
        """Does `step_count` steps of a node that is configured and not active.

        Returns a text for the service's answer: the time reached.

        Raises:
            LandingError: the node is in another state, or the landing has ended.
        """
        landing = self._require_landing()
        if self.is_landing:
            raise LandingError("the node lands; deactivate it, then it can be stepped")
        if landing.end:
            raise LandingError(
                f"the landing has {landing.end} at {landing.time:g} s; ~/reset begins another"
            )
        self._open_log(landing)
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
        if now - self._last_warning.get(kind, -WARN_SECONDS) >= WARN_SECONDS:
            self._last_warning[kind] = now
            self.get_logger().warning(text)

    @property
    def state(self) -> str:
        """The lifecycle state: "unconfigured", "inactive", "active", "finalized" or a transition's.

        During a transition it is "configuring", "activating" and so on.
        """
        return lifecycle_state(self)

    @property
    def has_landed(self) -> bool:
        """Whether there is a landing with at least one sample."""
        landing = self.landing or self._previous
        return landing is not None and landing.samples > 0

    def summary(self, signal: int) -> RunSummary:
        """The figures of the last landing, once it has ended or is paused.

        Args:
            signal: number of the signal that interrupted it, or 0.

        Raises:
            LandingError: there was no landing.
        """
        landing = self.landing or self._previous
        if landing is None:
            raise LandingError("nothing has landed; configure and activate the node")
        publishers = self._publishing.acknowledging()
        acknowledged = wait_for_acknowledgement(publishers, interrupted=bool(signal))
        return landing.summary(landing.end or "interrupted", signal, acknowledged=acknowledged)

    def destroy_node(self) -> None:
        """Ends the landing, completes its log, frees the FMU, and destroys the node."""
        self._close_landing()
        super().destroy_node()
