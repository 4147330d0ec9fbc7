"""What the studies need beyond the package's own dependencies: the extra `studies`."""

from __future__ import annotations

from typing import Any

from ...errors import LandingError

INSTALL = 'install it with pip install "rlv-landing[studies]"'


def arrow() -> tuple[Any, Any]:
    """pyarrow and pyarrow.parquet.

    Raises LandingError, with the extra to install, where it is missing.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as e:
        raise LandingError(
            f"studies keep their rows as Parquet, which needs pyarrow ({e}); {INSTALL}"
        ) from None
    return pyarrow, parquet


def dask() -> Any:
    """dask.distributed. Raises LandingError, with the extra to install, where it is missing."""
    try:
        import distributed
    except ImportError as e:
        raise LandingError(f"--scheduler needs dask and distributed ({e}); {INSTALL}") from None
    return distributed
