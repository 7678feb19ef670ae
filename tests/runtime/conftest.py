"""A small level and what can be made of it, shared by the tests of the runtime."""

import signal
import textwrap

import numpy as np
import pytest

import navmesh
from runtime.planning.rules import person_walk_rules
from runtime.traces.recording import Recorder
from runtime.world.world import World

FLOORS = {"near": (0.0, 0.0, 12.0, 6.0, 0.0), "island": (16.0, 0.0, 20.0, 6.0, 0.0)}
"""x0, y0, x1, y1, z of each floor of the small level; nobody gets from one to the other."""

MISSION = textwrap.dedent(
    """\
    level:
      file: level.obj
      up: z
    seed: 3
    time_limit: 20
    agents:
      - name: ada
        body: human
        start: [2, 3, 0]
        facing_deg: 0
        speed: 3.0
        goto:
          - [9, 3, 0]
        expect:
          arrives_within: 15
          never_falls: true
    """
)


def obj_text():
    lines, count = [], 0
    for x0, y0, x1, y1, z in FLOORS.values():
        for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)):
            lines.append(f"v {x} {y} {z}")
        lines += [f"f {count + 1} {count + 2} {count + 3}", f"f {count + 1} {count + 3} {count + 4}"]
        count += 4
    return "\n".join(lines) + "\n"


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
