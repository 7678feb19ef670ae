"""A square of people at all levels of detail."""

import json
import re

import pytest

from examples.make_characters import STOUT, write_character
from examples.square import Square, draw, write
from locomotion import Rig


def test_the_nearest_are_simulated_and_the_others_are_drawn(tmp_path):
    scene = Square(people=6, dogs=1, seed=1)
    for _ in range(25):
        scene.step()
    assert 0 < scene.counts["physics"] < 6
    assert any(agent.moving for agent in scene.people)
    draw(scene, tmp_path / "square.png", (48, 30))
    assert (tmp_path / "square.png").stat().st_size > 1_000


def test_there_are_people_at_every_level():
    scene = Square(people=60, dogs=0, seed=1)
    for _ in range(25):
        scene.step()
    counts = scene.counts
    assert 0 < counts["physics"] <= 10  # they go over one by one
    assert counts["full"] == 12 and counts["medium"] == 24
    assert counts["low"] >= 14 and sum(counts.values()) == 60


@pytest.mark.parametrize("dressed", [True, False])
def test_a_page_shows_people_as_the_character(tmp_path, dressed):
    write_character(STOUT, tmp_path / "stout.glb")
    rig = Rig.load(tmp_path / "stout.glb") if dressed else None
    scene = Square(people=6, dogs=1, seed=1)
    for _ in range(25):
        scene.step()
    begun = scene.world.time
    write(scene, tmp_path / "square.html", 0.2, rig)
    assert scene.world.time - begun == pytest.approx(0.2)
    page = (tmp_path / "square.html").read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="header">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    header = json.loads(found[1])
    assert len(header["agents"]) == 7
    assert len(header["skins"]) == (6 if dressed else 0)  # the dog wears none
    followed = scene.world.agents[header["follow"]]
    assert followed in scene.people and followed.level == "physics"
