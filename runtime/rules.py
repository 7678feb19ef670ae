"""Walk rules as people write them: degrees, and only what differs from the default."""

import math

import navmesh

__all__ = ["walk_rules"]


def walk_rules(
    max_slope_deg: float | None = None,
    max_step: float | None = None,
    headroom: float | None = None,
    resolution: float | None = None,
) -> navmesh.WalkRules:
    """Rules with the given values [°, m, m, m]; what is None keeps the default of `navmesh.WalkRules`."""
    given = {
        "max_slope": None if max_slope_deg is None else math.radians(max_slope_deg),
        "max_step": max_step,
        "headroom": headroom,
        "resolution": resolution,
    }
    return navmesh.WalkRules(**{name: value for name, value in given.items() if value is not None})
