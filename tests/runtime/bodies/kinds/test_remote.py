"""The kind of remote figures: in every world, and never spawned."""

from runtime.bodies.kinds.remote import RemoteKind
from runtime.bodies.registry import body_kinds, body_names, kind_of


def test_it_is_known_and_not_offered():
    kind = kind_of("remote")
    assert isinstance(kind, RemoteKind) and kind in body_kinds() and "remote" not in body_names()
    assert kind.noun("remote") == "remote figure" and not kind.spawned
