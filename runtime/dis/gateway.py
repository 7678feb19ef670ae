"""A world's part in an exercise, over UDP.

gateway = Gateway(world, site=1, application=1, exercise=1, origin=(48.137, 11.575, 520.0))
while playing:
    world.step(1 / 60)
    gateway.exchange()
gateway.close()
"""

from collections import Counter

from runtime.dis.exchange import Exchange, Options, Place
from runtime.dis.sieve import Address
from runtime.dis.udp import Udp
from runtime.world.world import World

__all__ = ["Gateway"]


class Gateway:
    """Our agents are entities for others, and theirs are agents among ours, as "dis:site:application:entity".

    ``origin``: latitude [°], longitude [°] and height above the ellipsoid [m] of the level's point (0, 0, 0);
    its X is east, its Y north. ``address``: where to send, and the port to listen on. Nothing leaves or comes
    from beyond this machine unless an address says so. Raises `RuntimeInputError` for numbers out of range,
    and addresses that cannot be used.

    ``counts``: what has been sent, has come, and was dropped, by kind.
    """

    def __init__(
        self,
        world: World,
        site: int,
        application: int,
        exercise: int,
        origin: tuple[float, float, float],
        address: Address = ("127.0.0.1", 3000),
        options: Options | None = None,
    ) -> None:
        options = options or Options()
        self._exchange = Exchange(world, Place(site, application, exercise), origin, options)
        self._udp = Udp(address, options.listen, options.multicast, options.broadcast, options.interface)

    @property
    def counts(self) -> Counter[str]:
        return self._exchange.counts

    @property
    def port(self) -> int:
        """That it listens on."""
        return self._udp.port

    def exchange(self) -> None:
        """Take in what has come, and send what is due; call it after each `World.step`. Never waits."""
        self._exchange.receive(self._udp.received())
        self._send(self._exchange.send())

    def close(self) -> None:
        """Tell the others that our entities are gone, take theirs out of the world, and close the socket. A
        second call does nothing."""
        if not self._udp.closed:
            self._send(self._exchange.leave())
            self._udp.close()

    def _send(self, packets: list[bytes]) -> None:
        self.counts["not sent"] += self._udp.send(packets)

    def __enter__(self) -> "Gateway":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
