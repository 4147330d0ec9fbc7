"""The length of the next step, by a PI controller.

Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.4.
"""

from __future__ import annotations

from math import pow

# [s]: the shortest step must be able to pass a jump of the friction force at the tightest tolerance
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-5, 2e-3, 1e-16
# part of the step that the error would allow, and how much shorter and longer the next step is at
# most
SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
# weight of the error of the step before (the controller's proportional part): lengths vary less
BETA = 0.04
# errors, in units of the tolerance, are taken as no smaller: that of this step, and that of the
# step before, which starts as this
LEAST_ERROR, LEAST_PREVIOUS_ERROR = 1e-10, 1e-4
# an error so large that the formula does not apply: the next step is as much shorter as it may be
HOPELESS_ERROR = 1e10


def step_factor(error: float, previous: float, exponent: float) -> float:
    """The next step's length, in parts of the length of a step with this `error`.

    Errors are in units of the tolerance: a step with an error above 1 is taken again, shorter.
    `previous` is the error of the step before, `exponent` is the method's.
    """
    if error <= 1.0:
        factor = SAFETY * pow(previous, BETA) / pow(max(error, LEAST_ERROR), exponent)
        return min(max(factor, SHRINK), GROW)
    if error < HOPELESS_ERROR:
        return max(SAFETY / pow(error, exponent), SHRINK)
    return SHRINK
