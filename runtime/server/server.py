"""The server: connections, the clock, and disconnecting clients.

Everything runs in one event loop. Long work is done in pieces, see `runtime.server.turns`; worlds with a real
clock advance in between.
"""

import asyncio
import hmac
import ipaddress
import json
import logging
import re
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed

import navmesh
from runtime.dis.gateway import Gateway
from runtime.errors import RuntimeInputError
from runtime.server import messages as m
from runtime.server.client import Client
from runtime.server.connection import connection_with
from runtime.server.hosted import HostedWorld
from runtime.server.levels import Levels
from runtime.server.limits import Limits
from runtime.server.logs import sparing
from runtime.server.outbox import Outbox
from runtime.server.pages import page_of
from runtime.server.requests import Requests
from runtime.server.turns import Turns
from runtime.server.worlds import Worlds
from runtime.world.world import World

__all__ = ["Limits", "SurefootServer"]

_log = logging.getLogger("surefoot.serve")
_connection_log = logging.getLogger("surefoot.serve.connections")
_connection_log.setLevel(logging.CRITICAL)  # invalid messages do not deserve a traceback
_FRAME = 1 / 60  # [s] between steps of worlds with a real clock
_LONGEST = 0.1  # [s] most that such a world catches up at once


class SurefootServer:
    """Worlds on ``levels`` (graphs and open worlds by name) for clients that connect to ``host``:``port``.

    ``token``: secret in `messages.Hello`; required unless ``host`` is the loopback, else `RuntimeInputError`.
    ``pages``: a folder whose files are served over HTTP. ``gateway`` makes the one to other simulators
    (`runtime.dis`); one world at a time has it, the first that a client creates.
    """

    def __init__(
        self,
        levels: Mapping[str, navmesh.NodeGraph | navmesh.OpenWorld],
        host: str = "127.0.0.1",
        port: int = 8765,
        token: str = "",
        pages: Path | None = None,
        limits: Limits | None = None,
        gateway: Callable[[World], Gateway] | None = None,
    ) -> None:
        if not _is_loopback(host) and not token:
            raise RuntimeInputError(
                f"host {host!r} can be reached from other machines: give a token, or use 127.0.0.1"
            )
        self.levels, self.host, self.port, self.limits = Levels(levels), host, port, limits or Limits()
        self.turns = Turns()
        self._token, self._pages = token, pages
        self._clients: set[Client] = set()
        self._worlds = Worlds(self.limits, self._clients, self._dismiss_slow)
        self._worlds.gateway = gateway
        self._requests = Requests(self.levels, self._worlds, self.turns)
        self._tasks: set[asyncio.Future[None]] = set()

    @property
    def worlds(self) -> dict[str, HostedWorld]:
        """By name."""
        return self._worlds.hosted

    async def run(self, ready: Callable[[int], None] = lambda port: None) -> None:
        """Serve until cancelled; ``ready`` is called with the port once clients can connect."""
        with sparing():
            turns = asyncio.ensure_future(self.turns.go_round())
            try:
                async with serve(
                    self._connected,
                    self.host,
                    self.port,
                    max_size=self.limits.message,
                    max_queue=4,
                    compression=None,
                    process_request=self._page,
                    origins=[None, re.compile(r"https?://(127\.0\.0\.1|localhost|\[::1\])(:\d+)?")]
                    if not self._token
                    else None,
                    server_header=None,
                    logger=_connection_log,
                    create_connection=connection_with(self.limits),
                ) as server:
                    ready(_port_of(server))
                    await self._keep_time()
            finally:
                turns.cancel()
                await asyncio.gather(turns, *self._tasks, return_exceptions=True)

    def _page(self, connection: ServerConnection, request: Any) -> Any:
        if "Upgrade" in request.headers:
            if len(self._clients) >= self.limits.clients:
                return connection.respond(503, f"there are {self.limits.clients} clients already\n")
            return None
        return page_of(connection, request.path, self._pages)

    def _do(self, task: Any) -> None:
        """Do something meanwhile."""
        future = asyncio.ensure_future(task)
        self._tasks.add(future)
        future.add_done_callback(self._tasks.discard)

    # --- time
    async def _keep_time(self) -> None:
        due = time.monotonic()
        while True:
            due = max(due + _FRAME, time.monotonic())
            await asyncio.sleep(due - time.monotonic())
            for hosted in tuple(self.worlds.values()):
                if not hosted.manual and not hosted.at_work and hosted.owner is not None:
                    hosted.at_work = True
                    self._do(self._advance(hosted, hosted.owner))
            self._send_away(time.monotonic())

    async def _advance(self, hosted: HostedWorld, owner: Client) -> None:
        def passed() -> float:
            now = time.monotonic()
            dt, hosted.since = min(now - hosted.since, _LONGEST), now
            return dt

        try:
            await self._requests.advance(hosted, owner, passed)
        except RuntimeInputError:
            pass  # it has been closed
        except Exception:
            _log.exception("world %s is closed", hosted.name)
            self._worlds.close(hosted)
        finally:
            hosted.at_work = False

    def _send_away(self, now: float) -> None:
        busy = {client for hosted in self.worlds.values() for client in hosted.clients}
        for client in self._clients - busy:
            if now - client.heard > self.limits.idle:
                self._dismiss(client, 1001, "was silent for too long")
        self._worlds.close_deserted()

    def _dismiss_slow(self, client: Client) -> None:
        self._dismiss(client, 1013, "does not read what it is sent")

    def _dismiss(self, client: Client, code: int, why: str) -> None:
        """Disconnect a client without waiting for it."""
        if client in self._clients:
            self._forget(client)
            self._do(_closed(client.connection, code, why))

    # --- connections
    async def _connected(self, connection: ServerConnection) -> None:
        if len(self._clients) >= self.limits.clients:  # several were greeted at once
            await connection.close(1013, "too many clients")
            return
        client = Client(
            connection, Outbox(lambda world: self._worlds.state(client, world), self.limits.waiting)
        )
        self._clients.add(client)
        writer, watch = (asyncio.ensure_future(each) for each in (self._write(client), self._watch(client)))
        try:
            if await self._greet(client):
                async for text in connection:
                    if client not in self._clients:
                        break
                    client.heard = time.monotonic()
                    await self._answer(client, text)
                    await client.outbox.room()
                    await asyncio.sleep(0)
        except (ConnectionClosed, TimeoutError):
            pass
        finally:
            self._forget(client)
            for task in (writer, watch):
                task.cancel()
                with suppress(asyncio.CancelledError, ConnectionClosed):
                    await task

    async def _greet(self, client: Client) -> bool:
        """Check version and token of the first message."""
        text = await asyncio.wait_for(client.connection.recv(), self.limits.greeting)
        number, refusal = _id_in(text), None
        try:
            hello = _parsed(text)
            if not isinstance(hello, m.Hello):
                refusal = "the first message must be a hello"
            elif hello.version != m.PROTOCOL:
                refusal = f"version {hello.version}: this server speaks version {m.PROTOCOL}"
            elif not hmac.compare_digest(hello.token.encode(), self._token.encode()):
                refusal = "wrong token"
        except RuntimeInputError as error:
            refusal = str(error)
        if refusal is not None:
            await client.connection.send(
                m.Error(type="error", seq=1, id=number, code="refused", message=refusal).model_dump_json()
            )
            await client.connection.close(1008, "refused")
            return False
        result = {"version": m.PROTOCOL, "levels": list(self.levels), "worlds": list(self.worlds)}
        self._worlds.put(client, {"type": "reply", "id": number, "result": result})
        return True

    async def _write(self, client: Client) -> None:
        with suppress(ConnectionClosed):
            while True:
                await client.connection.send(await client.outbox.take(), text=True)

    async def _watch(self, client: Client) -> None:
        """Notice that a client is gone, even while its request is handled."""
        await client.connection.wait_closed()
        self._forget(client)
        client.outbox.end()

    def _forget(self, client: Client) -> None:
        self._clients.discard(client)
        for hosted in self.worlds.values():
            self._worlds.leave(client, hosted)

    async def _answer(self, client: Client, text: str | bytes) -> None:
        number, code = None, "invalid"
        try:
            request = _parsed(text)
            number, code = request.id, "refused"
            result = await self._requests.result(client, request)
        except (RuntimeInputError, ValueError) as error:
            number = _id_in(text) if number is None else number
            self._worlds.put(client, {"type": "error", "id": number, "code": code, "message": str(error)})
        except Exception:
            _log.exception("a request failed")
            self._worlds.put(
                client, {"type": "error", "id": number, "code": "internal", "message": "see the log"}
            )
        else:
            reply = {"type": "reply", "id": number}
            if isinstance(result, bytes):
                self._worlds.put(client, reply, result)
            else:
                self._worlds.put(client, {**reply, "result": result})


async def _closed(connection: ServerConnection, code: int, why: str) -> None:
    with suppress(Exception):
        await connection.close(code, why)


def _parsed(text: str | bytes) -> Any:
    """The request in a message; raises `RuntimeInputError` that says where it is wrong."""
    if isinstance(text, bytes):
        raise RuntimeInputError("expected a text message with a JSON object, not a binary one")
    try:
        return m.REQUEST.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "message"
        raise RuntimeInputError(f"{where}: {first['msg']}"[:400]) from None


def _id_in(text: str | bytes) -> int | None:
    """The id for the answer, None if the message has no valid one."""
    try:
        number = json.loads(text)["id"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return number if type(number) is int and 0 <= number < 2**53 else None


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _port_of(server: Server) -> int:
    return next(iter(server.sockets)).getsockname()[1]
