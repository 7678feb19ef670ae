"""What a world gives its agents of itself."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import navmesh
from locomotion.body.person import CONTROL_DT
from runtime.bodies.protocol import Driver
from runtime.traffic.traffic import Traffic
from runtime.world.event_log import EventLog

__all__ = ["Clock", "Host"]


@dataclass
class Clock:
    """Simulated time: ``ticks`` of 10 ms that were made, and the time [s] that is ``owed``."""

    ticks: int = 0
    owed: float = 0.0

    @property
    def time(self) -> float:
        """[s]"""
        return self.ticks * CONTROL_DT

    @property
    def blend(self) -> float:
        """The share of a tick that is owed, 0 to 1."""
        return min(self.owed / CONTROL_DT, 1.0)


@dataclass(frozen=True)
class Host:
    """``remove`` takes a `runtime.Agent` out of the world; ``at_level`` gives the driver of an agent at a
    level of detail (and whether at once), None while it cannot have it; ``levels`` those that a body has;
    ``open_world`` gives the open world as it is loaded now, None where the level is another; ``arrivals``
    numbers the bodies as they come."""

    clock: Clock
    log: EventLog
    traffic: Traffic
    remove: Callable[[Any], None]
    at_level: Callable[[Any, str, bool], Driver | None]
    levels: Callable[[str], tuple[str, ...]]
    open_world: Callable[[], navmesh.OpenWorld | None]
    arrivals: Iterator[int] = field(default_factory=count)
