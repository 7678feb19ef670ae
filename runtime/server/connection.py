"""A connection that is closed when its client floods it.

Pings are answered by the library and never reach the readers of messages, so they are counted here.
"""

import asyncio
from typing import Any, cast

from websockets.asyncio.server import ServerConnection
from websockets.frames import Frame, Opcode

from runtime.server.limits import Limits

__all__ = ["connection_with"]

_PIECE = 8192  # [bytes] read at a time, which bounds the time spent on one client


def connection_with(limits: Limits) -> type[ServerConnection]:
    """The class of connections that enforce ``limits``."""

    class Connection(ServerConnection):
        _begun, _pings = 0.0, 0  # of the present second

        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            super().connection_made(transport)
            cast(Any, transport).max_size = _PIECE

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            if self.transport.get_write_buffer_size() > limits.waiting:
                self.transport.abort()  # a client that asks but does not read

        def process_event(self, event: Any) -> None:
            super().process_event(event)
            if not isinstance(event, Frame) or event.opcode not in (Opcode.PING, Opcode.PONG):
                return
            if self.loop.time() - self._begun >= 1.0:
                self._begun, self._pings = self.loop.time(), 0
            self._pings += 1
            if self._pings > limits.pings:
                self.transport.abort()

    return Connection
