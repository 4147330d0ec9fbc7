"""Ctrl-C for tests."""

import signal

import pytest


def interrupted_after(seconds, work):
    """Call `work` with Ctrl-C pressed after some processor time, and again until it is felt.

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
