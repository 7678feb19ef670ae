"""Poses of remote people: legs that follow the speed, postures that follow what is told, no jumps."""

import numpy as np
import pytest

from runtime import RuntimeInputError, World
from runtime.bodies.remote_figures import REMOTE
from runtime.bodies.remote_poses import STANDS, posture_name, posture_number, wanted_postures
from tests.runtime.bodies.test_remote_figures import told_state, walks


@pytest.mark.parametrize(
    ("told", "flags", "posture"),
    [
        (STANDS, {}, "stand"),
        ("kneel", {}, "kneel"),
        ("kneel", {"moves": 1.0}, "stand"),
        ("prone", {"moves": 1.0}, "all-fours"),
        (STANDS, {"crawling": 1.0, "moves": 1.0}, "all-fours"),
        ("prone", {"fatal": 1.0, "moves": 1.0}, "dead"),
    ],
)
def test_what_is_wanted(told, flags, posture):
    rows = np.zeros(1, REMOTE)
    rows["posture"] = posture_number(told)
    for name, value in flags.items():
        rows[name] = value
    assert posture_name(wanted_postures(rows)[0]) == posture
    with pytest.raises(RuntimeInputError, match="'upside down': valid: stand"):
        posture_number("upside down")


def frames(world, agent, seconds):
    poses = []
    for _ in range(round(seconds * 50)):
        world.step(0.02)
        poses.append(agent.pose)
    return poses


@pytest.mark.parametrize("speed", [1.2, 3.5])
def test_a_step_is_as_long_as_the_way_it_takes(graph, speed):
    """The lower foot hardly slides while it stands: half of the time, at less than a third of the speed."""
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "", walks((1, 3, 0), (speed, 0, 0)), age=0.0))
    poses = frames(world, agent, 2.0)[25:]
    feet = [agent.figure.bodies.index(f"{side}_foot") for side in ("left", "right")]
    places = np.array([pose.transforms[feet, :3] for pose in poses])
    lower = places[:-1, :, 2].argmin(axis=1)
    speeds = np.linalg.norm(np.diff(places[..., :2], axis=0), axis=2) * 50.0
    of_lower = speeds[np.arange(len(lower)), lower]
    assert np.percentile(of_lower, 30) < speed / 3.0
    hips = np.array([pose.local[agent.figure.bodies.index("left_thigh"), 3:] for pose in poses])
    assert np.ptp(hips[:, 2]) > 0.2


def test_getting_down_and_up_again_does_not_jump(graph):
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "", walks((4, 3, 0), (0, 0, 0)), age=0.0))
    worst, heights = 0.0, []
    for posture in ("prone", "stand", "sit", "crouch", "stand"):
        agent.driver.posture = posture
        poses = frames(world, agent, 4.5)
        heights.append(poses[-1].transforms[:, 2].max())
        turns = np.array([pose.local[:, 3:] for pose in poses])
        dots = np.abs(np.sum(turns[1:] * turns[:-1], axis=2)).clip(0.0, 1.0)
        worst = max(worst, float(2.0 * np.arccos(dots).max()))
    assert worst < np.radians(5.0)
    assert heights[0] < 0.6 and heights[1] > 1.4 and heights[2] < 1.1 and heights[4] > 1.4


def test_the_dead_fall_and_may_come_back(graph):
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "", walks((4, 3, 0), (0, 0, 0)), age=0.0))
    agent.driver.row["fatal"] = 1.0
    assert frames(world, agent, 2.0)[-1].transforms[:, 2].max() < 0.5
    agent.driver.row["fatal"] = 0.0
    assert frames(world, agent, 2.0)[-1].transforms[:, 2].max() > 1.4


def test_crawling_moves_hands_and_knees(graph):
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "", walks((2, 3, 0), (0.4, 0, 0)), age=0.0))
    agent.driver.row["crawling"] = 1.0
    poses = frames(world, agent, 6.0)[200:]
    assert max(pose.transforms[:, 2].max() for pose in poses) < 0.9
    hips = np.array([pose.local[agent.figure.bodies.index("left_thigh"), 3:] for pose in poses])
    assert np.ptp(hips[:, 2]) > 0.1
