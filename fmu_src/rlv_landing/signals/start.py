"""What a command does first; this module imports next to nothing."""

import signal
from contextlib import suppress


def end_at_once() -> None:
    """Let SIGINT end the process as the system does, until another handler is set.

    Python's own handler raises KeyboardInterrupt in the midst of imports, which is lost there or
    shows a traceback. A shell reports an end by SIGINT as 130. Outside the main thread, in which
    alone Python sets handlers, the host's stays.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        with suppress(ValueError):
            signal.signal(signal.SIGINT, signal.SIG_DFL)
