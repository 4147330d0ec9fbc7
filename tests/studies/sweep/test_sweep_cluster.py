"""Sweeps on a real Dask cluster: a scheduler and two worker processes on this machine."""

from __future__ import annotations

import asyncio
import json
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from threading import Thread

import pytest
from distributed import Client, Scheduler
from study_tools import rows, run, start, wait_for, write_study


class Cluster:
    """A scheduler at `address`, and its workers' processes."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "scheduler.json"
        self.processes = [self._start("scheduler", "--port", "0", "--host", "127.0.0.1")]
        wait_for(self.processes[0], self._is_there)
        self.address: str = json.loads(self.file.read_text())["address"]
        self.workers: dict[str, subprocess.Popen[str]] = {}

    def _is_there(self) -> bool:
        return self.file.exists() and self.file.read_text().endswith("}")

    def _start(self, what: str, *options: str) -> subprocess.Popen[str]:
        command = [
            sys.executable,
            "-m",
            f"distributed.cli.dask_{what}",
            "--no-dashboard",
            "--scheduler-file",
            str(self.file),
            *options,
        ]
        return subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True
        )

    def with_workers(self, *names: str) -> Cluster:
        """Have these workers, each a process of one thread that nobody restarts."""
        for name in names:
            if name not in self.workers or self.workers[name].poll() is not None:
                self.workers[name] = self._start(
                    "worker", "--no-nanny", "--nthreads", "1", "--name", name
                )
                self.processes.append(self.workers[name])
        with Client(self.address) as client:
            client.wait_for_workers(len(names), timeout=60)
        return self

    def wait_until_working(self, count: int) -> None:
        """Until this many workers have landings to make."""

        async def working(dask_scheduler: Scheduler) -> None:
            while sum(bool(w.processing) for w in dask_scheduler.workers.values()) < count:
                await asyncio.sleep(0.01)

        with Client(self.address) as client:
            client.sync(asyncio.wait_for, client.run_on_scheduler(working, asynchronous=True), 120)

    def stop(self) -> None:
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    started = Cluster(tmp_path_factory.mktemp("cluster"))
    try:
        yield started
    finally:
        started.stop()


def test_a_scheduler_without_workers_is_said_so(cluster, tmp_path, command):
    done = command(
        "sweep", str(write_study(tmp_path)), "--scheduler", cluster.address, "--timeout", "1"
    )
    assert done.code == 2
    assert "has no worker after 1 s" in done.err
    assert len(done.err.strip().splitlines()) == 1


def test_a_cluster_that_loses_a_worker_in_mid_run_gives_the_very_rows_of_threads(
    cluster, tmp_path, command
):
    cluster.with_workers("one", "two")
    study = write_study(tmp_path, samples=100, until=0.3)
    assert command("sweep", str(study), "--results", str(tmp_path / "threads")).code == 0
    process = start(
        "sweep", study, "--results", "cluster", "--scheduler", cluster.address, cwd=tmp_path
    )
    cluster.wait_until_working(2)
    cluster.workers["one"].kill()
    assert process.poll() is None
    _, err = process.communicate(timeout=200)
    assert process.returncode == 0, err
    files = [tmp_path / folder / "results.parquet" for folder in ("threads", "cluster")]
    assert rows(files[1]) == rows(files[0])
    assert files[1].read_bytes() == files[0].read_bytes()


def test_a_scheduler_that_dies_in_mid_run_ends_the_sweep_and_threads_go_on_with_it(
    cluster, tmp_path, command
):
    cluster.with_workers("two")
    study = write_study(tmp_path, samples=100, until=0.3)
    process = start(
        "sweep",
        study,
        "--results",
        "r",
        "--scheduler",
        cluster.address,
        "--timeout",
        1,
        cwd=tmp_path,
    )
    cluster.wait_until_working(1)
    cluster.processes[0].kill()
    _, err = process.communicate(timeout=200)
    assert process.returncode == 1, err
    assert "--resume continues" in err
    assert len(err.strip().splitlines()) == 1
    done = command("sweep", str(study), "--results", str(tmp_path / "r"), "--resume")
    assert done.code == 0, done.err
    assert [row["index"] for row in rows(tmp_path / "r" / "results.parquet")] == list(range(200))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:{port}", "nonsense://x"])
def test_an_unreachable_scheduler_is_one_clear_line_within_the_timeout(tmp_path, command, address):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    results = tmp_path / "r"
    study = str(write_study(tmp_path))
    done = command(
        "sweep",
        study,
        "--results",
        str(results),
        "--scheduler",
        address.format(port=port),
        "--timeout",
        "0.5",
    )
    assert done.code == 2
    assert "no Dask scheduler answers at" in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert not results.exists()


def hear(connection: socket.socket) -> None:
    """Take what comes, and never answer."""
    while connection.recv(65536):
        pass


def as_web_server(connection: socket.socket) -> None:
    connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\nhello " * 1000)


def with_huge_length(connection: socket.socket) -> None:
    connection.sendall(struct.pack("<Q", 1 << 62))
    hear(connection)


def with_empty_messages(connection: socket.socket) -> None:
    while True:
        connection.sendall(struct.pack("<QQ", 8, 0))


def by_drops(connection: socket.socket) -> None:
    while True:
        connection.sendall(b"\0")
        time.sleep(0.1)


def hang_up(connection: socket.socket) -> None:
    pass


@pytest.mark.parametrize(
    "answer", [hear, as_web_server, with_huge_length, with_empty_messages, by_drops, hang_up]
)
def test_what_is_no_scheduler_is_one_clear_line_within_the_timeout(
    tmp_path, answer: Callable[[socket.socket], None]
):
    def serve(server: socket.socket) -> None:
        def one(connection: socket.socket) -> None:
            with connection, suppress(OSError):
                answer(connection)

        with suppress(OSError):
            while True:
                Thread(target=one, args=(server.accept()[0],), daemon=True).start()

    with socket.create_server(("127.0.0.1", 0)) as server:
        Thread(target=serve, args=(server,), daemon=True).start()
        address = "tcp://{}:{}".format(*server.getsockname())
        study = write_study(tmp_path)
        done = run("sweep", study, "--scheduler", address, "--timeout", "1", cwd=tmp_path)
    assert done.returncode == 2
    assert f"no Dask scheduler answers at {address} within 1 s (" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.parametrize("address", ["", "tcp://", "tcp://host", "tcp://h:x", "tcp://h:99999", "x"])
def test_what_is_no_address_is_said_so(tmp_path, address):
    done = run("sweep", write_study(tmp_path), "--scheduler", address, cwd=tmp_path)
    assert done.returncode == 2
    assert "it is no address; write for example tcp://host:8786" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_a_scheduler_that_stops_answering_ends_the_sweep_with_its_rows_kept(tmp_path):
    started = Cluster(tmp_path)
    try:
        started.with_workers("one")
        study = write_study(tmp_path, samples=400, until=0.3)
        options = ("--results", "r", "--scheduler", started.address, "--timeout", 2)
        process = start("sweep", study, *options, cwd=tmp_path)
        started.wait_until_working(1)
        started.processes[0].send_signal(signal.SIGSTOP)
        _, err = process.communicate(timeout=100)
        assert process.returncode == 1, err
        assert "of 800 landings are kept in r, --resume continues" in err
        assert len(err.strip().splitlines()) == 1
        done = run("sweep", study, *options, "--resume", cwd=tmp_path)
        assert done.returncode == 2
        assert f"no Dask scheduler answers at {started.address} within 2 s" in done.stderr
        assert len(done.stderr.strip().splitlines()) == 1
    finally:
        started.stop()
