# SPDX-License-Identifier: Apache-2.0
"""report.html of small runs, opened in a headless Chromium: whole, silent, off line, with the verdict in words and pictures one can see."""

import json
import os
import shutil

import pytest
from playwright.sync_api import sync_playwright

RUNS = {"planar": ["planar"], "pipes": ["pipes:cylinders=6", "--max-scans", "3"]}


@pytest.fixture(scope="session")
def browser():
    """The system's Chromium; playwright's own is not downloaded."""
    program = os.environ.get("VANTAGE_CHROMIUM") or shutil.which("chromium")
    assert program, "chromium is missing (apt-get install chromium, or VANTAGE_CHROMIUM)"
    with sync_playwright() as playwright:
        instance = playwright.chromium.launch(executable_path=program, args=["--no-sandbox", "--disable-dev-shm-usage"])
        yield instance
        instance.close()


@pytest.fixture(scope="session", params=sorted(RUNS))
def run(request, vantage, tmp_path_factory):
    """Folder of a finished run."""
    folder = tmp_path_factory.mktemp("browser") / request.param
    result = vantage("explore", *RUNS[request.param], "-o", folder, "-q")
    assert result.returncode == 0, result.stderr
    return folder


@pytest.fixture(scope="session")
def opened(browser, run):
    """(page, messages, requests) of the report, loaded."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    messages, requests = [], []
    page.on("console", lambda message: messages.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: messages.append(f"exception: {error}"))
    page.on("request", lambda request: requests.append(request.url))
    address = (run / "report.html").as_uri()
    page.goto(address, wait_until="load")
    yield page, messages, [url for url in requests if url != address and not url.startswith(("data:", "blob:"))]
    page.close()


def test_no_errors_and_no_network(opened):
    page, messages, requests = opened
    assert [text for text in messages if text.startswith(("error", "exception", "warning"))] == []
    assert requests == []


def test_verdict_in_words(opened, run):
    page, _, _ = opened
    reason = json.loads((run / "result.json").read_text())["verdict"]["reason"]
    words = " ".join(page.inner_text("body").split())
    assert reason and " ".join(reason.split()) in words


def test_pictures_are_there(opened):
    page, _, _ = opened
    pictures = page.evaluate(
        """async () => {
          const all = [...document.images];
          await Promise.all(all.map(p => p.decode().catch(() => 0)));
          return all.map(p => [p.naturalWidth, p.naturalHeight, p.src.slice(0, 11)]);
        }"""
    )
    assert pictures, "the report holds no picture"
    assert [p for p in pictures if p[0] == 0 or p[1] == 0 or not p[2].startswith("data:image/")] == []


def test_nothing_sticks_out(opened):
    """No sideways scrolling, neither on a desk nor on a telephone."""
    page, _, _ = opened
    for width in (1280, 400):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
