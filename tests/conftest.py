"""A small level and what can be made of it, shared by the tests of the runtime."""

import os
import signal

os.environ.setdefault(
    "OPENBLAS_NUM_THREADS", "1"
)  # threads wait for each other where several tests run at a time

import numpy as np
import pytest

import navmesh
from runtime.planning.rules import person_walk_rules
from runtime.traces.recording import Recorder
from runtime.world.world import World
from tests.small_level import MISSION, obj_text


@pytest.fixture
def folder(tmp_path):
    """A folder with level.obj and mission.yaml."""
    (tmp_path / "level.obj").write_text(obj_text())
    (tmp_path / "mission.yaml").write_text(MISSION)
    return tmp_path


@pytest.fixture(scope="session")
def graph(tmp_path_factory):
    path = tmp_path_factory.mktemp("level") / "level.obj"
    path.write_text(obj_text())
    return navmesh.NodeGraph.build(navmesh.Terrain.load(path), person_walk_rules())


@pytest.fixture(scope="session")
def trace(graph):
    """Half a second of a person that runs."""
    world = World(graph, seed=1)
    agent = world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    agent.go_to((9.0, 3.0, 0.0), speed=3.0)
    recorder = Recorder(world)
    for _ in range(6):
        recorder.sample()
        world.step(0.09)
    assert np.isfinite(agent.position).all()
    return recorder.trace({"held": True})


@pytest.fixture(scope="session", autouse=True)
def heed_interrupts():
    """A shell lets its background jobs ignore Ctrl-C, and their children inherit that; the commands that the
    tests interrupt must not."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
