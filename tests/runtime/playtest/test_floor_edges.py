"""Pieces of the floor's edges, and bots that push at them."""

import math

import numpy as np

from runtime.playtest import bots as module
from runtime.playtest.bots import ROLES, run_bot
from runtime.playtest.character import character_of
from runtime.playtest.floor_edges import _every_other_bit, edges_of
from runtime.playtest.report import Setup
from runtime.playtest.run import open_stage
from runtime.playtest.site import Site
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import build
from tests.runtime.playtest.levels import D, W, box, room


def test_pieces_lie_beside_the_edge_and_look_at_it():
    site = Site(build(plane(0, 12, 0, 6)), character_of("walker"))
    places, outward = edges_of(site, np.ones(len(site.areas), dtype=bool))
    assert 30 <= len(places) <= 44  # one for each metre of 36
    ahead = places[:, :2] + 0.3 * np.column_stack([np.cos(outward), np.sin(outward)])
    inside = (places[:, :2] > 0).all(axis=1) & (places[:, 0] < 12) & (places[:, 1] < 6)
    beyond = (ahead < 0).any(axis=1) | (ahead[:, 0] > 12) | (ahead[:, 1] > 6)
    assert inside.all() and beyond.all()
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert np.median(steps) <= 2.0  # neighbours follow each other


def test_only_edges_of_the_parts_asked_for():
    site = Site(build(plane(0, 6, 0, 6), plane(10, 16, 0, 6)), character_of("walker"))
    one, other = (edges_of(site, np.arange(2) == k)[0] for k in range(2))
    assert len(one) and len(other) and (one[:, 0] < 6).all() != (other[:, 0] < 6).all()
    assert not len(edges_of(site, np.zeros(2, dtype=bool))[0])


def test_bits_are_spread():
    assert _every_other_bit(np.array([0, 1, 2, 3, 5], dtype=np.uint64)).tolist() == [0, 1, 4, 5, 17]


def test_every_prober_finds_the_pit(tmp_path):
    hole = [box(0, W, 0, 6, -0.2, 0), box(0, W, 6.8, D, -0.2, 0)]
    hole += [box(0, 9, 6, 6.8, -0.2, 0), box(9.8, W, 6, 6.8, -0.2, 0)]
    room(*hole).export(tmp_path / "room.obj")
    stage = open_stage(Setup(str(tmp_path / "room.obj"), "z", None, None, "walker", 10, 60.0, 1))
    runs = [run_bot(stage.site, stage.goals, 1, number, 60.0) for number in range(10)]
    assert [run.role for run in runs] == 2 * list(ROLES)
    for run in runs[4::5]:
        fallen = [each for each in run.troubles if each.kind == "fell"]
        assert fallen and math.dist(fallen[0].place[:2], (9.4, 6.4)) < 1.0


def test_each_prober_begins_elsewhere(monkeypatch, tmp_path):
    room(box(0, W, 0, D, -0.2, 0)).export(tmp_path / "room.obj")
    stage = open_stage(Setup(str(tmp_path / "room.obj"), "z", None, None, "walker", 10, 2.0, 1))
    first = []

    def reach(self, goal):
        first.append(tuple(goal))
        self.run.seconds = self.seconds

    monkeypatch.setattr(module._Bot, "_reach", reach)
    for number in range(4, 60, 5):
        run_bot(stage.site, stage.goals, 1, number, 2.0)
    assert len(set(first)) == len(first) == 12
