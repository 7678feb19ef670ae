"""A UDP socket that never waits: this machine only, multicast and broadcast only if asked for."""

import ipaddress
import socket
from collections.abc import Iterable, Iterator

from runtime.dis.sieve import OVERSIZED, Address
from runtime.errors import RuntimeInputError

__all__ = ["Udp"]

_AT_ONCE = 10_000
"""Datagrams that one call takes at most; the system keeps some of the others, and drops the rest."""
_BUFFER = 4 << 20  # [bytes] asked of the system for what comes between two calls


class Udp:
    """Sends to ``address`` and listens at ``listen``, by default at the same port of this machine. Raises
    `RuntimeInputError` for addresses that cannot be used."""

    def __init__(
        self,
        address: Address,
        listen: Address | None = None,
        multicast: bool = False,
        broadcast: bool = False,
        interface: str = "127.0.0.1",
    ) -> None:
        there = _checked(address, "address")
        group = there.is_multicast
        if group and not multicast:
            raise RuntimeInputError(f"{there} is a multicast address; ask for multicast to use it")
        wide = str(there).endswith(".255")
        if wide and not broadcast:
            raise RuntimeInputError(f"{there} is a broadcast address; ask for broadcast to use it")
        self._address = str(there), address[1]
        shared = group or wide
        here = listen or (str(there) if shared else "127.0.0.1", address[1])
        _checked(here, "listen")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.closed = False
        try:
            self._socket.setblocking(False)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
            if shared:
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            if wide:
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
            self._socket.bind(here)
            if group:
                own = ipaddress.IPv4Address(interface).packed
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, there.packed + own)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, own)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
        except (OSError, OverflowError, ValueError) as error:
            self._socket.close()
            raise RuntimeInputError(f"cannot listen at {here[0]}:{here[1]}: {error}") from None

    @property
    def port(self) -> int:
        """That it listens on."""
        return int(self._socket.getsockname()[1])

    def received(self) -> Iterator[tuple[bytes, Address]]:
        """The datagrams that have come, and who sent each; of longer ones than are looked at, the beginning
        and one byte more."""
        for _ in range(_AT_ONCE):
            try:
                data, sender = self._socket.recvfrom(OVERSIZED + 1)
            except BlockingIOError:
                return
            except OSError:  # nobody listens where we have sent to
                continue
            yield data, (sender[0], sender[1])

    def send(self, packets: Iterable[bytes]) -> int:
        """Send ``packets``, one a datagram; how many could not be."""
        failed = 0
        for data in packets:
            try:
                self._socket.sendto(data, self._address)
            except OSError:
                failed += 1
        return failed

    def close(self) -> None:
        """Close it."""
        self.closed = True
        self._socket.close()


def _checked(address: Address, what: str) -> ipaddress.IPv4Address:
    try:
        host, port = address
        there = ipaddress.IPv4Address("127.0.0.1" if host == "localhost" else host)
    except (TypeError, ValueError):
        raise RuntimeInputError(
            f"{what} {address!r}: expected an IPv4 address and a port, such as ('127.0.0.1', 3000)"
        ) from None
    if not isinstance(port, int) or not 0 <= port <= 65535:
        raise RuntimeInputError(f"{what}: port {port!r}: expected 0 to 65535")
    return there
