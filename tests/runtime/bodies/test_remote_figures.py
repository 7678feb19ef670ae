"""Figures of other simulators: on our ground, saved and restored, refused where damaged."""

from dataclasses import replace

import numpy as np
import pytest

from runtime import World
from runtime.bodies.remote_figures import LONGEST, REMOTE, WIDTH, RemoteDriver, told_state
from runtime.dis.dead_reckoning import MODELS, Motion
from runtime.dis.geodesy import yaw_rotations


def walks(place, velocity, yaw=0.0):
    motion = Motion.empty(1)
    motion.algorithm[:] = MODELS.index("FPW")
    motion.position[:], motion.velocity[:] = place, velocity
    motion.rotation[:] = yaw_rotations(np.array([yaw]))
    return motion


def test_it_goes_on_and_then_stands(graph):
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "it", walks((2, 3, 0.4), (0.5, 0, 0)), age=1.0))
    assert agent.position == pytest.approx([2.5, 3.0, 0.0]) and agent.radius > 0.2
    world.step(2.0)
    assert agent.position == pytest.approx([3.5, 3.0, 0.0])
    world.step(LONGEST)
    assert agent.position[0] == pytest.approx(2.0 + 0.5 * LONGEST, abs=0.01)
    assert (agent.simulated(RemoteDriver).velocity == 0.0).all()


def test_feet_are_on_our_ground_or_on_theirs(graph):
    """Nothing of ours is near 50 m up, or beyond the level."""
    world = World(graph)
    for name, place in (("near", (2, 3, 0.6)), ("high", (3, 3, 50.0)), ("away", (300, 3, 1.0))):
        world.admit("remote", name, told_state("human", name, walks(place, (0, 0, 0)), age=0.0))
    world.step(2.0)
    heights = {name: agent.position[2] for name, agent in world.agents.items()}
    assert heights == pytest.approx({"near": 0.0, "high": 50.0, "away": 1.0}, abs=1e-3)
    soles = world.agents["near"].pose.transforms[:, 2].min()
    assert 0.0 < soles < 0.12


def test_removing_one_leaves_the_others(graph):
    world = World(graph)
    for k in range(4):
        world.admit("remote", str(k), told_state("human", "", walks((2.0 + k, 3, 0), (0, 0, 0)), age=0.0))
    world.agents["1"].remove()
    world.step(0.1)
    assert [agent.position[0] for agent in world.agents.values()] == pytest.approx([2.0, 4.0, 5.0])


def test_damaged_states_are_refused(graph):
    world = World(graph)
    agent = world.admit("remote", "it", told_state("human", "", walks((2, 3, 0), (1, 0, 0)), age=0.0))
    world.step(0.5)
    good = agent.driver.save()
    bad = good.row.copy()
    bad.view(REMOTE)["algorithm"] = 12
    upside_down = good.row.copy()
    upside_down.view(REMOTE)["posture"] = 99
    for state in (
        None,
        replace(good, row=np.zeros(WIDTH - 1)),
        replace(good, row=np.full(WIDTH, np.nan)),
        replace(good, row=bad),
        replace(good, look="dragon"),
        replace(good, look="dog"),
        replace(good, row=upside_down),
        replace(good, playback=replace(good.playback, arc=99)),
        replace(good, playback=replace(good.playback, place=np.zeros(2))),
    ):
        with pytest.raises(ValueError):
            agent.driver.restore(state)
    agent.driver.restore(good)
    assert agent.driver.state_hash() == agent.driver.state_hash()
