"""Worlds on the server: who has joined them, and when they end."""

import json

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from runtime import RuntimeInputError
from runtime.server.client import Client
from runtime.server.hosted import HostedWorld
from runtime.server.limits import Limits
from runtime.server.outbox import Outbox
from runtime.server.worlds import Worlds
from tests.runtime.server.serving import talk


def test_worlds_of_clients_that_leave_are_freed(graph):
    async def conversation(server, join, port):
        client, other = await join(), await join()
        worlds = [(await client.ask("create", level="small", clock=c))["world"] for c in ("real", "manual")]
        kept = (await client.ask("create", level="small"))["world"]
        await other.ask("join", world=kept)
        await client.ask("spawn", world=worlds[1], body="human", at=[2, 3, 0])
        await client.socket.send(json.dumps({"type": "step", "id": 99, "world": worlds[1], "dt": 1.0}))
        await client.socket.close()  # in the middle of it
        while list(server.worlds) != [kept]:
            await other.hear()  # its own world goes on
        assert server.worlds[kept].owner is next(iter(server._clients))

    talk(graph, conversation, limits=Limits(deserted=0.0))


def client():
    return Client(None, Outbox(lambda world: None, most=10_000))


@pytest.fixture
def place(graph):
    """Worlds for two clients, one of which is in the only one."""
    clients = [client(), client()]
    worlds = Worlds(Limits(worlds=1, agents=2, deserted=1e9), clients, lambda one: None)
    hosted = HostedWorld(worlds.new_name(), "small", graph, 1, True)
    worlds.hosted[hosted.name] = hosted
    worlds.join(clients[0], hosted, "none")
    return worlds, hosted, clients


def test_a_world_is_known_by_name_to_those_who_joined_it(place):
    worlds, hosted, (first, second) = place
    assert worlds.joined(first, "world1") is hosted is worlds.named("world1")
    with pytest.raises(RuntimeInputError, match="you have not joined world 'world1'; join it first"):
        worlds.joined(second, "world1")
    with pytest.raises(RuntimeInputError, match="no world 'world2'; there are: world1"):
        worlds.named("world2")
    assert worlds.new_name() == "world2"


def test_who_has_been_there_longest_answers_for_it(place):
    worlds, hosted, (first, second) = place
    worlds.join(second, hosted, "none")
    hosted.spawned["ada"] = first
    assert hosted.owner is first
    assert worlds.leave(first, hosted) and not worlds.leave(first, hosted)
    assert hosted.owner is second and hosted.spawned == {"ada": second}
    with pytest.raises(RuntimeInputError, match="you have 1 worlds already"):
        worlds.check_world(second)
    worlds.check_world(first)


def test_agents_are_counted_by_who_made_them(place):
    worlds, hosted, (first, second) = place
    for name in ("ada", "tom"):
        hosted.world.spawn("walker", (2.0 + len(hosted.world.agents), 3.0, 0.0), name=name)
        hosted.spawned[name] = first
    with pytest.raises(RuntimeInputError, match="you have 2 agents already"):
        worlds.check_agents(first, 1)
    worlds.check_agents(second, 2)
    with pytest.raises(RuntimeInputError, match="there are 2 agents already in the world"):
        worlds.check_room(hosted)


def test_deserted_worlds_end_after_a_while_and_members_are_told_of_an_end(place):
    worlds, hosted, (first, _) = place
    worlds.close_deserted()
    assert not hosted.closed
    worlds.leave(first, hosted)
    worlds.close_deserted()
    assert not hosted.closed  # not yet
    worlds.join(first, hosted, "none")
    worlds.close(hosted)
    assert hosted.closed and worlds.hosted == {}
    worlds.leave(first, hosted)
    worlds.join(first, hosted, "none")  # too late
    assert first not in hosted.clients
