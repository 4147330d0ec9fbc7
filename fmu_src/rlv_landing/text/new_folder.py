"""Folders that are filled whole or not at all."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import LandingError
from .durable import unwritable

REMEDY = "name a new folder"


@contextmanager
def new_folder(folder: Path) -> Iterator[None]:
    """Make a folder, or take one that is empty, for the body to fill.

    Where the body or the disk fails, or the user ends it, the folder is as it was.

    Raises:
        LandingError: It is neither new nor empty, or the disk refuses.
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if any(folder.iterdir()):
            raise LandingError(f"{folder} is there and is not empty; {REMEDY}")
    except (FileExistsError, NotADirectoryError):
        raise LandingError(f"{folder} is a file; {REMEDY}") from None
    except OSError as e:
        raise unwritable(folder, e, REMEDY) from None
    try:
        yield
    except BaseException as e:
        _empty(folder)
        for path in missing:
            with suppress(OSError):
                path.rmdir()
        if isinstance(e, OSError):
            raise unwritable(folder, e, REMEDY) from None
        raise


def _empty(folder: Path) -> None:
    for path in folder.iterdir():
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
