"""A log in a browser: pixels of Rerun's viewer in headless Chromium."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from bridge_tools import TIMEOUT, new_domain, start
from page_pixels import (
    NotingProxy,
    Pixels,
    free_port,
    pixels_of_colour,
    plot_of,
    screenshot,
    vehicle_of,
)
from playwright.sync_api import Browser, Page
from pytest import approx

from rlv_landing.figures.style import COLOURS, FORCE, GRID, INK
from rlv_ros_bridge.logs.history import log_history

FIRST, SECOND = COLOURS[:2]


def until(page: Page, seen: Callable[[Pixels], Any]) -> Pixels:
    """The first picture of the page for which `seen` is true.

    Each picture takes as long as the page needs to draw itself.
    """
    for _ in range(200):
        pixels = screenshot(page)
        if seen(pixels):
            return pixels
        page.wait_for_timeout(100)
    raise AssertionError("not seen in 200 pictures")


def legs(pixels: Pixels) -> list[int]:
    """The number of pixels in the vehicle's view with the colour of each group of legs."""
    return [len(pixels_of_colour(vehicle_of(pixels), colour)[0]) for colour in (FIRST, SECOND)]


def cursor(pixels: Pixels) -> int:
    """The column of the dark line at the current time in the plot of strokes; -1: there is none."""
    dark = (plot_of(pixels, 1).max(axis=-1) < 120).sum(axis=0)
    return int(dark.argmax()) if dark.max() > 0.8 * len(plot_of(pixels, 1)) else -1


class Pictures(NamedTuple):
    """The page while it plays, at a later instant, and twice in a pause."""

    page: Page
    playing: Pixels
    later: Pixels
    paused: Pixels
    still: Pixels


@pytest.fixture(scope="module")
def pictures(one_log: Path, page: Page) -> Iterator[Pictures]:
    """A log of the 2-2 drop test."""
    port = free_port()
    view: subprocess.Popen[str] = start(
        "view", one_log, "--no-browser", "--port", port, domain=new_domain()
    )
    try:
        assert view.stdout is not None
        page.goto(view.stdout.readline().strip() + "&renderer=webgl")
        playing = until(
            page,
            lambda pixels: min(legs(pixels)) > 100 and cursor(pixels) > 0 and pushes(pixels) > 20,
        )
        later = until(page, lambda pixels: cursor(pixels) not in (-1, cursor(playing)))
        page.keyboard.press("Space")
        paused = until(
            page, lambda pixels: cursor(pixels) > 0 and (screenshot(page) == pixels).all()
        )
        yield Pictures(page, playing, later, paused, screenshot(page))
    finally:
        view.send_signal(signal.SIGINT)
        assert view.wait(TIMEOUT) == 130


def pushes(pixels: Pixels) -> int:
    """The number of pixels in the vehicle's view with the colour of the ground's forces."""
    return len(pixels_of_colour(vehicle_of(pixels), FORCE)[0])


def test_the_vehicle_stands_on_its_legs_each_group_in_its_colour(pictures: Pictures) -> None:
    vehicle = vehicle_of(pictures.playing)
    rows, columns = zip(
        *(pixels_of_colour(vehicle, colour) for colour in (FIRST, SECOND, INK, FORCE, GRID))
    )
    first, second, body, force, ground = range(5)
    assert all(len(found) > 20 for found in rows)
    # The vehicle is seen from the right and flies to the right: the rear legs touch down first.
    assert columns[first].mean() < columns[body].mean() < columns[second].mean()
    assert rows[body].min() < min(rows[first].min(), rows[second].min()) - 30
    assert rows[force].min() > rows[body].min() + 30
    assert max(rows[first].max(), rows[second].max()) > np.median(rows[ground])


def test_curves_have_the_legs_colours_and_their_peaks_where_the_log_has_them(
    pictures: Pictures, one_log: Path
) -> None:
    history = log_history(one_log)
    for number in range(3):
        assert all(
            len(pixels_of_colour(plot_of(pictures.playing, number), colour)[0]) > 100
            for colour in (FIRST, SECOND)
        )
    strokes = plot_of(pictures.playing, 1)
    ends = np.concatenate([pixels_of_colour(strokes, colour)[1] for colour in (FIRST, SECOND)])
    for leg, colour in ((1, FIRST), (3, SECOND)):
        rows, columns = pixels_of_colour(strokes, colour)
        seen = (columns[rows == rows.min()].mean() - ends.min()) / (ends.max() - ends.min())
        peak = history.time[history[f"leg[{leg}].main_strut.stroke"].argmax()] / history.time[-1]
        # A hundredth of the plot is three pixels; peaks are flat.
        assert seen == approx(peak, abs=0.03)


def test_time_runs_and_moves_the_vehicle_until_space_pauses_it(pictures: Pictures) -> None:
    assert cursor(pictures.later) != cursor(pictures.playing)
    assert np.abs(vehicle_of(pictures.later) - vehicle_of(pictures.playing)).max() > 100
    assert (pictures.still == pictures.paused).all()


def test_the_page_sends_no_request_to_other_machines(
    pictures: Pictures, browser: Browser, proxy: NotingProxy
) -> None:
    assert proxy.requests == []
    # Without the page's policy the same browser would send requests.
    other = browser.new_page()
    other.goto("data:text/html,<p>")
    other.evaluate("() => fetch('http://example.invalid/', {mode: 'no-cors'}).catch(() => null)")
    other.close()
    assert [line.split()[1] for line in proxy.requests] == ["http://example.invalid/"]
