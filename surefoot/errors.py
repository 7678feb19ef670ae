"""Base class of all errors raised for wrong input."""

__all__ = ["SurefootError"]


class SurefootError(ValueError):
    """Wrong input: the message says what is wrong, where, and what would be right. `navmesh.NavmeshError`,
    `locomotion.LocomotionError` and `runtime.RuntimeInputError` derive from it."""
