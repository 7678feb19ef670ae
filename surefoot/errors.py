"""The error that every wrong input raises."""

__all__ = ["SurefootError"]


class SurefootError(ValueError):
    """Wrong input: the message says what is wrong, where, and what would be right. `navmesh.NavmeshError`,
    `locomotion.LocomotionError` and `runtime.RuntimeInputError` are of this kind."""
