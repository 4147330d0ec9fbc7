"""Ctrl-C for tests."""

import signal

import pytest


def interrupted_after(seconds, work):
    """Call `work` with Ctrl-C pressed after some time, again and again until it is felt."""
    usual = signal.signal(signal.SIGALRM, lambda *_: signal.default_int_handler(2, None))
    signal.setitimer(signal.ITIMER_REAL, seconds, 0.05)
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, usual)
