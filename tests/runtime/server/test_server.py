"""The server: what clients can do, what they are told, and what it does not let them do."""

import asyncio
import json
import random

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from itertools import count
from pathlib import Path

from pydantic import TypeAdapter
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from benchmarks.server_fuzz import malformed
from runtime import RuntimeInputError
from runtime.server import messages
from runtime.server.outbox import Outbox, TooSlow
from runtime.server.server import Limits, SurefootServer
from tests.runtime.server.serving import talk

ROOT = Path(__file__).resolve().parents[3]


def test_all_who_joined_hear_of_a_world_that_runs_by_itself(graph):
    async def conversation(server, join, port):
        first, second, stranger = await join(), await join(), await join()
        world = (await first.ask("create", level="small"))["world"]
        assert (await second.ask("join", world=world, states="none"))["agents"] == []
        await first.ask("spawn", world=world, body="dog", at=[2, 3, 0], name="rex")
        await first.ask("go_to", world=world, agent="rex", points=[[3.5, 3, 0]])
        for client in (first, second):
            while not any(m["type"] == "event" and m["event"]["kind"] == "Arrived" for m in client.told):
                await client.hear()
        assert first.told == [{**m, "seq": n["seq"]} for m, n in zip(second.told, first.told, strict=True)]
        assert first.states[world]["agents"][0]["name"] == "rex" and not second.states
        await second.ask("close", world=world)
        while first.told[-1]["type"] != "gone":
            await first.hear()
        assert not stranger.told and not server.worlds

    talk(graph, conversation)


def test_lets_in_only_who_says_the_version_and_the_token(graph):
    async def conversation(server, join, port):
        for fields in ({"version": 1, "token": "s3cret"}, {"version": 2}, {"version": 2, "token": "secret"}):
            client = await join(hello=False)
            with pytest.raises(ValueError, match=r"version 1|wrong token"):
                await client.ask("hello", **fields)
            with pytest.raises(ConnectionClosed):
                await client.hear()
        client = await join(hello=False)
        with pytest.raises(ValueError, match="must be a hello"):
            await client.ask("create", level="small")
        await join(token="s3cret")

    talk(graph, conversation, token="s3cret")


def test_other_machines_and_other_sites_are_kept_out(graph):
    with pytest.raises(RuntimeInputError, match="give a token"):
        SurefootServer({"small": graph}, host="0.0.0.0")
    SurefootServer({"small": graph}, host="0.0.0.0", token="x")
    SurefootServer({"small": graph}, host="::1")

    async def conversation(server, join, port):
        with pytest.raises(InvalidStatus):
            await connect(f"ws://127.0.0.1:{port}", origin="https://evil.example")
        async with connect(f"ws://127.0.0.1:{port}", origin=f"http://localhost:{port}"):
            pass

    talk(graph, conversation)


def test_an_outbox_keeps_order_and_only_the_newest_state():
    async def main():
        states = {"w": b"old"}
        box = Outbox(states.get, most=1000)
        for number in range(3):
            box.put({"n": number})
            box.mark("w")
        states["w"] = b"new"
        taken = [await box.take() for _ in range(4)]
        assert [json.loads(text) for text in taken[:3]] == [{"n": n, "seq": n + 1} for n in range(3)]
        assert taken[3] == b"new"
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(box.take(), 0.01)
        with pytest.raises(TooSlow):
            for _ in range(100):
                box.put({"text": "x" * 50})

    asyncio.run(main())


def test_who_goes_without_reading_leaves_nothing_behind(graph):
    async def conversation(server, join, port):
        before = len(asyncio.all_tasks())
        rude = await join()
        (client,) = server._clients
        client.outbox._room.clear()  # so much waits that it is not listened to any more
        await rude.socket.send(json.dumps({"type": "level", "id": 1, "level": "small"}))
        await rude.hear()
        rude.socket.transport.abort()
        while server._clients or len(asyncio.all_tasks()) > before:
            await asyncio.sleep(0)
        client.outbox.put({"type": "event"})
        assert not client.outbox._ordered

    talk(graph, conversation)


def test_thousands_of_wrong_messages_change_nothing(graph):
    good = [
        {"type": "spawn", "id": 1, "world": "world1", "body": "dog", "at": [2, 3, 0], "facing": 0.1},
        {"type": "go_to", "id": 2, "world": "world1", "agent": "rex", "points": [[3, 3, 0]], "speed": 1},
        {"type": "join", "id": 3, "world": "world2", "states": "local"},
        {"type": "hello", "id": 4, "version": 2},
        {"type": "level", "id": 5, "level": "small"},
    ]

    async def conversation(server, join, port):
        rng = random.Random(7)
        other, bad = await join(), await join()
        world = (await other.ask("create", level="small", clock="manual"))["world"]
        reader = asyncio.ensure_future(_answers(bad.socket, 3000))
        for number in range(3000):
            await bad.socket.send(malformed(rng, good))
            if number % 300 == 0:
                assert (await other.ask("step", world=world, dt=0.01))["ticks"] == 1
        await reader
        assert (await other.ask("step", world=world, dt=0.01))["ticks"] == 1
        assert list(server.worlds) == [world]

    talk(graph, conversation)


async def _answers(socket, wanted):
    """Returns when there has been an answer to each of so many messages."""
    while wanted:
        wanted -= json.loads(await socket.recv())["type"] in ("error", "reply")


def test_one_client_takes_no_more_than_its_share(graph):
    """Two clients: where worlds or agents get scarce, each may have half of them."""
    limits = Limits(worlds=5, agents=6, all_worlds=4, all_agents=6)

    async def conversation(server, join, port):
        greedy, late = await join(), await join()

        async def create(client):
            return (await client.ask("create", level="small", clock="manual", states="none"))["world"]

        def spawn(client, world, number):
            return client.ask("spawn", world=world, body="walker", at=[1 + 1.5 * number, 3, 0])

        worlds = [await create(greedy) for _ in range(4)]
        with pytest.raises(
            ValueError, match="4 worlds already, of at most 4; you have 4, and your share is 2"
        ):
            await create(greedy)
        own = [await create(late) for _ in range(2)]
        with pytest.raises(
            ValueError, match="6 worlds already, of at most 4; you have 2, and your share is 2"
        ):
            await create(late)
        for number in range(6):
            await spawn(greedy, worlds[number % 2], number)
        with pytest.raises(ValueError, match="6 agents already, of at most 6; remove one"):
            await spawn(greedy, worlds[2], 0)
        await spawn(late, own[0], 0)
        await greedy.ask("save", world=worlds[0])
        for name in tuple(server.worlds[worlds[0]].world.agents):
            await greedy.ask("remove", world=worlds[0], agent=name)
        for number in range(1, 3):
            await spawn(late, own[0], number)
        with pytest.raises(
            ValueError, match="6 agents already, of at most 6; you have 3, and your share is 3"
        ):
            await greedy.ask("restore", world=worlds[0])
        await greedy.socket.close()
        while len(server._clients) > 1:
            await late.ask("step", world=own[0], dt=0.0)
        for _ in range(2):  # what is deserted makes room
            own.append(await create(late))
        assert list(server.worlds) == own

    talk(graph, conversation, limits=limits)


@pytest.mark.parametrize("people", [2, 12])
def test_others_wait_for_one_piece_of_a_long_step_however_many_are_in_it(graph, people):
    """Counted in pieces of work, of which each turn is one here: between two answers to a client, hardly more
    is done of what another asks for than of what it asks for itself."""

    async def conversation(server, join, port):
        heavy, light, ticks = await join(), await join(), count()
        server.turns._clock = lambda: float(next(ticks))
        big = (await heavy.ask("create", level="small", clock="manual", states="none"))["world"]
        small = (await light.ask("create", level="small", clock="manual", states="none"))["world"]
        for number in range(people):
            at = [1 + 1.5 * (number % 6), 1 + 3 * (number // 6), 0]
            await heavy.ask("spawn", world=big, body="human", at=at, name=f"p{number}")
            await heavy.ask("go_to", world=big, agent=f"p{number}", points=[[9, 3, 0]], speed=1.2)
        alone = -server.turns.pieces
        await light.ask("step", world=small, dt=0.01)
        alone += server.turns.pieces
        step = asyncio.ensure_future(heavy.ask("step", world=big, dt=1.0))
        while not server.worlds[big].lock.locked():
            await asyncio.sleep(0)
        done = []
        while not step.done() and len(done) < 40:
            before = server.turns.pieces
            await light.ask("step", world=small, dt=0.01)
            done.append(server.turns.pieces - before)
        assert (await step)["ticks"] == 100
        return alone, done

    alone, done = talk(graph, conversation)
    assert len(done) == 40
    assert max(done) <= 3 * alone


def test_large_answers_are_kept_once_and_sent_in_pieces():
    async def main():
        box = Outbox(lambda world: None, most=1000)
        level = b'{"vertices":"%b"}' % (b"x" * 200_000)
        for number in range(3):
            box.put({"type": "reply", "id": number}, level)
            box.put({"type": "event"})
        for number in range(3):
            pieces = [bytes(each) for each in await box.take()]
            assert max(map(len, pieces)) <= 65536
            said = json.loads(b"".join(pieces))
            assert said == {
                "type": "reply", "id": number, "result": {"vertices": "x" * 200_000}, "seq": 2 * number + 1
            }  # fmt: skip
            assert json.loads(await box.take())["seq"] == 2 * number + 2
        assert box._waiting == 0

    asyncio.run(main())


def test_it_ends_without_a_word_when_it_is_told_to(tmp_path):
    """Also in the middle of a long step."""
    from benchmarks.server_fuzz import FLOOR, greeted, serving

    (tmp_path / "floor.obj").write_text(FLOOR)

    async def busy(address, server):
        client = await greeted(address)
        made = await client.ask("create", level="floor", clock="manual", states="none")
        world = made["result"]["world"]
        await client.ask("spawn", world=world, body="human", at=[5, 3, 0])
        for number in range(3):
            await client.socket.send(json.dumps({"type": "step", "id": number, "world": world, "dt": 1.0}))
        server.terminate()
        return await asyncio.to_thread(server.wait, 60)

    with serving(tmp_path / "floor.obj", log=tmp_path / "log") as (address, server):
        assert asyncio.run(busy(address, server)) == 143
    assert "Traceback" not in (tmp_path / "log").read_text()


def test_the_schema_in_the_docs_is_the_present_one(tmp_path):
    messages.write_schema(tmp_path / "schema.json")
    committed = ROOT / "docs" / "reference" / "server.schema.json"
    assert (tmp_path / "schema.json").read_text() == committed.read_text()
    TypeAdapter(messages.Answer).validate_python(
        {"type": "error", "seq": 1, "id": None, "code": "invalid", "message": "?"}
    )
