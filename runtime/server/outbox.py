"""What waits to be sent to one client.

Replies and events wait in order, none is dropped; a client that lets too many of them wait is told to go. Of
states only which worlds have a newer one is kept: the newest is looked up when there is room to send it.
"""

import asyncio
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pydantic_core import to_json

__all__ = ["Outbox", "TooSlow"]

_PIECE = 1 << 16  # [bytes]


class TooSlow(Exception):
    """A client does not read what it is sent."""


class Outbox:
    """``newest(world)`` gives the text of a world's newest state for this client, None for no such world;
    ``most`` is how many bytes may wait in order."""

    def __init__(self, newest: Callable[[str], bytes | None], most: int) -> None:
        self._newest, self._most = newest, most
        self._ordered: deque[tuple[bytes, ...]] = deque()
        self._fresh: dict[str, None] = {}
        self._waiting, self._seq, self._ended = 0, 0, False
        self._filled, self._room = asyncio.Event(), asyncio.Event()
        self._room.set()

    def put(self, message: Mapping[str, Any], result: bytes | None = None) -> None:
        """Send in order. ``result``: the JSON text of the message's ``result``, which the server keeps for
        all: it takes no room here, and is sent in pieces. Raises `TooSlow`."""
        self._seq += 1
        end = b',"seq":%d}' % self._seq
        head = to_json(message)[:-1]
        text = (head + end,) if result is None else (head + b',"result":', result, end)
        size = _own(text)
        if self._ended:
            return
        if self._waiting + size > self._most and self._ordered:
            raise TooSlow
        self._ordered.append(text)
        self._waiting += size
        if self._waiting > self._most // 4:
            self._room.clear()
        self._filled.set()

    def mark(self, world: str) -> None:
        """A world has a newer state."""
        self._fresh[world] = None
        self._filled.set()

    def end(self) -> None:
        """Nobody is there any more to read it."""
        self._ordered.clear()
        self._fresh.clear()
        self._waiting, self._ended = 0, True
        self._room.set()

    async def room(self) -> None:
        """Wait until a client that asks much has read some of the answers."""
        await self._room.wait()

    async def take(self) -> bytes | Iterator[memoryview]:
        """The next message to be sent, once there is one; a large one in pieces."""
        while True:
            await self._filled.wait()
            if self._ordered:
                text = self._ordered.popleft()
                self._waiting -= _own(text)
                if self._waiting <= self._most // 4:
                    self._room.set()
                return text[0] if len(text) == 1 else _pieces(text)
            while self._fresh:
                world = next(iter(self._fresh))
                del self._fresh[world]
                text = self._newest(world)
                if text is not None:
                    return text
            self._filled.clear()


def _own(text: tuple[bytes, ...]) -> int:
    """Size of what is kept for this client alone."""
    return len(text[0]) + (len(text[-1]) if len(text) > 1 else 0)


def _pieces(text: tuple[bytes, ...]) -> Iterator[memoryview]:
    for part in text:
        for begin in range(0, len(part), _PIECE):
            yield memoryview(part)[begin : begin + _PIECE]
