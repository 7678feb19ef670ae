"""A world's part in an exercise, without a network: datagrams in, datagrams out."""

import time
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from runtime.dis.entity_state import VERSIONS
from runtime.dis.enumerations import Force
from runtime.dis.geodesy import LevelFrame
from runtime.dis.incoming import Incoming, Limits
from runtime.dis.outgoing import Identity, Outgoing, Thresholds
from runtime.dis.sieve import Address
from runtime.dis.timestamps import timestamp
from runtime.errors import RuntimeInputError
from runtime.world.world import World

__all__ = ["Exchange", "Options", "Place"]


@dataclass(frozen=True)
class Place:
    """Which simulator of which exercise this is: ``site`` and ``application`` (0 to 65534) are its own in
    ``exercise`` (1 to 255). Raises `RuntimeInputError` for other numbers."""

    site: int
    application: int
    exercise: int

    def __post_init__(self) -> None:
        for name, low, high in (("site", 0, 65534), ("application", 0, 65534), ("exercise", 1, 255)):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
                raise RuntimeInputError(f"{name} must be a whole number of {low} to {high}, not {value!r}")


@dataclass(frozen=True)
class Options:
    """How a gateway talks, where that is not as usual.

    ``listen``: address and port; by default this machine only, at the port that is sent to. ``multicast``,
    ``broadcast``: whether to send and listen to such addresses. ``interface``: address of the network
    interface for multicast. ``version`` of the protocol: 5, 6 or 7. ``absolute``: whether timestamps are UTC,
    and not the world's time. ``force``: of our entities. ``types``: entity types by body, in place of
    those of `BodyKind.entity_type`. ``seed``: of the spread of heartbeats.
    """

    listen: Address | None = None
    multicast: bool = False
    broadcast: bool = False
    interface: str = "127.0.0.1"
    version: int = 7
    absolute: bool = False
    force: int = Force.NEUTRAL
    types: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    thresholds: Thresholds = field(default_factory=Thresholds)
    limits: Limits = field(default_factory=Limits)
    seed: int = 0

    def __post_init__(self) -> None:
        if self.version not in VERSIONS:
            raise RuntimeInputError(f"version {self.version!r}: valid: {', '.join(map(str, VERSIONS))}")
        for body, numbers in self.types.items():
            if len(numbers) != 7 or not all(
                0 <= each <= (65535 if k == 2 else 255) for k, each in enumerate(numbers)
            ):
                raise RuntimeInputError(
                    f"type of {body!r}: expected kind, domain, country, category, subcategory, specific and "
                    f"extra, not {numbers!r}"
                )


class Exchange:
    """``world`` in an exercise. ``origin``: latitude [°], longitude [°] and height [m] of its level's (0, 0,
    0). The same world, packets and seed give the same packets, unless timestamps are absolute.

    ``counts``: what has come, been sent and been dropped, by kind.
    """

    def __init__(
        self, world: World, place: Place, origin: tuple[float, float, float], options: Options | None = None
    ) -> None:
        options = options or Options()
        self._world, self._absolute = world, options.absolute
        self.counts: Counter[str] = Counter()
        frame = LevelFrame(origin)
        own = place.site, place.application
        identity = Identity(*own, place.exercise, options.version, options.force, options.types)
        self._out = Outgoing(world, frame, identity, options.thresholds, options.seed)
        self._in = Incoming(world, frame, place.exercise, own, options.limits, self.counts)

    def receive(self, packets: Iterable[tuple[bytes, Address]]) -> None:
        """Take in datagrams, each with its sender's address, at the world's present time; and let go whoever
        has not been heard of for too long."""
        self._in.receive(packets)
        self._in.time_out()

    def send(self) -> list[bytes]:
        """The datagrams that are due now. Call it after each step of the world."""
        return self._stamped(self._out.due())

    def leave(self) -> list[bytes]:
        """The last datagrams: all our entities are gone. Takes out those of others."""
        self._in.leave()
        return self._stamped(self._out.leave())

    def _stamped(self, records: np.ndarray) -> list[bytes]:
        records["timestamp"] = timestamp(time.time() if self._absolute else self._world.time, self._absolute)
        self.counts["sent"] += len(records)
        return [record.tobytes() for record in records]
