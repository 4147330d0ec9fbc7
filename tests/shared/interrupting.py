"""Ctrl-C for tests."""

import gc
import signal
import time

import pytest


def interrupted_after(seconds, work):
    """Call `work` with Ctrl-C pressed after some processor time, and again until it is raised.

    On a busy machine time passes while `work` has not begun; processor time does not.
    """
    usual = signal.signal(signal.SIGVTALRM, lambda *_: signal.default_int_handler(2, None))
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds, 0.05)
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, usual)


def raises_keyboard_interrupt(work, delay):
    """Whether Ctrl-C, `delay` [s] after the start of `work` or at its end, reaches the caller.

    It does not if something between `work` and the caller drops the exception. The test tools'
    own callbacks of the garbage collector do, so it waits meanwhile.
    """
    pressed = []

    def press(*_):
        pressed.append(True)
        signal.default_int_handler(2, None)

    usual = signal.signal(signal.SIGALRM, press)
    gc.disable()
    try:
        signal.setitimer(signal.ITIMER_REAL, delay)
        work()
        while not pressed:
            time.sleep(1e-3)
    except KeyboardInterrupt:
        return True
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, usual)
        gc.enable()
    return False
