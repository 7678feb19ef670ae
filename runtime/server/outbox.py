"""What waits to be sent to one client.

Replies and events wait in order, none is dropped; a client that lets too many of them wait is told to go. Of
states only which worlds have a newer one is kept: the newest is looked up when there is room to send it.
"""

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from pydantic_core import to_json

__all__ = ["Outbox", "TooSlow"]


class TooSlow(Exception):
    """A client does not read what it is sent."""


class Outbox:
    """``newest(world)`` gives the text of a world's newest state for this client, None for no such world;
    ``most`` is how many bytes may wait in order."""

    def __init__(self, newest: Callable[[str], bytes | None], most: int) -> None:
        self._newest, self._most = newest, most
        self._ordered: deque[bytes] = deque()
        self._fresh: dict[str, None] = {}
        self._waiting, self._seq = 0, 0
        self._filled, self._room = asyncio.Event(), asyncio.Event()
        self._room.set()

    def put(self, message: Mapping[str, Any]) -> None:
        """Send in order. Raises `TooSlow`."""
        self._seq += 1
        text = to_json({**message, "seq": self._seq})
        if self._waiting + len(text) > self._most and self._ordered:
            raise TooSlow
        self._ordered.append(text)
        self._waiting += len(text)
        if self._waiting > self._most // 4:
            self._room.clear()
        self._filled.set()

    def mark(self, world: str) -> None:
        """A world has a newer state."""
        self._fresh[world] = None
        self._filled.set()

    async def room(self) -> None:
        """Wait until a client that asks much has read some of the answers."""
        await self._room.wait()

    async def take(self) -> bytes:
        """The next message to be sent, once there is one."""
        while True:
            await self._filled.wait()
            if self._ordered:
                text = self._ordered.popleft()
                self._waiting -= len(text)
                if self._waiting <= self._most // 4:
                    self._room.set()
                return text
            while self._fresh:
                world = next(iter(self._fresh))
                del self._fresh[world]
                text = self._newest(world)
                if text is not None:
                    return text
            self._filled.clear()
