"""The platforms that an FMU can have binaries for: how they are named, compiled for, and tried."""

from __future__ import annotations

import platform
from dataclasses import dataclass

# what a build may be asked for: this machine's platform, or all
OWN, ALL = "own", "all"
GLIBC, MACOS = "2.17", "11.0"
NOT_RUN = "built, not run"


@dataclass(frozen=True)
class Target:
    """A platform.

    Attributes:
        name: FMI 3.0's name: architecture and system.
        triple: Zig's name.
        library: Ending of a shared library.
        core: File name of the compiled core, an extension module of Python's limited API.
        flags: What the compiler needs for every library.
        long_size: Size of C's long [byte].
        wchar_size: Size of C's wchar_t [byte].
        tried: How its binaries were tried.
    """

    name: str
    triple: str
    library: str
    core: str
    flags: tuple[str, ...]
    long_size: int
    wchar_size: int
    tried: str

    @property
    def system(self) -> str:
        """The operating system: linux, windows or darwin."""
        return self.name.split("-")[1]


# on Windows no DLL of mingw is needed, and printf is C11's
_WINDOWS_FLAGS = ("-D__USE_MINGW_ANSI_STDIO=1",)
_TARGETS = (
    Target(
        "x86_64-linux",
        f"x86_64-linux-gnu.{GLIBC}",
        ".so",
        "compiled.abi3.so",
        ("-fPIC",),
        8,
        4,
        "run",
    ),
    Target(
        "aarch64-linux",
        f"aarch64-linux-gnu.{GLIBC}",
        ".so",
        "compiled.abi3.so",
        ("-fPIC",),
        8,
        4,
        "run in an emulator (qemu)",
    ),
    Target(
        "x86_64-windows",
        "x86_64-windows-gnu",
        ".dll",
        "compiled.pyd",
        _WINDOWS_FLAGS,
        4,
        2,
        NOT_RUN,
    ),
    *(
        Target(
            f"{architecture}-darwin",
            f"{architecture}-macos.{MACOS}",
            ".dylib",
            "compiled.abi3.so",
            ("-fPIC",),
            8,
            4,
            NOT_RUN,
        )
        for architecture in ("x86_64", "aarch64")
    ),
)
TARGETS = {target.name: target for target in _TARGETS}
# FMI 2.0's names; it lets others be added. A binary for macOS has both architectures
FMI2 = {
    "linux64": ("x86_64-linux",),
    "win64": ("x86_64-windows",),
    "darwin64": ("x86_64-darwin", "aarch64-darwin"),
    "aarch64-linux": ("aarch64-linux",),
}


def of_platform(folder: str) -> tuple[Target, ...]:
    """The targets whose binaries stand in a folder of `binaries`, by FMI 2.0's or 3.0's name."""
    return tuple(TARGETS[name] for name in FMI2.get(folder, (folder,)) if name in TARGETS)


def own_machine() -> str:
    """FMI 3.0's name of this machine's Linux."""
    machine = platform.machine().lower()
    return f"{'aarch64' if machine == 'arm64' else machine}-linux"


def own_platform(fmi: str = "2") -> str:
    """The folder where hosts on this machine look for the binary, by a version of FMI."""
    return "linux64" if fmi == "2" else own_machine()


def tried(folder: str) -> str:
    """How the binary in a folder of `binaries` was tried."""
    return ", ".join(dict.fromkeys(target.tried for target in of_platform(folder))) or "run"
