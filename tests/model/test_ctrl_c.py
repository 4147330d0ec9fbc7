"""Ctrl-C raises KeyboardInterrupt whenever it comes: no call of a landing loses it."""

import pickle
import random
import threading

import pytest
from interrupting import raises_keyboard_interrupt

from rlv_landing import Landing

pytestmark = pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(),
    reason="signals reach the main thread",
)
CALLS = {
    "set_inputs": lambda landing: landing.set_inputs(
        {"external.force_x": random.uniform(0.0, 1e3)}, {"ground.heave_rate": 1e-3}
    ),
    "step": lambda landing: landing.step(1e-4),
    "run": lambda landing: landing.run(landing.time + 1e-3),
    "inputs": lambda landing: landing.inputs(),
    "outputs": lambda landing: landing.outputs(),
    "extremes": lambda landing: landing.extremes(),
    "restore": lambda landing: landing.restore(landing.state()),
    "pickle": lambda landing: pickle.loads(pickle.dumps(landing)),
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_at_any_moment_of_a_call_raises_keyboard_interrupt(call):
    for _ in range(40):
        landing = Landing()
        landing.set_inputs({"ground.heave": 1e-3})
        landing.step(1e-3)
        for _ in range(20):
            delay = random.uniform(1e-6, 2e-4)
            assert raises_keyboard_interrupt(lambda: CALLS[call](landing), delay)  # noqa: B023
