"""The site as `make site` builds it, on a phone: part of `make torture`, since it takes a while."""

from __future__ import annotations

import functools
import http.server
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from page_pixels import CHROMIUM, SWITCHES
from playwright.sync_api import Page, sync_playwright

pytestmark = [
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="builds the site: make torture"),
]
ROOT = Path(__file__).resolve().parents[2]
PHONE = {"width": 390, "height": 844}
FONTS = """<?xml version="1.0"?><!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><dir>{fonts}</dir><cachedir>{cache}</cachedir></fontconfig>"""


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site; a link that leads nowhere would have ended its build."""
    folder = tmp_path_factory.mktemp("built") / "site"
    command = [sys.executable, str(ROOT / "docs" / "site"), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture(scope="module")
def address(site) -> Iterator[str]:
    """Where the site is served."""
    handler = functools.partial(Quiet, directory=str(site))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
        thread.join()


@pytest.fixture(scope="module")
def phone(tmp_path_factory) -> Iterator[Page]:
    home = tmp_path_factory.mktemp("home")
    fonts = home / "fonts.conf"
    fonts.write_text(FONTS.format(fonts=CHROMIUM / "fonts", cache=home / "cache"))
    environment = {
        "LD_LIBRARY_PATH": str(CHROMIUM / "lib"),
        "FONTCONFIG_FILE": str(fonts),
        "HOME": str(home),
        "TMPDIR": str(home),
    }
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM / "chromium", args=[*SWITCHES], env=environment
        )
        yield browser.new_page(viewport=PHONE)
        browser.close()


def test_each_page_is_as_wide_as_a_phone_and_asks_no_other_machine(site, address, phone):
    asked = []
    phone.on("request", lambda request: asked.append(request.url))
    pages = [p.relative_to(site).as_posix() for p in site.rglob("*.html")]
    pages = [page for page in pages if not page.startswith("_")]
    assert len(pages) > 30
    for page in pages:
        phone.goto(address + page)
        assert phone.locator("meta[name=viewport]").count() > 0, page
        assert phone.evaluate("document.documentElement.scrollWidth") <= PHONE["width"], page
    assert [url for url in asked if not url.startswith((address, "data:", "blob:"))] == []


def test_search_finds_a_page(address, phone):
    phone.goto(f"{address}search.html?q=orifice")
    phone.wait_for_selector("ul.search > li a", timeout=60_000)
    found = phone.locator("ul.search > li a").all_inner_texts()
    assert "Parameters" in " ".join(found)


def test_a_link_that_leads_nowhere_ends_the_build(site, tmp_path):
    """By the same settings, on two pages."""
    pages = tmp_path / "pages"
    pages.mkdir()
    for name, text in (("index", "# A\n\n[b](b.md#nothing)\n"), ("b", "# B\n\n[c](c.md)\n")):
        (pages / f"{name}.md").write_text(text)
    options = ["-W", "--keep-going", "-q", "-c", str(ROOT / "docs" / "site")]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, str(pages), str(tmp_path / "made")],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode != 0
    assert "nothing" in done.stderr
    assert "c.md" in done.stderr
