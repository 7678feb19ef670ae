"""The server: what clients can do, what they are told, and what it does not let them do."""

import asyncio
import json
import random
import urllib.error
import urllib.request

import numpy as np
import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from pathlib import Path

from pydantic import TypeAdapter
from serving import Client, serving
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from benchmarks.server_fuzz import malformed
from runtime import RuntimeInputError, World
from runtime.server import messages
from runtime.server.outbox import Outbox, TooSlow
from runtime.server.server import Limits, SurefootServer

ROOT = Path(__file__).resolve().parents[2]


def talk(graph, conversation, **options):
    """Run ``conversation(server, connect)`` against a server."""

    async def main():
        async with serving(graph, **options) as (server, port):

            async def join(hello=True, token=""):
                socket = await connect(f"ws://127.0.0.1:{port}", compression=None)
                client = Client(socket)
                if hello:
                    await client.ask("hello", version=1, token=token)
                return client

            return await conversation(server, join, port)

    return asyncio.run(asyncio.wait_for(main(), 240))


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


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"type": "spawn", "world": "x", "body": "dog", "at": [0, 0, 0]}, "no world 'x'"),
        ({"type": "create", "level": "large"}, "valid: small"),
        ({"type": "create"}, "create.level"),
        ({"type": "fly"}, "tag"),
        ({"type": "step", "world": "world1", "dt": -1}, "step.dt"),
        ({"type": "step", "world": "world1", "dt": 0.1}, "runs by itself"),
        ({"type": "spawn", "world": "world1", "body": "goose", "at": [2, 3, 0]}, "valid: 'human'"),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": [2, 3]}, "spawn.at"),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": [2, 3, 0], "size": 3}, "spawn.size"),
        ({"type": "go_to", "world": "world1", "agent": "ada", "points": [[2, 3, 0]]}, "no agent 'ada'"),
        ({"type": "restore", "world": "world1"}, "has not been saved"),
        ({"type": "hello", "version": 1}, "already"),
    ],
)
def test_refuses_and_says_why(graph, request_, says):
    async def conversation(server, join, port):
        client = await join()
        await client.ask("create", level="small")
        with pytest.raises(ValueError, match=says):
            fields = dict(request_)
            await client.ask(fields.pop("type"), **fields)
        await client.ask("level", level="small")

    talk(graph, conversation)


def test_lets_in_only_who_says_the_version_and_the_token(graph):
    async def conversation(server, join, port):
        for fields in ({"version": 2, "token": "s3cret"}, {"version": 1}, {"version": 1, "token": "secret"}):
            client = await join(hello=False)
            with pytest.raises(ValueError, match=r"version 2|wrong token"):
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


def test_limits_hold(graph):
    limits = Limits(message=2000, worlds=2, clients=2, agents=1, idle=0.5, greeting=0.3)

    async def conversation(server, join, port):
        client = await join()
        worlds = [(await client.ask("create", level="small"))["world"] for _ in range(2)]
        with pytest.raises(ValueError, match="2 worlds already"):
            await client.ask("create", level="small")
        await client.ask("spawn", world=worlds[0], body="dog", at=[2, 3, 0])
        with pytest.raises(ValueError, match="1 agents already"):
            await client.ask("spawn", world=worlds[0], body="dog", at=[4, 3, 0])
        mute = await join(hello=False)
        with pytest.raises(InvalidStatus):
            await join(hello=False)
        with pytest.raises(ConnectionClosed):
            await mute.hear()  # it did not say hello in time
        loud = await join()
        await loud.socket.send("x" * 3000)
        with pytest.raises(ConnectionClosed) as closed:
            await loud.hear()
        assert closed.value.rcvd.code == 1009
        await asyncio.sleep(0.7)
        await client.ask("leave", world=worlds[0])  # was silent, but hears of worlds
        await client.ask("leave", world=worlds[1])
        with pytest.raises(ConnectionClosed):
            while True:
                await client.hear()
        await asyncio.sleep(0.7)
        assert not server.worlds

    talk(graph, conversation, limits=limits)


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


def test_a_client_that_does_not_read_harms_nobody(graph):
    async def conversation(server, join, port):
        deaf, other = await join(), await join()
        world = (await deaf.ask("create", level="small", clock="manual", states="world"))["world"]
        await other.ask("join", world=world, states="places")
        await deaf.ask("spawn", world=world, body="human", at=[2, 3, 0], name="ada")
        for number in range(400):  # events that the deaf one does not read
            await other.ask("go_to", world=world, agent="ada", points=[[50, 3, 0]])
            await other.ask("step", world=world, dt=0.0 if number % 20 else 0.01)
        held = [client.outbox for client in server._clients]
        assert all(box._waiting <= server.limits.waiting for box in held)
        assert len(other.told) == 401
        return other.told

    talk(graph, conversation, limits=Limits(waiting=20_000))


def test_thousands_of_wrong_messages_change_nothing(graph):
    good = [
        {"type": "spawn", "id": 1, "world": "world1", "body": "dog", "at": [2, 3, 0], "facing": 0.1},
        {"type": "go_to", "id": 2, "world": "world1", "agent": "rex", "points": [[3, 3, 0]], "speed": 1},
        {"type": "join", "id": 3, "world": "world2", "states": "local"},
        {"type": "hello", "id": 4, "version": 1},
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


def test_pages_come_from_one_folder_only(graph, tmp_path):
    pages = tmp_path / "pages"
    pages.mkdir()
    (pages / "index.html").write_text("<p>here</p>")
    (tmp_path / "secret").write_text("no")

    def fetch(port, path):
        with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=20) as answer:
            return answer.read().decode(), answer.headers["Content-Type"]

    async def conversation(server, join, port):
        assert await asyncio.to_thread(fetch, port, "/") == ("<p>here</p>", "text/html")
        for path in ("/../secret", "/%2e%2e/secret", "/nothing", "/%00"):
            with pytest.raises(urllib.error.HTTPError) as error:
                await asyncio.to_thread(fetch, port, path)
            assert error.value.code == 404

    talk(graph, conversation, pages=pages)


def test_the_schema_in_the_docs_is_the_present_one(tmp_path):
    messages.write_schema(tmp_path / "schema.json")
    assert (tmp_path / "schema.json").read_text() == (ROOT / "docs" / "server.schema.json").read_text()
    TypeAdapter(messages.Answer).validate_python(
        {"type": "error", "seq": 1, "id": None, "code": "invalid", "message": "?"}
    )
