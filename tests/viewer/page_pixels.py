"""The browser, pixels of a viewer's page, and a proxy in the place of all other machines."""

from __future__ import annotations

import io
import os
import socket
import subprocess
import threading
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Page

CHROMIUM = Path(
    os.environ.get(
        "RLV_CHROMIUM", Path(__file__).resolve().parent.parent.parent / "build" / "chromium"
    )
)
# No graphics card, no sandbox of its own (CI is root), and nothing that Chromium does by itself in
# the background.
SWITCHES = (
    "--no-sandbox", "--no-zygote", "--disable-dev-shm-usage", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--no-first-run",
)  # fmt: skip
WIDTH, HEIGHT = 640, 460
# Rerun's own bars above and below the views, and the titles of the views.
TOP, BOTTOM, TITLE = 36, 28, 29
PLOTS = 5
Pixels = NDArray[np.int16]
# The command `view`, the printed address, and its port.
Started = tuple["subprocess.Popen[str]", str, int]


def screenshot(page: Page) -> Pixels:
    """The page as (rows, columns, red green blue)."""
    data = page.screenshot(timeout=300_000)
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(np.int16)


def vehicle_of(pixels: Pixels) -> Pixels:
    """The view of the vehicle."""
    return pixels[TOP + TITLE : HEIGHT - BOTTOM, : WIDTH // 2 - 2]


def plot_of(pixels: Pixels, number: int) -> Pixels:
    """The `number`-th plot, 0 at the top, without its title."""
    height = (HEIGHT - TOP - BOTTOM) / PLOTS
    return pixels[
        round(TOP + number * height) + TITLE : round(TOP + (number + 1) * height) - 3,
        WIDTH // 2 + 2 :,
    ]


def pixels_of_colour(
    pixels: Pixels, colour: str, within: int = 30
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the pixels that have `colour` (#rrggbb), each part `within` so much."""
    wanted = np.frombuffer(bytes.fromhex(colour[1:]), dtype=np.uint8).astype(np.int16)
    rows, columns = np.nonzero((np.abs(pixels - wanted) <= within).all(axis=-1))
    return rows, columns


def free_port() -> int:
    """A port that is free, as the next one is."""
    with socket.socket() as first, socket.socket() as second:
        first.bind(("127.0.0.1", 0))
        port: int = first.getsockname()[1]
        try:
            second.bind(("127.0.0.1", port + 1))
        except OSError:
            return free_port()
        return port


class NotingProxy:
    """A proxy that answers nothing; `requests` holds the first line of each request."""

    def __init__(self) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.address = f"http://127.0.0.1:{self._socket.getsockname()[1]}"
        self.requests: list[str] = []
        self._thread = threading.Thread(target=self._listen, daemon=True)

    def _listen(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                return
            with connection, connection.makefile("rb") as request:
                self.requests.append(request.readline().decode("latin-1").strip())
                connection.sendall(
                    b"HTTP/1.1 502 Bad Gateway\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
                )

    def __enter__(self) -> NotingProxy:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()
        self._thread.join()
