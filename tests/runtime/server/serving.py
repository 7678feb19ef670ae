"""A server in the test's own event loop, and clients that talk to it."""

import asyncio
import json
from contextlib import asynccontextmanager

from websockets.asyncio.client import connect

from runtime.server.server import SurefootServer
from runtime.warmup import load_kernels


@asynccontextmanager
async def serving(graph, **options):
    """A server on a free port; yields its port."""
    load_kernels()  # as the command does: nobody's first step may take as long as compiling
    server = SurefootServer({"small": graph}, port=0, **options)
    ready = asyncio.get_running_loop().create_future()
    task = asyncio.ensure_future(server.run(ready.set_result))
    await asyncio.wait([task, ready], return_when=asyncio.FIRST_COMPLETED)
    try:
        yield server, ready.result()
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


class Client:
    """Asks and keeps what it is told besides. ``states``: the last of each world; ``events``: in order."""

    def __init__(self, socket):
        self.socket, self.states, self.told, self._seq, self._id = socket, {}, [], 0, 0

    async def ask(self, type, **fields):
        """The reply's result; the error's message as ValueError."""
        self._id += 1
        await self.socket.send(json.dumps({"type": type, "id": self._id, **fields}))
        while True:
            message = await self.hear()
            if message.get("id") == self._id:
                if message["type"] == "error":
                    raise ValueError(message["message"])
                return message["result"]

    async def hear(self):
        """The next message; checks that none in order is missing."""
        message = json.loads(await asyncio.wait_for(self.socket.recv(), 60))
        if message["type"] == "state":
            self.states[message["world"]] = message
        else:
            self._seq += 1
            assert message["seq"] == self._seq
            if message["type"] not in ("reply", "error"):
                self.told.append(message)
        return message


def talk(graph, conversation, **options):
    """Run ``conversation(server, connect)`` against a server."""

    async def main():
        async with serving(graph, **options) as (server, port):

            async def join(hello=True, token=""):
                socket = await connect(f"ws://127.0.0.1:{port}", compression=None)
                client = Client(socket)
                if hello:
                    await client.ask("hello", version=2, token=token)
                return client

            return await conversation(server, join, port)

    return asyncio.run(asyncio.wait_for(main(), 240))
