"""Words for numbers of things."""

__all__ = ["several"]


def several(count: int, thing: str) -> str:
    """``count`` and the ``thing``, in the plural unless there is one: "1 agent", "3 agents"."""
    return f"{count} {thing}{'' if count == 1 else 's'}"
