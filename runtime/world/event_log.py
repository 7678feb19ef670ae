"""The events of a world: kept until they are read, and told to who listens."""

from collections import deque
from collections.abc import Callable, Iterable
from typing import TypeVar

from runtime.errors import RuntimeInputError
from runtime.events import Event

__all__ = ["EventLog"]

_UNREAD = 100_000  # events that are kept for one who does not read them; the oldest are forgotten first
_E = TypeVar("_E", bound=Event)


class EventLog:
    """What has happened, in order. ``unread``: since `read`; ``untold``: since `tell`, if anybody listens."""

    def __init__(self) -> None:
        self.unread: deque[Event] = deque(maxlen=_UNREAD)
        self.untold: deque[Event] = deque()
        self._listeners: list[tuple[type[Event], Callable[[Event], object]]] = []

    def report(self, event: Event) -> None:
        """Add an event. Raises `RuntimeInputError` for anything else."""
        if not isinstance(event, Event):
            raise RuntimeInputError(f"expected an Event, got {event!r}")
        self.unread.append(event)
        if self._listeners:
            self.untold.append(event)

    def read(self) -> list[Event]:
        """What is unread, which it is not any more."""
        events = list(self.unread)
        self.unread.clear()
        return events

    def listen(self, callback: Callable[[_E], object], kind: type[_E]) -> Callable[[], None]:
        """As `runtime.World.listen`."""
        if not callable(callback) or not (isinstance(kind, type) and issubclass(kind, Event)):
            raise RuntimeInputError(
                f"listen takes a function and a class of events, not {callback!r} and {kind!r}"
            )
        entry: tuple[type[Event], Callable[[Event], object]] = (kind, callback)  # type: ignore[assignment]
        self._listeners.append(entry)

        def stop() -> None:
            self._listeners = [each for each in self._listeners if each is not entry]

        return stop

    def tell(self) -> None:
        """Call the listeners for what is untold; what they report themselves is told the next time."""
        for _ in range(len(self.untold)):
            event = self.untold.popleft()
            for kind, callback in tuple(self._listeners):
                if isinstance(event, kind):
                    callback(event)

    def become(self, unread: Iterable[Event], untold: Iterable[Event]) -> None:
        """Go on with these; who listens stays."""
        self.unread, self.untold = deque(unread, maxlen=_UNREAD), deque(untold)
