"""A client that floods its connection, or does not read, loses it; nobody else does."""

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from websockets.exceptions import ConnectionClosed

from runtime.server.connection import connection_with
from runtime.server.limits import Limits
from tests.runtime.server.serving import talk


def test_a_flood_of_pings_ends_the_connection_and_not_the_server(graph):
    async def conversation(server, join, port):
        other, bad = await join(), await join()
        world = (await other.ask("create", level="small", clock="manual"))["world"]
        for _ in range(1000):
            await bad.socket.ping()
        with pytest.raises(ConnectionClosed):
            await bad.hear()
        while len(server._clients) > 1:
            assert (await other.ask("step", world=world, dt=0.01))["ticks"] == 1
        polite = await join()
        for _ in range(5):
            await (await polite.socket.ping())
        await polite.ask("level", level="small")

    talk(graph, conversation)


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


class Written:
    """A transport to a client that reads nothing of what is written."""

    max_size, aborted, waiting = 0, False, 0

    def get_write_buffer_size(self):
        return self.waiting

    def abort(self):
        self.aborted = True


def test_replies_that_wait_for_too_long_a_reader_end_the_connection(monkeypatch):
    kind = connection_with(Limits(waiting=100))
    monkeypatch.setattr(kind.__base__, "data_received", lambda self, data: None)
    connection = kind.__new__(kind)
    connection.transport = Written()
    for waiting, aborted in ((100, False), (101, True)):
        connection.transport.waiting = waiting
        connection.data_received(b"")
        assert connection.transport.aborted == aborted
