"""Checks for the libraries that read logs."""

from __future__ import annotations

from rlv_landing.errors import LandingError, reason_of


def require_log_readers() -> None:
    """Checks that the libraries that read logs are installed.

    Raises:
        LandingError: one is missing; the text says what to install.
    """
    try:
        import mcap  # noqa: F401
        import mcap_ros2  # noqa: F401
        import rosbags  # noqa: F401
    except ImportError as e:
        raise LandingError(
            f"reading logs needs mcap and rosbags ({reason_of(e)}); "
            'install them with pip install "rlv-landing[mcap]"'
        ) from None
