"""A client of the server."""

import time

from websockets.asyncio.server import ServerConnection

from runtime.server.outbox import Outbox
from runtime.server.turns import Account

__all__ = ["Client"]


class Client:
    """``outbox``: messages to send. ``account``: its share of the server's time. ``heard``: when [s] it last
    sent anything."""

    def __init__(self, connection: ServerConnection, outbox: Outbox) -> None:
        self.connection, self.outbox, self.account = connection, outbox, Account()
        self.heard = time.monotonic()
