"""A thing is where the hands hold it, our own or those of a character: in traces, pages and films."""

import dataclasses

import numpy as np
import pytest

from examples.make_characters import STOUT, write_character
from locomotion import Rig
from locomotion.body.hand_hold import HAND_POINT
from runtime import World
from runtime.bodies.figure import rotate
from runtime.bodies.held_things import Looks, place_between, thing_figure, thing_of
from runtime.traces.recording import Recorder
from runtime.traces.trace import Trace
from runtime.views.film import frames
from runtime.views.page_data import page_data
from runtime.views.worn import only_things, worn_poses

GRIP, AHEAD = np.zeros(3), np.array([1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def held(graph, tmp_path_factory):
    """A second of a recorded person that takes a rifle, and one with free hands; written and read again."""
    world = World(graph, seed=1)
    ada = world.spawn("human", (2.0, 3.0, 0.0), name="ada", detail="full")
    world.spawn("human", (2.0, 4.0, 0.0), name="bob", detail="low")
    recorder = Recorder(world)
    for k in range(8):
        recorder.sample()
        if k == 1:
            ada.hold("rifle")
        world.step(0.2)
    file = tmp_path_factory.mktemp("held") / "run.npz"
    recorder.trace({}).write(file)
    return Trace.read(file)


def point_of(pose, bodies, side):
    """(t, 3) where a hand holds."""
    hand = pose[:, bodies.index(f"{side}_hand")].astype(np.float64)
    return hand[:, :3] + rotate(hand[:, 3:], np.array(HAND_POINT))


def test_it_lies_from_the_right_hand_to_the_left_one_and_upright():
    right, left = np.array([1.0, 2.0, 1.2]), np.array([1.2, 2.2, 1.3])
    place = place_between(right, left, np.array([1.0, 0.0, 0.0, 0.0]))
    along = rotate(place[3:], AHEAD)
    np.testing.assert_allclose(place[:3], right)
    np.testing.assert_allclose(along, (left - right) / np.linalg.norm(left - right), atol=1e-12)
    assert rotate(place[3:], np.array([0.0, 0.0, 1.0]))[2] > 0.9
    steep = place_between(right, right + np.array([0.0, 0.0, 0.3]), np.array([1.0, 0.0, 0.0, 0.0]))
    assert np.isfinite(steep).all() and rotate(steep[3:], AHEAD)[2] == pytest.approx(1.0)


def test_a_trace_keeps_what_is_held_and_when(held):
    ada, bob = held.agents
    assert (ada.figure.bodies[ada.own :], bob.held.size) == (("rifle",), 0)
    assert ada.held[:, 0].tolist() == [False, False, *[True] * 6]
    right, left = (point_of(ada.poses, ada.figure.bodies, side) for side in ("right", "left"))
    thing = ada.poses[:, -1].astype(np.float64)
    np.testing.assert_allclose(thing[:, :3], right, atol=1e-5)
    apart = np.linalg.norm(left - right, axis=1, keepdims=True)
    np.testing.assert_allclose(rotate(thing[:, 3:], AHEAD[None]), (left - right) / apart, atol=1e-5)
    assert apart[-1] == pytest.approx(0.3, abs=0.01)
    parts = len(thing_figure("rifle").owner)
    assert len(ada.posed(-1, ada.poses[-1]).size) == len(ada.posed(0, ada.poses[0]).size) + parts


def test_a_character_has_it_in_its_own_hands(held, tmp_path):
    write_character(STOUT, tmp_path / "stout.glb")
    rig, ada = Rig.load(tmp_path / "stout.glb"), held.agents[0]
    worn = worn_poses(rig, ada, held.times, None)
    things = only_things(ada, rig, worn)
    bone = worn[:, rig.names.index(rig.parts["right_hand"])]
    grip = bone[:, :3] + rotate(bone[:, 3:], rig.hand_points[0])
    np.testing.assert_allclose(things.poses[:, 0, :3], grip, atol=1e-5)
    assert things.own == 0 and len(things.posed(0, things.poses[0]).size) == 0
    assert only_things(held.agents[1], rig, worn) is None
    header, _ = page_data(held, "ada", rig)
    assert [skin["agent"] for skin in header["skins"]] == [0, 1]
    assert header["skins"][0]["things"]["positions"]["shape"][1] == 1 and header["skins"][1]["things"] is None
    few = dataclasses.replace(held, times=held.times[-2:], agents=tuple(
        dataclasses.replace(each, poses=each.poses[-2:], held=each.held[-2:]) for each in held.agents
    ))  # fmt: skip
    free = dataclasses.replace(few, agents=tuple(
        dataclasses.replace(each, held=np.zeros_like(each.held)) for each in few.agents
    ))  # fmt: skip
    for character in (None, rig):
        with_it, without = (next(frames(each, each.agents[0], (96, 64), character)) for each in (few, free))
        assert (with_it != without).any(axis=2).sum() > 10


def test_a_live_view_has_the_same_figure_as_long_as_the_same_is_held(graph):
    world, looks = World(graph, seed=1), Looks()
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="low")
    pose = ada.pose.transforms
    assert looks.look("ada", ada.figure, pose, "") == (ada.figure, pose)
    figure, with_it = looks.look("ada", ada.figure, pose, "rifle")
    assert figure.bodies == (*ada.figure.bodies, "rifle") and with_it.shape == (21, 7)
    assert looks.look("ada", ada.figure, pose, "rifle")[0] is figure
    assert looks.look("ada", ada.figure, pose, "air")[0] is ada.figure
    assert (thing_of("rifle in use"), thing_of("")) == ("rifle", "")
