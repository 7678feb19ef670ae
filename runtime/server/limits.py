"""What one client may use, so that enough is left for the others."""

from dataclasses import dataclass

from runtime.errors import RuntimeInputError

__all__ = ["Limits"]


@dataclass(frozen=True)
class Limits:
    """Sizes in bytes, times in seconds.

    message: of a request. clients: at a time. worlds, agents: that one client may have; there are no more
    agents in a world either. all_worlds, all_agents: how many there may be before each client can have its
    share of them only: as many for each client that is there. waiting: of replies and events that a client
    may leave unread, and of answers to its pings. pings: of a client in a second. idle: time after which a
    client that is silent and in no world is sent away. deserted: time that a world is kept which all clients
    have left; it stands still meanwhile. greeting: time for the first message.
    """

    message: int = 65536
    clients: int = 128
    worlds: int = 16
    agents: int = 256
    all_worlds: int = 128
    all_agents: int = 2048
    waiting: int = 8_000_000
    pings: int = 20
    idle: float = 300.0
    deserted: float = 10.0
    greeting: float = 10.0

    def check_share(self, what: str, own: int, more: int, total: int, clients: int) -> None:
        """Raise `RuntimeInputError` where a client that has ``own`` worlds or agents (``what``), of ``total``
        in the server, must not have ``more``; there are so many ``clients``."""
        most, of = (self.worlds, self.all_worlds) if what == "worlds" else (self.agents, self.all_agents)
        wanted = own + more
        if wanted > most:
            raise RuntimeInputError(f"you have {own} {what} already, of {most}; give one up")
        share = of // max(clients, 1)
        if total + more > of and wanted > share:
            raise RuntimeInputError(
                f"the server has {total} {what} already, of {of}; you have {own}, and your share is {share}"
            )
