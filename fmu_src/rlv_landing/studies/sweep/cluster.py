"""A study's landings on a Dask cluster: small tasks of some landings each; a worker that dies costs
the tasks that it held, made anew.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ... import __version__
from ...errors import LandingError
from .extras import dask
from .row import Plan, run_rows
from .sweep import Engine, LostError, Rows

# landings a task: some tenths of a second, beside a scheduler's millisecond
CLUSTER_ROWS = 25
# how often a wait looks whether the cluster is still there [s]
LOOK = 1.0


def worker_version() -> str:
    """In a worker: its version of rlv-landing."""
    return __version__


class Cluster:
    """Landings on a cluster's workers."""

    rows = CLUSTER_ROWS

    def __init__(self, plan: Plan, client: Any, address: str, timeout: float) -> None:
        self._plan = plan
        self._client = client
        self._address = address
        self._timeout = timeout
        self._looked = -LOOK
        self._found = 0

    def submit(self, rows: Sequence[dict[str, Any]]) -> Any:
        """Have these landings made. Raises LostError where the scheduler is gone."""
        try:
            return self._client.submit(run_rows, self._plan, list(rows), pure=False)
        except Exception as e:
            raise self._gave_up(e) from None

    def _gave_up(self, error: BaseException) -> LostError:
        return LostError(
            f"the cluster at {self._address} gave up: {type(error).__name__}: {' '.join(str(error).split())}"
        )

    def result(self, task: Any) -> Rows:
        """Wait for a task's rows.

        Raises LostError where the scheduler is gone, or every worker for longer than the timeout.
        """
        distributed = dask()
        alone_since: float | None = None
        while True:
            try:
                rows: Rows = task.result(timeout=LOOK)
                return rows
            except (TimeoutError, distributed.TimeoutError):
                if self._client.status != "running":
                    raise LostError(f"the scheduler at {self._address} is gone") from None
                if self._threads():
                    alone_since = None
                elif alone_since is None:
                    alone_since = time.monotonic()
                elif time.monotonic() - alone_since > self._timeout:
                    raise LostError(
                        f"the scheduler at {self._address} has had no worker for {self._timeout:g} s"
                    ) from None
            except KeyboardInterrupt:
                raise
            except BaseException as e:
                raise self._gave_up(e) from None

    def room(self) -> int:
        """Enough that no worker runs dry, however many there are now."""
        return 4 * self._threads() + 8

    def _threads(self) -> int:
        """How many threads the workers have, as of a second ago at most: asking the scheduler costs
        as much as a task.
        """
        if time.monotonic() - self._looked >= LOOK:
            workers: dict[str, dict[str, Any]] = self._client.scheduler_info().get("workers", {})
            self._found = sum(int(worker["nthreads"]) for worker in workers.values())
            self._looked = time.monotonic()
        return self._found

    def stop(self, tasks: Sequence[Any]) -> list[Rows]:
        """What is there already; the rest is cancelled."""
        whole: list[Rows] = []
        for task in tasks:
            if task.status != "finished":
                break
            whole.append(task.result(timeout=self._timeout))
        self._client.cancel(list(tasks))
        return whole


@contextmanager
def cluster(plan: Plan, address: str, timeout: float) -> Iterator[Engine]:
    """The engine of the cluster whose scheduler is at `address`.

    Raises LandingError: no scheduler answers, or no worker is there, within `timeout` [s]; a worker
    lacks rlv-landing or has another version of it.
    """
    distributed = dask()
    # what goes wrong is told by our own errors, in a line
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        distributed.comm.registry.get_backend(distributed.comm.parse_address(address)[0])
        client = distributed.Client(address, timeout=timeout, set_as_default=False)
    except (OSError, ValueError, TimeoutError, distributed.TimeoutError) as e:
        raise LandingError(
            f"no Dask scheduler answers at {address} within {timeout:g} s ({e}); start one with `dask scheduler`, and check host and port"
        ) from None
    try:
        try:
            client.wait_for_workers(1, timeout=timeout)
        except (TimeoutError, distributed.TimeoutError):
            raise LandingError(
                f"the scheduler at {address} has no worker after {timeout:g} s; start some: dask worker {address}"
            ) from None
        _check_versions(client)
        yield Cluster(plan, client, address, timeout)
    finally:
        client.close(timeout=timeout)


def _check_versions(client: Any) -> None:
    try:
        found = client.run(worker_version)
    except Exception as e:
        raise LandingError(
            f"a worker cannot run rlv-landing ({type(e).__name__}: {e}); install it in the workers' Python"
        ) from None
    for worker, version in found.items():
        if version != __version__:
            raise LandingError(
                f"worker {worker} has rlv-landing {version}, here is {__version__}; rows would differ: install the same"
            )
