"""What queries work out once and keep: for each kind of it, what was used last."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any

__all__ = ["KEPT", "recent"]

KEPT = 16
"""Values of one kind that are kept: radii, offers of skills, sets of costs."""


def recent(cache: dict[str, Any], kind: str, key: Hashable, make: Callable[[], Any]) -> Any:
    """The value of ``key``, made where it is not kept; of each ``kind``, the `KEPT` used last stay in
    ``cache``."""
    kept = cache.get(kind)
    if kept is None:
        kept = cache.setdefault(kind, OrderedDict())
    found = kept.get(key)
    if found is None:
        found = kept[key] = make()
        while len(kept) > KEPT:
            kept.popitem(last=False)
    else:
        try:
            kept.move_to_end(key)
        except KeyError:  # dropped by another thread meanwhile
            pass
    return found
