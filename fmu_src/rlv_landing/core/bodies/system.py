"""The system that a solver integrates."""

from __future__ import annotations

from array import array
from math import inf

from ..memory import Buffer, Doubles, data
from ..records import StiffPair


class System:
    """An initial value problem y' = f(y, u(t)), with what a solver needs of it.

    Bodies are subclasses.

    Attributes:
        n: Length of the state.
        controlled: How many states count in a step's error; they come first, the others are carried
            along.
        counted: Of how many of these a step's error is the mean; those beyond add to it, so that
            states that do not move do not loosen it.
        scale, relative: [n] A step's error in state i is measured by rtol times scale_i, or by rtol
            times (scale_i + |y_i|) where relative_i is 1.
        inputs: How many inputs there are.
        row: How many outputs there are.
        stiff_pairs: How many pairs of states `stiff` tells of.
        rising: How many of the states that are carried along never fall; they come first of those.
        at_sea: Whether the inputs change by themselves, too: see `add_sea`.
        unsought: The output whose extremes are those at steps' ends, as it is the integration's own
            error; -1 where all are sought inside steps, too.
    """

    n: int
    controlled: int
    counted: int
    inputs: int
    row: int
    stiff_pairs: int
    rising: int
    at_sea: bool
    unsought: int
    scale: Buffer
    relative: Buffer
    _rates: Buffer

    def __init__(
        self, scale: Buffer, relative: Buffer, carried: int, inputs: int, row: int, stiff_pairs: int
    ) -> None:
        self.n = len(scale)
        self.controlled = self.n - carried
        self.counted = self.controlled
        self.inputs = inputs
        self.row = row
        self.stiff_pairs = stiff_pairs
        self.rising = 0
        self.at_sea = False
        self.unsought = -1
        self.scale = scale
        self.relative = relative
        self._rates = array("d", bytes(8 * self.n))

    def inputs_after(self, u: Doubles, rates: Doubles, dt: float, now: Doubles) -> None:
        """Write to `now` the inputs `dt` [s] after they were `u`, at their `rates` [unit/s]."""

    def add_sea(self, t: float, now: Doubles) -> None:
        """Add to the inputs `now` what they are by themselves at time `t` [s]."""

    def rhs(self, y: Doubles, u: Doubles, dy: Doubles) -> None:
        """Write dy/dt at the state `y` and the inputs `u` to `dy`."""

    def stiff(self, k: int) -> StiffPair:
        """The `k`-th pair of states whose difference decays fast.

        Its rates are those where `rhs` was called last.
        """
        return StiffPair(0, 0, 0.0, 0.0)

    def normalise(self, y: Doubles) -> None:
        """Bring the state at the end of a step to its normal form, which changes no motion.

        It is called before the rates there are: a state that is saved and restored gives the same.
        """

    def project(self, y: Doubles) -> None:
        """Bring the state at the end of a step back to where it may be."""

    def weigh(self, ceiling: Doubles) -> None:
        """Write to `ceiling` [n] how large the error of a state may be at any tolerance.

        It holds where `rhs` was called last, and only for states whose `relative` is 1.
        """

    def conserve(self, y: Doubles) -> float:
        """Bring a state at which `rhs` was called last back to what the system conserves.

        Returns how far it was away, in units of what a step may be; 0 where it was left as it is.
        """
        return 0.0

    def is_off_ground(self, outputs: Doubles) -> bool:
        """Whether the system has left what is known of its ground, where it read `outputs` last."""
        return False

    def note(self, outputs: Doubles) -> None:
        """Take notice of the `outputs` at the end of a step."""

    def lost(self, before: Doubles, after: Doubles, h: float) -> float:
        """The loss, in a step of `h` [s], of what the system conserves.

        It is found from the outputs `before` and `after` the step, in units of what it may lose.
        """
        return 0.0

    def outputs(self, y: Doubles, u: Doubles, out: Doubles, at: int) -> None:
        """Write the outputs at the state `y` and the inputs `u` to `out[at:]`.

        It brings `y` back to what the system conserves.
        """
        rates = data(self._rates)
        self.rhs(y, u, rates)
        if self.conserve(y) > 0.0:
            self.rhs(y, u, rates)
        self.read(y, u, rates, out, at)

    def follow_ground(self, t: float, y: Doubles, dy: Doubles, u: Doubles, rates: Doubles) -> None:
        """Keep how the system moves relative to its ground, for `is_slow` and `rests`.

        Args:
            t: Time [s] of an end of a step, where `rhs` was called last.
            y: The state there.
            dy: Its rate.
            u: The inputs there.
            rates: The rates that were given for them.
        """

    def is_slow(self, outputs: Doubles, most: float) -> bool:
        """Whether the system is so slow with these `outputs` that it may be near a rest.

        It may have so many times the kinetic energy, at `most`.
        """
        return False

    def may_rest(self, u: Doubles, rates: Doubles, outputs: Doubles) -> bool:
        """Whether the system may be near a rest with these `outputs` at constant inputs.

        Args:
            u: The inputs.
            rates: Their rates.
            outputs: The outputs at the state.
        """
        return False

    def rests(self, outputs: Doubles, most: float) -> bool:
        """Whether these `outputs` are those of a system at rest.

        It may move by so many times as much, at `most`, as what counts as rest.
        """
        return False

    def tell_rest(self, outputs: Doubles, at: int) -> None:
        """Write to `outputs[at:]` that the system has come to rest."""

    def distance(self, shift: Doubles) -> float:
        """The farthest way [m] of all that a `shift` of the state moves."""
        return inf

    def read(self, y: Doubles, u: Doubles, dy: Doubles, out: Doubles, at: int) -> None:
        """Write the outputs to `out[at:]` at the state `y` and the inputs `u`.

        `rhs` was called last there, and gave the rates `dy`.
        """
