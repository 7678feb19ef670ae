"""Words for counted things."""

__all__ = ["several"]


def several(count: int, thing: str) -> str:
    """``count`` and ``thing``, in the plural unless it is one: "1 agent", "3 agents"."""
    return f"{count} {thing}{'' if count == 1 else 's'}"
