"""What is told of levels, and worlds made of them: open ones are loaded around players."""

import asyncio

import numpy as np
import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from runtime import RuntimeInputError
from runtime.server.levels import Levels
from runtime.views.served import ServedWorld
from tests.runtime.server.serving import talk
from tests.runtime.strip import END, START, strip

NEAR = ["00", "01", "02"]


async def steps(client, world, seconds):
    for _ in range(round(seconds / 0.5)):
        await client.ask("step", world=world, dt=0.5)


def loaded(client, before):
    """The chunks that are loaded by what was told since ``before`` were."""
    now = set(before)
    for message in client.told:
        if message["type"] == "chunks":
            assert now.isdisjoint(message["loaded"]) and set(message["dropped"]) <= now
            now = (now | set(message["loaded"])) - set(message["dropped"])
    return now


def test_an_agent_crosses_an_open_world_and_clients_are_told_what_is_loaded():
    async def conversation(server, join, port):
        client, other = await join(), await join()
        made = await client.ask("create", level="small", clock="manual", around=[START])
        world, hosted = made["world"], server.worlds[made["world"]]
        assert made["loaded"] == NEAR
        await client.ask("spawn", world=world, body="walker", at=START, name="ada")
        await client.ask("players", world=world, players=["ada"])
        assert await client.ask("go_to", world=world, agent="ada", points=[END], speed=5.0) == {
            "status": "walking"
        }
        await steps(client, world, 12.0)
        late = await other.ask("join", world=world)
        assert late["loaded"] == sorted(loaded(client, NEAR)) == list(hosted.world.loaded) != NEAR
        chunk = await other.ask("chunk", level="small", chunk=late["loaded"][0])
        assert np.ptp(np.array(chunk["vertices"]), axis=0) == pytest.approx([10.0, 10.0, 0.0])
        await steps(client, world, 16.0)
        await other.ask("join", world=world)
        assert hosted.agent("ada").status == "arrived"
        assert loaded(client, NEAR) == loaded(other, late["loaded"]) == set(hosted.world.loaded)

    talk(strip(), conversation)


def test_each_client_says_who_its_players_are_until_it_leaves():
    async def conversation(server, join, port):
        one, two = await join(), await join()
        world = (await one.ask("create", level="small", clock="manual", around=[START]))["world"]
        hosted = server.worlds[world]
        await two.ask("join", world=world)
        await two.ask("players", world=world, players=[END, [60, 5, 0]])
        await steps(one, world, 6.0)
        assert {"00", "06", "11"} <= set(hosted.world.loaded)
        with pytest.raises(ValueError, match=r"no agent 'ada' in world 'world1'; there are: none"):
            await one.ask("players", world=world, players=["ada"])
        await one.ask("spawn", world=world, body="walker", at=END, name="ada")
        await one.ask("players", world=world, players=["ada"])
        await two.ask("leave", world=world)
        await steps(one, world, 6.0)
        assert hosted.world.players == (hosted.agent("ada"),)
        assert {"09", "10", "11"} <= set(hosted.world.loaded) <= {"08", "09", "10", "11"}
        await one.ask("remove", world=world, agent="ada")
        assert hosted.world.players == ()
        await one.ask("players", world=world, players=[START])
        with pytest.raises(ValueError, match=r"is not loaded; .* let a player be there"):
            await one.ask("spawn", world=world, body="walker", at=START)

    talk(strip(), conversation)


def test_a_spectator_sees_the_chunks_that_are_loaded():
    async def conversation(server, join, port):
        client = await join()
        world = (await client.ask("create", level="small", clock="manual", around=[START]))["world"]
        await client.ask("spawn", world=world, body="walker", at=START, name="ada")
        watched = await asyncio.to_thread(ServedWorld, f"ws://127.0.0.1:{port}")
        assert np.ptp(watched.level.vertices[:, 0]) == pytest.approx(30.0)
        await client.ask("players", world=world, players=[START, END])
        await steps(client, world, 5.0)
        while (await asyncio.to_thread(watched.moment)).level.vertices[:, 0].max() < 119.0:
            await steps(client, world, 0.5)
        assert len(watched.level.faces) == 2 * len(server.worlds[world].world.loaded)
        watched.close()

    talk(strip(), conversation)


def test_what_does_not_fit_a_level_is_refused(graph):
    levels = Levels({"strip": strip(), "small": graph})
    assert list(levels) == ["strip", "small"]
    for ask, says in (
        (lambda: levels.mesh("no"), "no level 'no'; valid: strip, small"),
        (lambda: levels.mesh("strip"), "is an open world; ask for its chunks"),
        (lambda: levels.graph("strip"), "is an open world"),
        (lambda: levels.chunk("small", "00"), "is loaded as a whole; ask for its mesh"),
        (lambda: levels.start("strip", []), "say around which places"),
        (lambda: levels.start("small", [START]), "loaded as a whole; leave out around"),
        (lambda: levels.start("strip", [(0.0, 900.0, 0.0)]), "nothing to walk on around"),
    ):
        with pytest.raises(RuntimeInputError, match=says):
            ask()
    with pytest.raises(ValueError, match="there is no chunk 'no'"):
        levels.chunk("strip", "no")
    assert levels.start("small", []) is graph
