"""Records of the solvers: stiff pairs of states, their weights, and samples near an extreme."""

from typing import NamedTuple


class StiffPair(NamedTuple):
    """Two states `i`, `j` whose difference x = y_j - y_i decays.

    A change of x changes y_i' by a1 x and y_j' by -a2 x.
    """

    i: int
    j: int
    a1: float  # [1/s]
    a2: float  # [1/s]


class PhiWeights(NamedTuple):
    """Weights of one stiff pair's rates in an exponential step.

    They weigh the rates at the step's start, at the stage before, or at the stages 2 to 4.
    """

    a21: float
    a31: float
    a32: float
    a41: float
    a43: float
    b1: float
    b23: float
    b4: float


class Bend(NamedTuple):
    """Three successive samples of a quantity, between which its maximum is searched."""

    t0: float  # [s]
    v0: float
    t1: float  # [s]
    v1: float
    t2: float  # [s]
    v2: float


class Crest(NamedTuple):
    """Time and value of the maximum of the parabola through a `Bend`."""

    t: float  # [s]
    value: float
