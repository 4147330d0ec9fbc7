"""Fixtures of the viewer's tests: a browser, and a started viewer."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from bridge_tools import new_domain, start
from page_pixels import CHROMIUM, HEIGHT, SWITCHES, WIDTH, NotingProxy, Started, free_port
from playwright.sync_api import Browser, Page, sync_playwright


@pytest.fixture(scope="module")
def proxy() -> Iterator[NotingProxy]:
    """A proxy in the place of all other machines, which notes the browser's requests."""
    with NotingProxy() as proxy:
        yield proxy


@pytest.fixture(scope="module")
def browser(proxy: NotingProxy, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """Chromium, from build/chromium, which `make test` fetches."""
    assert (CHROMIUM / "chromium").is_file(), (
        f"{CHROMIUM} has no Chromium: make build/chromium/.packages"
    )
    home = tmp_path_factory.mktemp("home")
    environment = {
        "LD_LIBRARY_PATH": str(CHROMIUM / "lib"),
        "FONTCONFIG_PATH": str(CHROMIUM),
        "HOME": str(home),
        "TMPDIR": str(home),
    }
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(
            executable_path=CHROMIUM / "chromium",
            args=[*SWITCHES],
            env=environment,
            proxy={"server": proxy.address, "bypass": "127.0.0.1"},
        )
        yield found
        found.close()


@pytest.fixture(scope="module")
def page(browser: Browser) -> Page:
    """A page in the browser."""
    return browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})


@pytest.fixture
def viewing(processes: list[subprocess.Popen[str]]) -> Callable[..., Started]:
    """Starts `view` with the arguments given; its process, its address, and its port."""

    def begin(*arguments: Any, domain: int | None = None) -> Started:
        port = free_port()
        view = start(
            "view", *arguments, "--no-browser", "--port", port, domain=domain or new_domain()
        )
        processes.append(view)
        assert view.stdout is not None
        address = view.stdout.readline().strip()
        assert address.startswith(f"http://127.0.0.1:{port}/"), address + (
            view.stderr.read() if view.stderr else ""
        )
        return view, address, port

    return begin
