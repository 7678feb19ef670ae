"""Figures that talk to other simulators by DIS: Entity State PDUs of IEEE 1278.1 over UDP.

with Gateway(world, site=1, application=1, exercise=1, origin=(48.137, 11.575, 520.0)) as gateway:
    while playing:
        world.step(1 / 60)
        gateway.exchange()
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from runtime.dis.exchange import Exchange, Options, Place
    from runtime.dis.gateway import Gateway
    from runtime.dis.incoming import Limits
    from runtime.dis.outgoing import Thresholds

__all__ = ["Exchange", "Gateway", "Limits", "Options", "Place", "Thresholds"]

_HOMES = {
    "Exchange": "exchange", "Gateway": "gateway", "Limits": "incoming", "Options": "exchange",
    "Place": "exchange", "Thresholds": "outgoing",
}  # fmt: skip


def __getattr__(name: str) -> Any:
    # imported when first asked for: worlds import dead reckoning from here, and gateways import worlds
    if name in _HOMES:
        return getattr(import_module(f"runtime.dis.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'runtime.dis' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
