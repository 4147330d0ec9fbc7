"""Commands in processes of their own that have Python and its packages loaded already.

A server without threads has imported what the commands import, and each command is a fork of it. So
a command costs what it does, and not half a second or more of imports. Where the start itself is
looked at (signals, imports, encodings), tests start Python anew.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

PACKAGES = (
    "rlv_landing.cli.group",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.stats",
    "matplotlib.backends.backend_agg",
    "matplotlib.figure",
    "fmpy",
    "mcap.reader",
    "rclpy.node",
)


def _as_a_program(
    program: str,
    arguments: tuple[str, ...],
    cwd: str,
    environment: Mapping[str, str],
    files: tuple[str, str],
    largest: int | None,
) -> None:
    """Run the command in this process, which ends with it as a new Python does."""
    if largest is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
    for file, descriptor in zip((os.devnull, *files), (0, 1, 2), strict=True):
        opened = os.open(file, os.O_RDWR if descriptor else os.O_RDONLY)
        os.dup2(opened, descriptor)
        os.close(opened)
    sys.stdout = os.fdopen(1, "w", closefd=False)
    sys.stderr = os.fdopen(2, "w", closefd=False, buffering=1, errors="backslashreplace")
    os.chdir(cwd)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = [program, *arguments]
    code: object = 0
    try:
        if program == "rlv-landing":
            from rlv_landing.cli import main

            main()
        else:
            from rlv_ros_bridge.__main__ import run

            code = run()
    except SystemExit as ended:
        code = ended.code
    except BaseException:
        sys.excepthook(*sys.exc_info())  # type: ignore[arg-type]
        code = 1
    atexit._run_exitfuncs()
    try:
        sys.stdout.flush()
    except OSError:
        code = code or 120
    os._exit(code if isinstance(code, int) else int(code is not None))


def run_forked(
    *arguments: object,
    program: str = "rlv-landing",
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
    output: Path | None = None,
    largest: int | None = None,
    timeout: float = 300.0,
) -> subprocess.CompletedProcess[str]:
    """Run `rlv-landing`, or another name for the bridge's commands alone, to its end.

    Args:
        arguments: of the command line.
        program: `rlv-landing`, or `rlv_ros_bridge` for `python -m rlv_ros_bridge`.
        cwd: the folder it runs in; this process's, if not given.
        environment: all of its environment; this process's, if not given.
        output: where standard output goes; it is returned if not given.
        largest: the largest file that it may write [bytes].
        timeout: after which it is killed and the test fails [s].

    Raises:
        subprocess.TimeoutExpired: the time is over.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(PACKAGES))
    words = tuple(map(str, arguments))
    with tempfile.TemporaryDirectory(prefix="forked_") as folder:
        out, err = Path(folder) / "out", Path(folder) / "err"
        for file in (out, err):
            file.touch()
        process = context.Process(
            target=_as_a_program,
            args=(
                program,
                words,
                str(cwd or Path.cwd()),
                dict(os.environ if environment is None else environment),
                (str(output or out), str(err)),
                largest,
            ),
        )
        process.start()
        try:
            process.join(timeout)
            if process.exitcode is None:
                raise subprocess.TimeoutExpired([program, *words], timeout, out.read_bytes())
        finally:
            process.kill()
            process.join()
            code = process.exitcode
            process.close()
        return subprocess.CompletedProcess(
            [program, *words], code, out.read_text(), err.read_text()
        )
