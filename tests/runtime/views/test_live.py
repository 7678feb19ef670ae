"""A world that is watched while it runs."""

import time

import numpy as np
import pytest

import runtime
from runtime.views.window import Window
from tests.browser import BROWSER, opened

needs_browser = pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")


def inhabited(graph):
    world = runtime.World(graph, seed=1)
    world.spawn("human", (2.0, 3.0, 0.0), name="ada").go_to((9.0, 3.0, 0.0), speed=3.0)
    world.spawn("dog", (2.0, 1.5, 0.0), name="rex").go_to((9.0, 1.5, 0.0), speed=1.0)
    world.spawn("walker", (9.0, 4.5, 0.0), name="tom")
    return world


def test_watching_changes_nothing(graph, monkeypatch):
    monkeypatch.setattr(Window, "watched", True)
    ends = []
    for is_watched in (False, True):
        world = inhabited(graph)
        view = runtime.LiveView(world) if is_watched else None
        for _ in range(60):
            world.step(1 / 60)
            if view is not None:
                view.show()
        if view is not None:
            view.close()
        ends.append(world.state_hash())
    assert ends[0] == ends[1]


def orange(picture):
    """(k, 2) the pixels of the walker's colour, between the browser's warning and the panel."""
    free = picture[:, 330:860]
    return np.argwhere((free[..., 0] - free[..., 2] > 0.25) & (free[..., 0] > free[..., 1] + 0.08))


def until(holds, view, world):
    """Let the world go on until ``holds()``; the page's calls end it with TimeoutError."""
    while not holds():
        world.step(0.1)
        view.show()
        time.sleep(0.05)


def chosen(page, option):
    """Choose whom the camera follows, as a user does."""
    page.value("document.querySelector('input[value=nobody]').click()")
    while not page.value(
        f"[...document.querySelectorAll('[role=option]')].some(o => o.innerText == '{option}')"
    ):
        pass
    page.value(
        f"[...document.querySelectorAll('[role=option]')].find(o => o.innerText == '{option}').click()"
    )


@needs_browser
def test_a_running_world_is_seen_and_its_agents_move(graph, tmp_path):
    world = inhabited(graph)
    with runtime.LiveView(world) as view, opened(view.address, tmp_path, (1200, 450), 200.0) as page:
        assert page is not None
        seen = []

        def sees_the_walker():
            seen.append(orange(page.picture()))
            return len(seen[-1]) > 15

        def time_shown():
            return float(page.value("[...document.querySelectorAll('input')].at(-1).value"))

        until(sees_the_walker, view, world)
        small, there = len(seen[-1]), seen[-1].mean(axis=0)
        world.agents["tom"].go_to((2.0, 4.5, 0.0), speed=1.0)
        until(lambda: sees_the_walker() and np.linalg.norm(seen[-1].mean(axis=0) - there) > 10.0, view, world)
        chosen(page, "tom")
        until(lambda: sees_the_walker() and len(seen[-1]) > 4 * small, view, world)

        live = "[...document.querySelectorAll('input[type=checkbox]')].at(-1).click()"
        page.value(live)
        until(lambda: not view.is_live, view, world)
        held = time_shown()
        until(lambda: world.time > held + 3.0, view, world)
        assert time_shown() <= held + 1.0
        page.value(live)
        until(lambda: time_shown() > held + 3.0, view, world)
