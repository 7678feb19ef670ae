"""A world on the server does what one here does, and is described to those who watch it."""

import json

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

import numpy as np

from runtime import RuntimeInputError, World
from runtime.bodies.remote_figures import told_state
from runtime.dis.dead_reckoning import Motion
from runtime.server.client import Client
from runtime.server.hosted import HostedWorld, skeleton, way_message
from runtime.server.levels import graph_message, mesh_message
from runtime.server.limits import Limits
from runtime.server.outbox import Outbox
from runtime.server.worlds import Worlds
from tests.runtime.server.serving import talk


def test_a_world_in_the_server_does_what_one_here_does(graph):
    async def conversation(server, join, port):
        client = await join()
        made = await client.ask("create", level="small", seed=5, clock="manual", states="local")
        world = made["world"]
        await client.ask("spawn", world=world, body="human", at=[2, 3, 0], name="ada")
        assert await client.ask("go_to", world=world, agent="ada", points=[[9, 3, 0]], speed=3.0) == {
            "status": "walking"
        }
        for _ in range(60):
            stepped = await client.ask("step", world=world, dt=1 / 60)
        saved = await client.ask("save", world=world)
        assert stepped["time"] == pytest.approx(1.0)
        await client.ask("step", world=world, dt=0.5)
        again = await client.ask("restore", world=world)
        while client.states[world]["time"] != saved["time"]:
            await client.hear()
        return saved, again, client

    saved, again, client = talk(graph, conversation)
    here = World(graph, seed=5)
    ada = here.spawn("human", (2.0, 3.0, 0.0), name="ada")
    ada.go_to([(9.0, 3.0, 0.0)], speed=3.0)
    for _ in range(60):
        here.step(1 / 60)
    assert saved["hash"] == again["hash"] == here.state_hash()
    (state,) = client.states.values()
    (told,) = state["agents"]
    assert told["position"] == pytest.approx(ada.position, abs=1e-3)
    assert np.reshape(told["transforms"], (-1, 7)) == pytest.approx(ada.pose.local, abs=1e-4)
    kinds = [message["type"] for message in client.told]
    assert kinds == ["agent", "event"]
    assert client.told[0]["agent"]["bodies"][0] == "pelvis"
    assert client.told[1]["event"]["kind"] == "Departed"


@pytest.fixture
def hosted(graph):
    made = HostedWorld("world1", "small", graph, 3, True)
    made.clients[Client(None, Outbox(made.state, most=1000))] = "places"
    return made


def state(hosted, form="places"):
    return json.loads(hosted.state(form))


def test_only_forms_that_somebody_wants_are_described(hosted):
    hosted.spawn("walker", (2.0, 3.0, 0.0), 0.5, "ada")
    assert hosted.state("world") is None and hosted.state("none") is None
    (ada,) = state(hosted)["agents"]
    assert ada == {
        "name": "ada",
        "status": "standing",
        "level": "physics",
        "posture": "stand",
        "holds": "",
        "position": [2.0, 3.0, 0.0],
        "facing": 0.5,
        "way": None,
    }
    hosted.join("local")
    hosted.join("world")
    local, world = (state(hosted, form)["agents"][0]["transforms"] for form in ("local", "world"))
    assert len(local) == 7 and local == world  # a walker has one body


def test_a_path_has_a_number_that_changes_with_it(hosted):
    ada = hosted.spawn("walker", (2.0, 3.0, 0.0), 0.0, "ada")
    numbers = []
    for x in (5.0, 5.0, 8.0):
        hosted.go_to("ada", [(x, 3.0, 0.0)], 1.0, None)
        for _ in range(2):
            hosted.step(0.01)
            numbers.append(state(hosted)["agents"][0]["way"])
    assert numbers[0] == numbers[1] and numbers[2] == numbers[3] and len(set(numbers)) == 3
    assert len(ada.driver.plans) == 1  # earlier ones are forgotten
    way = way_message(ada)
    assert way["smooth"][-1] == pytest.approx([8.0, 3.0, 0.0])


def test_what_is_saved_comes_back(hosted):
    with pytest.raises(RuntimeInputError, match="world 'world1' has not been saved"):
        hosted.restore()
    hosted.spawn("walker", (2.0, 3.0, 0.0), 0.0, "ada")
    saved = hosted.save()
    hosted.go_to("ada", [(8.0, 3.0, 0.0)], 1.0, None)
    hosted.step(0.5)
    assert state(hosted)["time"] == pytest.approx(0.5)
    assert hosted.restore() == saved and state(hosted)["time"] == 0.0


def test_an_agent_that_is_not_there_is_named_with_those_that_are(hosted):
    hosted.spawn("walker", (2.0, 3.0, 0.0), 0.0, "ada")
    for call in (hosted.stop, hosted.remove, lambda name: hosted.go_to(name, [(8.0, 3.0, 0.0)], 1.0, None)):
        with pytest.raises(RuntimeInputError, match="no agent 'tom' in world 'world1'; there are: ada"):
            call("tom")


def test_messages_hold_plain_values_of_the_level_and_the_figure(hosted, graph):
    ada = hosted.spawn("dog", (5.0, 3.0, 0.0), 0.0, "rex")
    for message in (skeleton(ada), mesh_message(graph.terrain), graph_message(graph)):
        assert json.loads(json.dumps(message, allow_nan=False)) == message
    assert np.array_equal(mesh_message(graph.terrain)["faces"], graph.terrain.faces)
    assert skeleton(ada)["bodies"] == list(ada.figure.bodies)
    assert way_message(ada) == {"raw": [], "pulled": [], "smooth": []}


def test_figures_of_other_simulators_are_told_of_and_count_for_nobody(graph):
    """One world at a time has the gateway, which exchanges after each step and is closed with its world."""

    class Gateway:
        def __init__(self, world):
            self.world, self.steps, self.closed = world, 0, False

        def exchange(self):
            self.steps += 1
            if self.steps == 2:
                motion = Motion.empty(1)
                motion.position[:] = (5.0, 3.0, 0.0)
                self.world.admit("remote", "dis:1:1:1", told_state("human", "", motion, 0.0))
            elif self.steps == 4:
                self.world.agents["dis:1:1:1"].remove()

        def close(self):
            self.closed = True

    worlds = Worlds(Limits(), set(), lambda client: None)
    worlds.gateway = Gateway
    for name in ("one", "two"):
        hosted = HostedWorld(name, "small", graph, 1, True)
        worlds.connect(hosted)
        worlds.hosted[name] = hosted
    one, two = worlds.hosted.values()
    assert one.gateway.world is one.world and two.gateway is None
    told = []
    for _ in range(5):
        one.step(0.1)
        come, gone = one.strangers()
        told.append(([agent.name for agent in come], sorted(gone)))
        assert one.spawned == {}
    assert told == [([], []), (["dis:1:1:1"], []), ([], []), ([], ["dis:1:1:1"]), ([], [])]
    gateway = one.gateway
    worlds.close(one)
    assert gateway.closed
