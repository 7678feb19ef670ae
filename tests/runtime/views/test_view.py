"""The page that plays a run: one file, nothing from elsewhere, and it draws."""

import dataclasses
import json
import re

import numpy as np
import pytest

from examples.make_characters import STOUT, write_character
from locomotion import Rig
from runtime.events import SkillStarted
from runtime.views.page_data import page_data
from runtime.views.view import write_page
from runtime.views.worn import ground_of
from tests.browser import BROWSER, opened, screenshot


def test_page_is_whole_and_needs_no_network(trace, tmp_path):
    write_page(trace, tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert [each.name for each in tmp_path.iterdir()] == ["run.html"]
    assert page.rstrip().endswith("</html>") and "<!--" not in page
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


VISIBLE = (
    "[...document.querySelectorAll('#labels span')].filter((each) => each.style.visibility === 'visible')"
)
"""The labels that are shown, in JavaScript."""


def array(header, data, *keys):
    """The array that the header names under ``keys``."""
    for key in keys:
        header = header[key]
    kind, shape = np.dtype(header["kind"]), header["shape"]
    return np.frombuffer(data, kind, int(np.prod(shape)), header["at"]).reshape(shape)


def test_the_page_is_given_the_poses_paths_and_graph_of_the_trace(trace):
    header, data = page_data(trace, None)
    agent, level = trace.agents[0], trace.level
    origin = 0.5 * (level.vertices.min(axis=0) + level.vertices.max(axis=0))
    assert header["follow"] == "ada" and header["agents"][0]["name"] == "ada"
    np.testing.assert_allclose(array(header, data, "times"), trace.times, atol=1e-6)
    shown = array(header, data, "agents", 0, "positions") + origin
    np.testing.assert_allclose(shown, agent.poses[..., :3], atol=1e-5)
    turns = array(header, data, "agents", 0, "turns") / 32767.0
    np.testing.assert_allclose(turns, agent.poses[..., 3:], atol=1e-4)
    smooth = array(header, data, "agents", 0, "paths", 0, "smooth") + origin
    np.testing.assert_allclose(smooth, agent.paths[0].smooth, atol=1e-5)
    assert array(header, data, "level", "discs").shape == (int((level.radii > 0.3).sum()), 4)
    assert array(header, data, "level", "faces").tolist() == level.faces.tolist()


def test_events_are_told_in_words_and_text_cannot_leave_its_place(trace, tmp_path):
    started = SkillStarted(0.2, "ada", (2.0, 3.0, 0.0), "leap", 1.2).to_dict()
    evil = {"kind": "Unheard", "time": 0.3, "agent": "</script><!--", "position": [0, 0, 0]}
    departed = {**trace.events[0], "kind": "Departed"}
    run = dataclasses.replace(trace, events=(departed, departed, started, evil))
    header, _ = page_data(run, "ada")
    assert [event["text"] for event in header["events"][1:]] == [
        "ada leaps over 1.20 m",
        "</script><!--: Unheard",
    ]
    write_page(run, tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    embedded = re.search(r'<script type="application/json" id="header">(.*?)</script>', page, re.DOTALL)
    assert embedded is not None and json.loads(embedded[1]) == header


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_the_page_opens_on_its_figure_and_its_layers_can_be_switched(trace, tmp_path):
    write_page(trace, tmp_path / "run.html")
    with opened((tmp_path / "run.html").as_uri() + "#t=0.2", tmp_path / "profile", (900, 600), 200.0) as page:
        while not page.value("Boolean(window.surefoot)"):
            pass
        assert page.value("surefoot.moment") == pytest.approx(0.2)
        assert page.value("surefoot.followed.name") == "ada"
        tall = page.value(
            """(() => {
              const view = surefoot.camera.view(900, 600);
              const root = surefoot.figures.root(surefoot.followed, 0.2);
              const at = (z) => projected(view.matrix, add(root, [0, 0, z]), 900, 600)[1];
              return at(-0.9) - at(0.7);
            })()"""
        )
        assert tall > 250.0, "the person is at least 250 of 600 pixels high"

        def coloured():
            picture = page.picture()
            return int(((picture[..., 0] - picture[..., 1] > 0.35) & (picture[..., 2] < 0.4)).sum())

        def switch(layer):
            page.value(f"document.getElementById('layer-{layer}').click()")
            page.value("surefoot.draw()")

        switch("figures")  # their shoes are red, too
        with_path = coloured()
        switch("smooth")
        assert with_path > coloured() + 50

        assert page.value(f"{VISIBLE}.length") == 0
        switch("figures")
        assert page.value(f"{VISIBLE}.map((each) => each.textContent).join()") == "ada"


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_labels_do_not_overlap(trace, tmp_path):
    level, rng = trace.level, np.random.default_rng(5)
    count = 60
    rim = np.repeat(rng.uniform([1.0, 1.0, 0.0], [11.0, 5.0, 0.5], (count, 3))[:, None], 2, axis=1)
    rim[:, 1, 1] += 0.5
    crowded = dataclasses.replace(
        level, affordances=("jump",) * count, rim=rim, height=rng.uniform(0.1, 0.7, count),
        normal=np.tile([1.0, 0.0, 0.0], (count, 1)),
    )  # fmt: skip
    write_page(dataclasses.replace(trace, level=crowded), tmp_path / "run.html")
    with opened((tmp_path / "run.html").as_uri() + "#t=0.2", tmp_path / "profile", (900, 600), 200.0) as page:
        while not page.value("Boolean(window.surefoot)"):
            pass
        page.value("surefoot.camera.away = 20; surefoot.draw()")
        boxes = json.loads(
            page.value(f"JSON.stringify({VISIBLE}.map((each) => each.getBoundingClientRect()))")
        )
    assert 5 < len(boxes) < count
    for k, a in enumerate(boxes):
        for b in boxes[k + 1 :]:
            apart = a["right"] <= b["left"] or b["right"] <= a["left"]
            assert apart or a["bottom"] <= b["top"] or b["bottom"] <= a["top"]


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


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_the_page_shows_people_as_a_character(trace, tmp_path):
    write_character(STOUT, tmp_path / "stout.glb")
    rig = Rig.load(tmp_path / "stout.glb")
    write_page(trace, tmp_path / "run.html", "ada", rig)
    with opened((tmp_path / "run.html").as_uri() + "#t=0.2", tmp_path / "profile", (480, 320), 200.0) as page:
        while not page.value("Boolean(window.surefoot)"):
            pass
        high = page.value("surefoot.figures.placed(surefoot.run.skins[0].bones, 0)[0][0][2]")

        def brown():
            """How much of the page has the colour of its shirt."""
            page.value("document.getElementById('panel').open = false; surefoot.draw()")
            seen = page.picture()
            return ((seen[..., 0] - seen[..., 2] > 0.25) & (seen[..., 1] > 0.15)).sum()

        with_it = brown()
        page.value("document.getElementById('layer-figures').click()")
        assert with_it > brown() + 100
    origin = 0.5 * (trace.level.vertices.min(axis=0) + trace.level.vertices.max(axis=0))
    there = rig.pose_from(trace.agents[0].poses[0], trace.agents[0].figure.bodies, ground_of(trace.level))
    assert high == pytest.approx(there[0, 2] - origin[2], abs=1e-3)
