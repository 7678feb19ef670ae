"""The page that plays a run: one file, nothing from elsewhere, and it draws."""

import re

import numpy as np
import pytest
from browser import BROWSER, screenshot

from runtime.view import write_page


def test_page_is_whole_and_needs_no_network(trace, tmp_path):
    write_page(trace, tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert [each.name for each in tmp_path.iterdir()] == ["run.html"]
    assert "__VISER_EMBED_DATA__" in page and page.rstrip().endswith("</html>")
    assert not re.search(r"<(script|link|img)[^>]+(src|href)=[\"']?https?:", page)


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_page_draws_in_a_browser(trace, tmp_path):
    write_page(trace, tmp_path / "run.html")

    def is_drawn(picture):
        """The level's surface fills a part of the window, with more than a few colours."""
        varied = np.abs(picture - np.median(picture, axis=(0, 1))).max(axis=2) > 0.05
        return varied.mean() > 0.05 and len(np.unique((picture * 31).astype(int).reshape(-1, 3), axis=0)) > 40

    picture = screenshot(tmp_path / "run.html", tmp_path / "profile", (480, 320), is_drawn, seconds=100.0)
    assert picture is not None, "nothing was drawn within 100 s"


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_the_camera_goes_with_an_agent(trace, tmp_path):
    write_page(trace, tmp_path / "run.html", follow="ada")

    def is_drawn(picture):
        """The person's blue shirt is in the middle of the window, and takes up some of it."""
        blue = (picture[..., 2] - picture[..., 0]) > 0.15
        height, width = blue.shape
        middle = blue[height // 4 : -height // 4, width // 3 : -width // 3]
        return middle.sum() > 40

    picture = screenshot(tmp_path / "run.html", tmp_path / "profile", (480, 320), is_drawn, seconds=200.0)
    assert picture is not None, "the person was not drawn in the middle within 200 s"
