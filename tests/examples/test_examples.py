"""The examples of embedding: a chase in Panda3D, and a page that spawns agents by clicking."""

import importlib.util
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from tests.browser import BROWSER, opened

ROOT = Path(__file__).resolve().parents[2]
WEB = ROOT / "examples" / "web"
THREE = WEB / "node_modules" / "three" / "build" / "three.module.js"


@pytest.mark.skipif(importlib.util.find_spec("panda3d") is None, reason="needs the extra 'panda3d'")
def test_the_dogs_in_panda3d_come_near_the_ball(tmp_path):
    picture = tmp_path / "chase.png"
    command = [sys.executable, "examples/panda3d_chase.py", "--headless", "--seconds", "20"]
    answer = subprocess.run(
        [*command, "--picture", str(picture)],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    begin, nearest = (
        sorted(float(each) for each in re.findall(r"([\d.]+) m", line))
        for line in answer.stdout.splitlines()
        if line.startswith("at the")
    )
    assert begin[0] > 5.0
    assert all(each < 1.5 + 1.2 * k for k, each in enumerate(nearest))  # they queue: one's length and room
    pixels = matplotlib.image.imread(picture)[..., :3].reshape(-1, 3)
    red = (pixels[:, 0] > 0.5) & (pixels[:, 1:] < 0.3).all(axis=1)
    brown = (pixels[:, 0] > 1.3 * pixels[:, 2]) & ~red
    assert red.sum() > 50 and brown.sum() > 200


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
@pytest.mark.skipif(not THREE.is_file(), reason="no three.js: run npm install in examples/web")
@pytest.mark.skipif(importlib.util.find_spec("websockets") is None, reason="needs the extra 'serve'")
def test_clicking_in_the_page_spawns_agents_that_go_where_they_are_sent(tmp_path):
    command = [
        sys.executable,
        "-c",
        "import runtime.cli.app; runtime.cli.app.main()",
        "serve",
        "examples/levels/room.obj",
        "--port",
        "0",
    ]
    server = subprocess.Popen(
        [*command, "--pages", str(WEB)],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        line = server.stdout.readline()
        address = line.split()[-1].replace("ws:", "http:") + "/"
        with opened(address, tmp_path / "profile", (640, 480), 200.0) as page:
            assert page is not None
            _until(lambda: "on room" in (page.value("document.body.innerText") or ""))
            empty = page.picture()
            page.value("document.getElementById('body').value = 'walker'")
            page.click(320, 250)
            _until(lambda: _new(page.picture(), empty) > 60)
            page.click(250, 190, modifiers=8)
            _until(lambda: "Departed" in page.value("document.body.innerText"))
            _until(lambda: "Arrived" in page.value("document.body.innerText"))
            assert _new(page.picture(), empty) > 60
    finally:
        server.terminate()
        server.wait(30)


def _new(picture, before):
    """How many pixels of the level's part of the window are not as they were."""
    changed = np.abs(picture - before).max(axis=2) > 0.08
    return int(changed[80:].sum())


def _until(condition):
    deadline = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < deadline, "nothing of the kind happened in 120 s"
        time.sleep(0.3)


def test_people_walk_through_a_city_that_loads_around_one_of_them(tmp_path):
    picture = tmp_path / "people.png"
    command = [sys.executable, "examples/open_world_people.py", "--blocks", "4", "--window", "40"]
    answer = subprocess.run(
        [*command, "--seconds", "16", "--picture", str(picture)],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    came = re.search(r"(\d+) chunks came", answer.stdout)
    assert came and int(came[1]) > 0 and picture.is_file()
    assert answer.stdout.count("sets out for") >= 4 and "loses its way" not in answer.stdout
