"""Whether a Dask scheduler is at an address, asked before any of Dask's own clients is made.

Dask's client leaves threads and tracebacks where what answers is no scheduler, and may wait for
ever.
"""

from __future__ import annotations

import asyncio
import logging
import re
from threading import Thread
from typing import Any

from ...errors import LandingError, reason_of
from .extras import dask

# a port, and before it a host or nothing but a scheme
ADDRESS = re.compile(r"([a-z]+://)?(\[[0-9a-fA-F:.%\w]+\]|[\w.-]+):[0-9]{1,5}")


def disable_dask_logs() -> None:
    """Have Dask log nothing: the caller reports an error of the cluster once, in one line."""
    for name in ("distributed", "tornado", "asyncio"):
        for own in [
            name,
            *(n for n in logging.root.manager.loggerDict if n.startswith(f"{name}.")),
        ]:
            logging.getLogger(own).setLevel(logging.CRITICAL + 1)


def no_scheduler(address: str, timeout: float, error: BaseException | str) -> LandingError:
    """The error where no scheduler answers."""
    reason = error if isinstance(error, str) else _reason(error)
    return LandingError(
        f"no Dask scheduler answers at {address} within {timeout:g} s ({reason}); "
        "start one with `dask scheduler`, and check host and port"
    )


def _reason(error: BaseException) -> str:
    if isinstance(error, (TimeoutError, asyncio.TimeoutError)):
        return "what is there does not answer, or nothing is"
    text = reason_of(error)
    # what is sent there is no message of Dask's, and read as one it means anything
    known = isinstance(error, (OSError, ImportError, ValueError))
    return text if known else f"what answers is no scheduler: {type(error).__name__}"


def ask_scheduler(address: str, timeout: float) -> None:
    """Ask what is at the address who it is.

    Args:
        address: The scheduler's address.
        timeout: The longest wait for its answer [s].

    Raises:
        LandingError: It is no address, or nothing answers as a Dask scheduler does.
    """
    distributed = dask()
    try:
        scheme, _ = distributed.comm.parse_address(address)
        distributed.comm.registry.get_backend(scheme)
    except (ValueError, ImportError, RuntimeError) as e:
        raise no_scheduler(address, timeout, e) from None
    if not ADDRESS.fullmatch(address) or int(address.rpartition(":")[2]) > 65535:
        raise no_scheduler(address, timeout, "it is no address; write for example tcp://host:8786")
    found: list[Any] = []

    def ask() -> None:
        try:
            found.append(asyncio.run(_identity(address, timeout)))
        except BaseException as e:
            found.append(e)

    # in a thread that may be left behind: a look-up of a host cannot be cancelled
    thread = Thread(target=ask, daemon=True)
    thread.start()
    thread.join(timeout + 0.5)
    answer = found[0] if found else TimeoutError()
    if isinstance(answer, BaseException):
        raise no_scheduler(address, timeout, answer)
    if not isinstance(answer, dict) or answer.get("type") != "Scheduler":
        raise no_scheduler(address, timeout, "what answers is no scheduler")


async def _identity(address: str, timeout: float) -> Any:
    distributed = dask()

    async def ask() -> Any:
        comm = await distributed.core.connect(address, timeout=timeout)
        try:
            return await distributed.core.send_recv(comm, op="identity", reply=True)
        finally:
            comm.abort()

    return await asyncio.wait_for(ask(), timeout)
