"""The options by which commands talk to other simulators, and the real time in which they then run."""

import time
from dataclasses import dataclass

from runtime.dis.exchange import Options
from runtime.dis.gateway import Gateway
from runtime.dis.sieve import Address
from runtime.errors import RuntimeInputError
from runtime.world.world import World

__all__ = ["DisLine", "RealTime", "address_of"]


def address_of(text: str) -> Address:
    """ADDRESS:PORT. Raises `RuntimeInputError` for anything else."""
    host, colon, port = text.rpartition(":")
    if not colon or not port.isdecimal():
        raise RuntimeInputError(f"{text!r}: expected an IPv4 address and a port, such as 127.0.0.1:3000")
    return host, int(port)


@dataclass(frozen=True)
class DisLine:
    """``to`` and ``listen``: ADDRESS:PORT; ``name``: SITE:APPLICATION:EXERCISE; ``origin``: latitude [°],
    longitude [°], height [m]."""

    to: str
    listen: str | None
    name: str
    origin: tuple[float, float, float]
    multicast: bool = False
    broadcast: bool = False

    def gateway(self, world: World) -> Gateway:
        """Raises `RuntimeInputError` for what cannot be used."""
        try:
            site, application, exercise = (int(each) for each in self.name.split(":"))
        except ValueError:
            raise RuntimeInputError(
                f"{self.name!r}: expected SITE:APPLICATION:EXERCISE, such as 1:1:1"
            ) from None
        options = Options(
            listen=None if self.listen is None else address_of(self.listen),
            multicast=self.multicast,
            broadcast=self.broadcast,
        )
        return Gateway(world, site, application, exercise, self.origin, address_of(self.to), options)


class RealTime:
    """Holds a world to real time, and lets its gateway exchange."""

    def __init__(self, gateway: Gateway) -> None:
        self._gateway, self._begun = gateway, time.monotonic()

    def keep(self, world: World) -> None:
        """Call it after each step."""
        self._gateway.exchange()
        time.sleep(max(self._begun + world.time - time.monotonic(), 0.0))

    def __enter__(self) -> "RealTime":
        return self

    def __exit__(self, *_: object) -> None:
        self._gateway.close()
