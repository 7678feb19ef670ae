"""Messages waiting for one client.

Replies and events wait in order and are never dropped; a client with too many of them is disconnected. For
states, only the worlds with a newer one are kept: the newest is looked up when there is room to send it.
"""

import asyncio
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pydantic_core import to_json

__all__ = ["Outbox", "TooSlow"]

_PIECE = 1 << 16  # [bytes]


class TooSlow(Exception):
    """A client does not read its messages."""


class Outbox:
    """``newest(world)`` returns the text of a world's newest state for this client, None if there is no such
    world; ``most``: bytes that may wait in order."""

    def __init__(self, newest: Callable[[str], bytes | None], most: int) -> None:
        self._newest, self._most = newest, most
        self._ordered: deque[tuple[bytes, ...]] = deque()
        self._fresh: dict[str, None] = {}
        self._waiting, self._seq, self._ended = 0, 0, False
        self._filled, self._room = asyncio.Event(), asyncio.Event()
        self._room.set()

    def put(self, message: Mapping[str, Any], result: bytes | None = None) -> None:
        """Send in order. ``result``: JSON text of the message's ``result``, which the server shares among
        clients: it uses no room here, and is sent in pieces. Raises `TooSlow`."""
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
        """Note that a world has a newer state."""
        self._fresh[world] = None
        self._filled.set()

    def end(self) -> None:
        """The client is gone."""
        self._ordered.clear()
        self._fresh.clear()
        self._waiting, self._ended = 0, True
        self._room.set()

    async def room(self) -> None:
        """Wait until the client has read some of its answers."""
        await self._room.wait()

    async def take(self) -> bytes | Iterator[memoryview]:
        """Wait for the next message; a large one comes in pieces."""
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
    """Size of what is stored for this client alone."""
    return len(text[0]) + (len(text[-1]) if len(text) > 1 else 0)


def _pieces(text: tuple[bytes, ...]) -> Iterator[memoryview]:
    for part in text:
        for begin in range(0, len(part), _PIECE):
            yield memoryview(part)[begin : begin + _PIECE]
