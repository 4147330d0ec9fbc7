"""Packages that the studies need beyond the package's own dependencies: the extra `studies`."""

from __future__ import annotations

from typing import Any

from ...errors import LandingError, reason_of

INSTALL = 'install it with pip install "rlv-landing[studies]"'


def arrow() -> tuple[Any, Any]:
    """The modules pyarrow and pyarrow.parquet.

    Raises:
        LandingError: pyarrow is missing; the message names the extra to install.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as e:
        raise LandingError(
            f"studies keep their rows as Parquet, which needs pyarrow ({reason_of(e)}); {INSTALL}"
        ) from None
    return pyarrow, parquet


def dask() -> Any:
    """The module dask.distributed.

    Raises:
        LandingError: It is missing; the message names the extra to install.
    """
    try:
        import distributed
    except ImportError as e:
        raise LandingError(
            f"--scheduler needs dask and distributed ({reason_of(e)}); {INSTALL}"
        ) from None
    return distributed
