"""The server: connections, worlds, the clock, and the limits that keep clients from harming each other.

Everything happens in one thread, one request at a time; worlds with a real clock are advanced in between.
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
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed

import navmesh
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.server import messages as m
from runtime.server.hosted import HostedWorld, graph_message, level_message, skeleton, way_message
from runtime.server.outbox import Outbox, TooSlow
from runtime.server.pages import page_of

__all__ = ["Limits", "SurefootServer"]

_log = logging.getLogger("surefoot.serve")
_connection_log = logging.getLogger("surefoot.serve.connections")
_connection_log.setLevel(logging.CRITICAL)  # what strangers send is not worth a traceback
_FRAME = 1 / 60  # [s] between steps of worlds with a real clock
_LONGEST = 0.1  # [s] that such a world makes up for at once


@dataclass(frozen=True)
class Limits:
    """``message`` [bytes] of a request; ``worlds``, ``clients`` at a time, ``agents`` in a world; ``waiting``
    [bytes] of replies and events that a client may leave unread; ``idle`` [s] after which a client that
    is silent and hears of no world is sent away, and a world without clients is closed; ``greeting`` [s] for
    the first message."""

    message: int = 65536
    worlds: int = 64
    clients: int = 128
    agents: int = 256
    waiting: int = 8_000_000
    idle: float = 300.0
    greeting: float = 10.0


class _Client:
    def __init__(
        self, connection: ServerConnection, newest: Callable[["_Client", str], bytes | None], most: int
    ):
        self.connection = connection
        self.outbox = Outbox(lambda world: newest(self, world), most)
        self.heard = time.monotonic()


class SurefootServer:
    """Worlds on ``levels`` (graphs by name) for clients that connect to ``host``:``port``.

    ``token``: what clients must say in `messages.Hello`; needed when ``host`` is not the loopback. ``pages``:
    a folder whose files are served over HTTP. Raises `RuntimeInputError` for such a host without a token.
    """

    def __init__(
        self,
        levels: Mapping[str, navmesh.NodeGraph],
        host: str = "127.0.0.1",
        port: int = 8765,
        token: str = "",
        pages: Path | None = None,
        limits: Limits | None = None,
    ) -> None:
        if not _is_loopback(host) and not token:
            raise RuntimeInputError(
                f"host {host!r} can be reached from other machines: give a token, or use 127.0.0.1"
            )
        self.levels, self.host, self.port, self.limits = dict(levels), host, port, limits or Limits()
        self.worlds: dict[str, HostedWorld] = {}
        self._token, self._pages = token, pages
        self._clients: set[_Client] = set()
        self._numbers = count(1)
        self._deserted: dict[str, float] = {}

    async def run(self, ready: Callable[[int], None] = lambda port: None) -> None:
        """Serve until cancelled; ``ready`` is called with the port once clients can connect."""
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
        ) as server:
            ready(_port_of(server))
            await self._keep_time()

    def _page(self, connection: ServerConnection, request: Any) -> Any:
        if "Upgrade" in request.headers:
            if len(self._clients) >= self.limits.clients:
                return connection.respond(503, f"there are {self.limits.clients} clients already\n")
            return None
        return page_of(connection, request.path, self._pages)

    # --- time
    async def _keep_time(self) -> None:
        before = time.monotonic()
        while True:
            await asyncio.sleep(max(before + _FRAME - time.monotonic(), 0.0))
            now = time.monotonic()
            for hosted in tuple(self.worlds.values()):
                if not hosted.manual:
                    self._advance(hosted, min(now - before, _LONGEST))
                    await asyncio.sleep(0)
            before = now
            self._send_away(now)

    def _advance(self, hosted: HostedWorld, dt: float) -> None:
        try:
            hosted.world.step(dt)
        except Exception:
            _log.exception("world %s is closed", hosted.name)
            self._close(hosted)
            return
        self._tell(hosted)

    def _tell(self, hosted: HostedWorld) -> None:
        """Events and the newest state to all who joined."""
        hosted.changed()
        for event in hosted.world.events:
            self._announce(hosted, _event_message(hosted, event))
        for client, states in hosted.clients.items():
            if states != "none":
                client.outbox.mark(hosted.name)

    def _announce(self, hosted: HostedWorld, message: Mapping[str, Any]) -> None:
        for client in tuple(hosted.clients):
            self._put(client, message)

    def _put(self, client: _Client, message: Mapping[str, Any]) -> None:
        try:
            client.outbox.put(message)
        except TooSlow:
            self._dismiss(client, 1013, "does not read what it is sent")

    def _dismiss(self, client: _Client, code: int, why: str) -> None:
        """Send a client away, without waiting for it."""
        if client in self._clients:
            self._forget(client)
            task = asyncio.ensure_future(client.connection.close(code, why))
            task.add_done_callback(lambda done: done.cancelled() or done.exception())

    def _send_away(self, now: float) -> None:
        busy = {client for hosted in self.worlds.values() for client in hosted.clients}
        for client in self._clients - busy:
            if now - client.heard > self.limits.idle:
                self._dismiss(client, 1001, "was silent for too long")
        for hosted in tuple(self.worlds.values()):
            if hosted.clients:
                self._deserted.pop(hosted.name, None)
            elif now - self._deserted.setdefault(hosted.name, now) > self.limits.idle:
                self._close(hosted)

    # --- connections
    async def _connected(self, connection: ServerConnection) -> None:
        client = _Client(connection, self._newest, self.limits.waiting)
        self._clients.add(client)
        writer = asyncio.ensure_future(self._write(client))
        try:
            if await self._greet(client):
                async for text in connection:
                    if client not in self._clients:
                        break
                    client.heard = time.monotonic()
                    self._answer(client, text)
                    await client.outbox.room()
                    await asyncio.sleep(0)
        except (ConnectionClosed, TimeoutError):
            pass
        finally:
            self._forget(client)
            writer.cancel()
            with suppress(asyncio.CancelledError, ConnectionClosed):
                await writer

    async def _greet(self, client: _Client) -> bool:
        """The first message: right version, right token?"""
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
        self._put(client, {"type": "reply", "id": number, "result": result})
        return True

    async def _write(self, client: _Client) -> None:
        with suppress(ConnectionClosed):
            while True:
                await client.connection.send(await client.outbox.take(), text=True)

    def _forget(self, client: _Client) -> None:
        self._clients.discard(client)
        for hosted in self.worlds.values():
            hosted.clients.pop(client, None)

    def _newest(self, client: _Client, world: str) -> bytes | None:
        hosted = self.worlds.get(world)
        states = "none" if hosted is None else hosted.clients.get(client, "none")
        return None if hosted is None or states == "none" else hosted.state(states)

    # --- requests
    def _answer(self, client: _Client, text: str | bytes) -> None:
        number, code = None, "invalid"
        try:
            request = _parsed(text)
            number, code = request.id, "refused"
            result = getattr(self, f"_do_{request.type}")(client, request)
        except (RuntimeInputError, ValueError) as error:
            number = _id_in(text) if number is None else number
            self._put(client, {"type": "error", "id": number, "code": code, "message": str(error)})
        except Exception:
            _log.exception("a request failed")
            self._put(client, {"type": "error", "id": number, "code": "internal", "message": "see the log"})
        else:
            self._put(client, {"type": "reply", "id": number, "result": result})

    def _hosted(self, name: str) -> HostedWorld:
        if name not in self.worlds:
            raise RuntimeInputError(f"no world {name!r}; there are: {', '.join(self.worlds) or 'none'}")
        return self.worlds[name]

    def _level(self, name: str) -> navmesh.NodeGraph:
        if name not in self.levels:
            raise RuntimeInputError(f"no level {name!r}; valid: {', '.join(self.levels)}")
        return self.levels[name]

    def _do_hello(self, client: _Client, request: m.Hello) -> Any:
        raise RuntimeInputError("hello has been said already")

    def _do_level(self, client: _Client, request: m.Level) -> Any:
        return level_message(self._level(request.level))

    def _do_graph(self, client: _Client, request: m.Graph) -> Any:
        return graph_message(self._level(request.level))

    def _do_create(self, client: _Client, request: m.Create) -> Any:
        if len(self.worlds) >= self.limits.worlds:
            raise RuntimeInputError(f"there are {self.limits.worlds} worlds already; close one")
        graph, name = self._level(request.level), f"world{next(self._numbers)}"
        self.worlds[name] = HostedWorld(name, request.level, graph, request.seed, request.clock == "manual")
        return self._join(client, self.worlds[name], request.states)

    def _do_join(self, client: _Client, request: m.Join) -> Any:
        return self._join(client, self._hosted(request.world), request.states)

    def _join(self, client: _Client, hosted: HostedWorld, states: m.States) -> Any:
        hosted.clients[client] = states
        client.outbox.mark(hosted.name)
        agents = [skeleton(agent) for agent in hosted.world.agents.values()]
        return {
            "world": hosted.name, "level": hosted.level, "time": hosted.world.time, "agents": agents
        }  # fmt: skip

    def _do_leave(self, client: _Client, request: m.Leave) -> Any:
        hosted = self.worlds.get(request.world)
        return {"left": hosted is not None and hosted.clients.pop(client, None) is not None}

    def _do_close(self, client: _Client, request: m.Close) -> Any:
        self._close(self._hosted(request.world))
        return {}

    def _close(self, hosted: HostedWorld) -> None:
        self._announce(hosted, {"type": "gone", "world": hosted.name, "agent": None})
        self._deserted.pop(hosted.name, None)
        del self.worlds[hosted.name]

    def _do_spawn(self, client: _Client, request: m.Spawn) -> Any:
        hosted = self._hosted(request.world)
        if len(hosted.world.agents) >= self.limits.agents:
            raise RuntimeInputError(f"there are {self.limits.agents} agents already; remove one")
        agent = hosted.world.spawn(request.body, request.at, request.facing, request.name)
        self._announce(hosted, {"type": "agent", "world": hosted.name, "agent": skeleton(agent)})
        self._tell(hosted)
        return {"agent": agent.name}

    def _do_go_to(self, client: _Client, request: m.GoTo) -> Any:
        hosted = self._hosted(request.world)
        status = hosted.agent(request.agent).go_to(request.points, request.speed, request.facing)
        return {"status": status}

    def _do_stop(self, client: _Client, request: m.Stop) -> Any:
        hosted = self._hosted(request.world)
        agent = hosted.agent(request.agent)
        agent.stop()
        return {"status": agent.status}

    def _do_way(self, client: _Client, request: m.Way) -> Any:
        return way_message(self._hosted(request.world).agent(request.agent))

    def _do_remove(self, client: _Client, request: m.Remove) -> Any:
        hosted = self._hosted(request.world)
        hosted.agent(request.agent).remove()
        self._announce(hosted, {"type": "gone", "world": hosted.name, "agent": request.agent})
        self._tell(hosted)
        return {}

    def _do_step(self, client: _Client, request: m.Step) -> Any:
        hosted = self._hosted(request.world)
        if not hosted.manual:
            raise RuntimeInputError(f"world {hosted.name!r} runs by itself; make it with the clock 'manual'")
        ticks = hosted.world.step(request.dt)
        self._tell(hosted)
        return {"ticks": ticks, "time": hosted.world.time}

    def _do_save(self, client: _Client, request: m.Save) -> Any:
        hosted = self._hosted(request.world)
        hosted.saved = hosted.world.save()
        return {"time": hosted.world.time, "hash": hosted.world.state_hash()}

    def _do_restore(self, client: _Client, request: m.Restore) -> Any:
        hosted = self._hosted(request.world)
        if hosted.saved is None:
            raise RuntimeInputError(f"world {hosted.name!r} has not been saved")
        before = set(hosted.world.agents)
        hosted.world.restore(hosted.saved)
        for name in sorted(before - set(hosted.world.agents)):
            self._announce(hosted, {"type": "gone", "world": hosted.name, "agent": name})
        for name, agent in hosted.world.agents.items():
            if name not in before:
                self._announce(hosted, {"type": "agent", "world": hosted.name, "agent": skeleton(agent)})
        self._tell(hosted)
        return {"time": hosted.world.time, "hash": hosted.world.state_hash()}


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
    """The id that the answer repeats, None where there is no right one."""
    try:
        number = json.loads(text)["id"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return number if type(number) is int and 0 <= number < 2**53 else None


def _event_message(hosted: HostedWorld, event: Event) -> dict[str, Any]:
    return {"type": "event", "world": hosted.name, "event": event.to_dict()}


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _port_of(server: Server) -> int:
    return next(iter(server.sockets)).getsockname()[1]
