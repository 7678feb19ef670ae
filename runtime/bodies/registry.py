"""The bodies that there are: a line for each kind.

A game adds its own with `register`: `World.spawn`, missions, playtests and servers know it from then on.
"""

from runtime.bodies.kinds.kind import BodyKind
from runtime.bodies.kinds.person import PersonKind
from runtime.bodies.kinds.quadruped import QuadrupedKind
from runtime.bodies.kinds.remote import RemoteKind
from runtime.bodies.kinds.walker import WalkerKind
from runtime.errors import RuntimeInputError

__all__ = ["USUAL", "body_kinds", "body_names", "is_body_file", "kind_of", "register", "unregister"]

_OURS: tuple[BodyKind, ...] = (
    PersonKind(),
    WalkerKind(),
    QuadrupedKind(),
    RemoteKind(),
)
USUAL = "human"
"""For whom levels are built, and whom missions mean, unless they say otherwise."""
_kinds: list[BodyKind] = list(_OURS)


def body_kinds() -> tuple[BodyKind, ...]:
    """All kinds: the package's, then the others as they were registered."""
    return tuple(_kinds)


def body_names() -> tuple[str, ...]:
    """The names of all bodies that hosts spawn, in the order of `body_kinds`."""
    return tuple(name for kind in _kinds if kind.spawned for name in kind.names)


def is_body_file(body: str) -> bool:
    """Whether some kind takes ``body`` for a file that describes one of its bodies."""
    return any(kind.takes_file(body) for kind in _kinds)


def kind_of(body: str) -> BodyKind:
    """The kind of a body that is called ``body``, or that this file describes. Raises `RuntimeInputError` for
    any other text; the file itself is not opened."""
    for kind in _kinds:
        if body in kind.names or kind.takes_file(body):
            return kind
    valid = ", ".join(map(repr, body_names()))
    files = "".join(f", or {kind.files}" for kind in _kinds if kind.files)
    raise RuntimeInputError(f"body {body!r}: valid: {valid}{files}")


def register(kind: BodyKind) -> None:
    """Add a kind, in this process, for the worlds that are made from now on. Raises `RuntimeInputError` if
    one of its names is taken or is that of a file."""
    for name in kind.names:
        if any(name in known.names for known in _kinds):
            raise RuntimeInputError(f"body {name!r} is taken; names are unique")
        if not isinstance(name, str) or not name.isidentifier():
            raise RuntimeInputError(f"body {name!r}: expected a word of letters, digits and _")
    if not kind.names:
        raise RuntimeInputError("a kind of body has at least one name")
    _kinds.append(kind)


def unregister(kind: BodyKind) -> None:
    """Take back a `register`. Worlds that were made before keep their bodies of this kind. Raises
    `RuntimeInputError` for a kind that is not there, and for the package's own."""
    if kind in _OURS or kind not in _kinds:
        raise RuntimeInputError(f"{kind.names} come with the package or were not registered")
    _kinds.remove(kind)
