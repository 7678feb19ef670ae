"""What one client may use, so that enough is left for the others."""

import asyncio

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from websockets.exceptions import ConnectionClosed, InvalidStatus

from runtime import RuntimeInputError
from runtime.server.limits import Limits
from tests.runtime.server.serving import talk


def test_limits_hold(graph):
    limits = Limits(message=2000, worlds=2, clients=2, agents=1, idle=0.5, deserted=0.1, greeting=0.3)

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


FEW = Limits(worlds=4, all_worlds=8, agents=10, all_agents=12)


@pytest.mark.parametrize(
    ("what", "own", "more", "total", "clients"),
    [
        ("worlds", 3, 1, 3, 1),  # its last one
        ("worlds", 3, 1, 7, 9),  # the server's last one
        ("worlds", 1, 1, 8, 4),  # the server is full, but its share is 2
        ("agents", 2, 8, 2, 1),
        ("agents", 0, 1, 12, 0),
    ],
)
def test_there_is_room_up_to_the_last_one(what, own, more, total, clients):
    FEW.check_share(what, own, more, total, clients)


@pytest.mark.parametrize(
    ("what", "own", "more", "total", "clients", "says"),
    [
        ("worlds", 4, 1, 4, 1, "you have 4 worlds already, of at most 4; remove one"),
        ("worlds", 2, 1, 8, 4, "has 8 worlds already, of at most 8; you have 2, and your share is 2"),
        ("agents", 3, 8, 3, 1, "you have 3 agents already, of at most 10"),
        ("agents", 6, 1, 12, 2, "you have 6, and your share is 6"),
    ],
)
def test_beyond_the_last_one_nobody_gets_more_than_a_share(what, own, more, total, clients, says):
    with pytest.raises(RuntimeInputError, match=says):
        FEW.check_share(what, own, more, total, clients)
