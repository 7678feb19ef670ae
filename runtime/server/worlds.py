"""The worlds of a server: members, owners and lifetime."""

import time
from collections.abc import Callable, Mapping
from itertools import count
from typing import Any

from runtime.dis.gateway import Gateway
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.server import messages as m
from runtime.server.client import Client
from runtime.server.hosted import HostedWorld, skeleton
from runtime.server.limits import Limits
from runtime.server.outbox import TooSlow
from runtime.world.world import World

__all__ = ["Worlds"]


class Worlds:
    """``hosted``: by name. ``clients``: all connected ones; ``too_slow`` is called with one that does not
    read its messages."""

    def __init__(self, limits: Limits, clients: set[Client], too_slow: Callable[[Client], None]) -> None:
        self.hosted: dict[str, HostedWorld] = {}
        self._limits, self._clients, self._too_slow = limits, clients, too_slow
        self._numbers = count(1)
        self.gateway: Callable[[World], Gateway] | None = None
        """Makes the gateway to other simulators, by which one of the worlds at a time talks to them."""

    def named(self, name: str) -> HostedWorld:
        """Raises `RuntimeInputError` if there is none."""
        if name not in self.hosted:
            raise RuntimeInputError(f"no world {name!r}; there are: {', '.join(self.hosted) or 'none'}")
        return self.hosted[name]

    def joined(self, client: Client, name: str) -> HostedWorld:
        """Raises `RuntimeInputError` for a world that does not exist or that ``client`` has not joined."""
        hosted = self.named(name)
        if client not in hosted.clients:
            raise RuntimeInputError(f"you have not joined world {name!r}; join it first")
        return hosted

    def check_world(self, client: Client) -> None:
        """Raise `RuntimeInputError` if ``client`` may not have another world."""
        if len(self.hosted) >= self._limits.all_worlds:
            self._close_deserted(0.0)
        own = sum(hosted.owner is client for hosted in self.hosted.values())
        self._limits.check_share("worlds", own, 1, len(self.hosted), len(self._clients))

    def new_name(self) -> str:
        """A name that no world has had before."""
        return f"world{next(self._numbers)}"

    def check_agents(self, client: Client, more: int) -> None:
        """Raise `RuntimeInputError` if ``client`` may not have ``more`` agents."""
        if sum(len(each.spawned) for each in self.hosted.values()) + more > self._limits.all_agents:
            self._close_deserted(0.0)
        owners = [who for each in self.hosted.values() for who in each.spawned.values()]
        own = sum(who is client for who in owners)
        self._limits.check_share("agents", own, more, len(owners), len(self._clients))

    def check_room(self, hosted: HostedWorld) -> None:
        """Raise `RuntimeInputError` if a world has the most agents allowed."""
        if len(hosted.world.agents) >= self._limits.agents:
            raise RuntimeInputError(
                f"there are {self._limits.agents} agents already in the world; remove one"
            )

    def connect(self, hosted: HostedWorld) -> None:
        """Let a new world talk to other simulators, if none does. Raises `RuntimeInputError` for addresses
        that cannot be used."""
        if self.gateway is not None and not any(each.gateway for each in self.hosted.values()):
            hosted.gateway = self.gateway(hosted.world)

    def join(self, client: Client, hosted: HostedWorld, states: m.States) -> None:
        """Add a connected client to a world that still exists."""
        if client in self._clients and not hosted.closed:
            hosted.begin(client, states)
            client.outbox.mark(hosted.name)

    def leave(self, client: Client, hosted: HostedWorld) -> bool:
        """Whether it was a member."""
        if not hosted.end(client):
            return False
        hosted.spawned = {
            name: hosted.owner if who is client else who for name, who in hosted.spawned.items()
        }
        if not hosted.clients:
            hosted.since = time.monotonic()
        return True

    def close(self, hosted: HostedWorld) -> None:
        """End it for all; its work is aborted."""
        hosted.closed = True
        if hosted.gateway is not None:
            hosted.gateway.close()
        del self.hosted[hosted.name]
        self.announce(hosted, {"type": "gone", "world": hosted.name, "agent": None})

    def close_deserted(self) -> None:
        """End worlds that have been without members for some time."""
        self._close_deserted(self._limits.deserted)

    def _close_deserted(self, after: float) -> None:
        for hosted in tuple(self.hosted.values()):
            if not hosted.clients and time.monotonic() - hosted.since >= after:
                self.close(hosted)

    # --- what is told
    def tell(self, hosted: HostedWorld) -> None:
        """Send events and the newest state to all members."""
        self.tell_events(hosted)
        loaded, dropped = hosted.chunks_changed()
        if loaded or dropped:
            changed = {"type": "chunks", "world": hosted.name, "loaded": loaded, "dropped": dropped}
            self.announce(hosted, changed)
        come, gone = hosted.strangers()
        for name in gone:
            self.announce(hosted, {"type": "gone", "world": hosted.name, "agent": name})
        for agent in come:
            self.announce(hosted, {"type": "agent", "world": hosted.name, "agent": skeleton(agent)})
        for client, states in hosted.clients.items():
            if states != "none":
                client.outbox.mark(hosted.name)

    def tell_events(self, hosted: HostedWorld) -> None:
        """Send events to all members."""
        for event in hosted.world.events:
            self.announce(hosted, _event_message(hosted, event))

    def announce(self, hosted: HostedWorld, message: Mapping[str, Any]) -> None:
        """Send a message to all members."""
        for client in tuple(hosted.clients):
            self.put(client, message)

    def put(self, client: Client, message: Mapping[str, Any], result: bytes | None = None) -> None:
        """Send a message to one client, as `Outbox.put` does."""
        try:
            client.outbox.put(message, result)
        except TooSlow:
            self._too_slow(client)

    def state(self, client: Client, world: str) -> bytes | None:
        """The newest state in the form that ``client`` wants, None if it wants none."""
        hosted = self.hosted.get(world)
        return None if hosted is None else hosted.state_for(client)


def _event_message(hosted: HostedWorld, event: Event) -> dict[str, Any]:
    return {"type": "event", "world": hosted.name, "event": event.to_dict()}
