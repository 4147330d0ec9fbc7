"""Dense output: the last two internal steps of a system, with state and outputs inside them.

Interpolants: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.6.
"""

from __future__ import annotations

from array import array

from ..bodies.system import System
from ..memory import Buffer, Doubles, copy, data

# parts of an interpolant, each as long as the state
PARTS = 5
# [s]: after all times
NEVER = 1e99
# [s]: a system has come to rest when it has kept within a rest's bounds for so long, and stays so
# until it moves so many times as much: what vibrates or rocks passes them twice in each period
CALM = 0.02
STAYS = 4.0


class Path:
    """The last two internal steps of one `System`, with its inputs.

    The last step leads from `t_old` to `t` [s], that before it from `t_before` to `t_old`. `dense`
    [2 x 5 n] holds their interpolants, the last step's from `dense_at` on. `u` [inputs] holds the
    inputs at `t_input`, which change from there at the rates `u_rate` [inputs].

    The system is calm since `calm_since` [s], has come to rest at `rest_since` [s] and moves again
    from `rest_until` [s] on. These are ends of internal steps, where it is judged: what is told of
    it does not depend on when the outputs are read.
    """

    system: System
    n: int
    t: float
    t_old: float
    t_before: float
    t_input: float
    calm_since: float
    rest_since: float
    rest_until: float
    dense_at: int
    dense: Buffer
    u: Buffer
    u_rate: Buffer
    u_now: Buffer

    def __init__(self, system: System) -> None:
        self.system = system
        self.n = system.n
        self.t = 0.0
        self.t_old = 0.0
        self.t_before = 0.0
        self.t_input = 0.0
        self.calm_since = NEVER
        self.rest_since = NEVER
        self.rest_until = NEVER
        self.dense_at = 0
        self.dense = array("d", bytes(8 * 2 * PARTS * system.n))
        self.u = array("d", bytes(8 * system.inputs))
        self.u_rate = array("d", bytes(8 * system.inputs))
        self.u_now = array("d", bytes(8 * system.inputs))

    def inputs_at(self, t: float) -> None:
        """Write the inputs at time `t` [s] to `u_now`, without what they are by themselves."""
        self.system.inputs_after(
            data(self.u), data(self.u_rate), t - self.t_input, data(self.u_now)
        )

    def _inputs_at(self, t: float) -> None:
        """Write the inputs that act at time `t` [s] to `u_now`."""
        self.system.inputs_after(
            data(self.u), data(self.u_rate), t - self.t_input, data(self.u_now)
        )
        if self.system.at_sea:
            self.system.add_sea(t, data(self.u_now))

    def interpolate(self, t: float, y: Buffer) -> None:
        """Write the state at time `t` [s], inside the last internal step, to `y` [n]."""
        self._interpolate(t, data(y))

    def _interpolate(self, t: float, y: Doubles) -> None:
        self._inside(self.dense_at, t, self.t_old, self.t, y)

    def _interpolate_back(self, t: float, y: Doubles) -> None:
        """Write the state at time `t` [s], inside one of the last two internal steps."""
        if t < self.t_old:
            self._inside(self._other_dense(), t, self.t_before, self.t_old, y)
        else:
            self._interpolate(t, y)

    def _inside(self, at: int, t: float, start: float, end: float, y: Doubles) -> None:
        """Write the state at time `t` [s] of the step from `start` to `end` to `y`.

        Its interpolant begins at `at`.
        """
        n = self.n
        d = data(self.dense)
        span = end - start
        a = (t - start) / span if span > 0.0 else 0.0
        b = 1.0 - a
        for i in range(n):
            j = at + i
            y[i] = d[j] + a * (
                d[n + j] + b * (d[2 * n + j] + a * (d[3 * n + j] + b * d[4 * n + j]))
            )

    def _other_dense(self) -> int:
        """The place in `dense` of the interpolant of the step before the last."""
        return PARTS * self.n - self.dense_at

    def _stand_still(self, y: Doubles) -> None:
        """Make the interpolant the constant state `y`: no step was taken yet since time `t`."""
        self.dense_at = 0
        d = data(self.dense)
        for i in range(2 * PARTS * self.n):
            d[i] = 0.0
        copy(y, d, self.n)

    def outputs_at(self, t: float, y: Buffer, out: Buffer) -> None:
        """Write the outputs at time `t` [s] and state `y` [n] to `out` [row]."""
        self._outputs_at(t, data(y), data(out), 0)

    def _outputs_at(self, t: float, y: Doubles, out: Doubles, at: int) -> None:
        self._inputs_at(t)
        self.system.outputs(y, data(self.u_now), out, at)
        if self._rested(t):
            self.system.tell_rest(out, at)

    def _rested(self, t: float) -> bool:
        """Whether the system has come to rest by the time `t` [s] of the last step."""
        return self.rest_since <= t < self.rest_until

    def _judge_rest(self, outputs: Doubles) -> None:
        """Judge by the `outputs` at the time `t` whether the system rests, and write it to them."""
        self._forget_after(self.t)
        if self._rested(self.t):
            if not self.system.rests(outputs, STAYS):
                self.rest_until = self.t
                self.calm_since = NEVER
        elif not self.system.rests(outputs, 1.0):
            self.calm_since = NEVER
        else:
            self.calm_since = min(self.calm_since, self.t)
            if self.t >= self.calm_since + CALM:
                self._rest_from(self.t)
        if self._rested(self.t):
            self.system.tell_rest(outputs, 0)

    def _rest_from(self, t: float) -> None:
        """Note that the system has come to rest at time `t` [s], if it has not before."""
        if not self._rested(t):
            self.rest_since = t
            self.rest_until = NEVER

    def _forget_after(self, t: float) -> None:
        """Forget what was judged after time `t` [s], at which the path has ended."""
        if self.calm_since > t:
            self.calm_since = NEVER
        if self.rest_since > t:
            self.rest_since = NEVER
        if self.rest_until > t:
            self.rest_until = NEVER
