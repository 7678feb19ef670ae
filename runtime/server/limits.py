"""What one client may use, so that enough is left for the others."""

from dataclasses import dataclass

from runtime.errors import RuntimeInputError

__all__ = ["Limits"]


@dataclass(frozen=True)
class Limits:
    """Sizes in bytes, times in seconds.

    message: size of a request. clients: at a time. worlds, agents: per client; `agents` also per world.
    all_worlds, all_agents: totals beyond which each client is limited to an equal share. waiting: replies,
    events and ping answers that a client may leave unread. pings: per client and second. idle: time after
    which a silent client in no world is disconnected. deserted: time that a world without clients is kept,
    paused. greeting: time allowed for the first message.
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
        """Raise `RuntimeInputError` if a client with ``own`` worlds or agents (``what``), out of ``total`` on
        the server, may not have ``more``, given the number of ``clients``."""
        most, of = (self.worlds, self.all_worlds) if what == "worlds" else (self.agents, self.all_agents)
        wanted = own + more
        if wanted > most:
            raise RuntimeInputError(f"you have {own} {what} already, of at most {most}; remove one")
        share = of // max(clients, 1)
        if total + more > of and wanted > share:
            raise RuntimeInputError(
                f"the server has {total} {what} already, of at most {of}; "
                f"you have {own}, and your share is {share}"
            )
