"""Chooses the C compilers of front and compiled core.

The release build uses Zig's, from the PyPI package `ziglang`: its libraries need glibc 2.17 or
newer, whatever this machine has, and it compiles for other platforms too. Where it is not
installed, gcc compiles for this machine and mingw-w64, if it is there, the front for Windows. CC in
the environment names another compiler for this machine.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from .targets import TARGETS, Target, own_machine

ZIG = (sys.executable, "-m", "ziglang")
MINGW = "x86_64-w64-mingw32-gcc"
# undefined behaviour is tested for, and not checked in what users run
ZIG_FLAGS = ("-fno-sanitize=undefined",)
# the same bytes at any time and in any folder
MINGW_FLAGS = ("-static", "-Wl,--no-insert-timestamp,--disable-auto-image-base")


@dataclass(frozen=True)
class Compiler:
    """A C compiler with the options that every library needs."""

    command: tuple[str, ...]
    flags: tuple[str, ...] = ()

    @property
    def is_zig(self) -> bool:
        """Whether it is Zig's."""
        return "ziglang" in self.command

    @property
    def name(self) -> str:
        """Program and version in one line, as the build prints it."""
        if self.is_zig:
            return f"zig {_first_line((*ZIG, 'version'))}"
        return _first_line((*self.command, "--version"))


def run(command: Sequence[str], folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a compiler, in `folder` if one is given.

    Raises:
        SystemExit: There is no such program.
    """
    try:
        return subprocess.run(
            command, capture_output=True, text=True, check=False, env=environment(), cwd=folder
        )
    except OSError as e:
        raise SystemExit(
            f"error: there is no C compiler {command[0]} for the FMU's front "
            f"({e.strerror or e}); pip install ziglang, or name one by CC"
        ) from None


@cache
def _first_line(command: tuple[str, ...]) -> str:
    done = run(command)
    return (done.stdout.splitlines() or [f"{command[0]} of unknown version"])[0]


def has_zig() -> bool:
    """Whether Zig's compiler is installed in this Python."""
    return find_spec("ziglang") is not None


def for_linux() -> Compiler:
    """The compiler for this machine's Linux.

    Raises:
        SystemExit: CC is no command.
    """
    named = os.environ.get("CC", "").strip()
    if named:
        return Compiler(_words(named))
    own = TARGETS.get(own_machine())
    if has_zig() and own:
        return _zig(own)
    return Compiler(("gcc",))


def _words(command: str) -> tuple[str, ...]:
    try:
        return tuple(shlex.split(command))
    except ValueError as e:
        raise SystemExit(
            f"error: CC = {command!r} is no command ({e}); name a C compiler by CC, or unset it"
        ) from None


def for_target(target: Target) -> Compiler | None:
    """The compiler for a platform; None if there is none."""
    if target.name == own_machine():
        return for_linux()
    if has_zig():
        return _zig(target)
    if target.system == "windows" and shutil.which(MINGW):
        return Compiler((MINGW,), (*target.flags, *MINGW_FLAGS))
    return None


def _zig(target: Target) -> Compiler:
    return Compiler((*ZIG, "cc", "-target", target.triple), (*ZIG_FLAGS, *target.flags))


def environment() -> dict[str, str]:
    """The environment for a compiler.

    Zig keeps what it has compiled of the C library in the user's cache, which it cannot find where
    HOME is not set.
    """
    if {"HOME", "ZIG_GLOBAL_CACHE_DIR"} & os.environ.keys():
        return dict(os.environ)
    return {**os.environ, "ZIG_GLOBAL_CACHE_DIR": str(Path.home() / ".cache" / "zig")}
