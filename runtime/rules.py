"""Walk rules as people write them: degrees, and only what differs from a person's own."""

import math

import navmesh
from locomotion import PERSON_RULES

__all__ = ["person_walk_rules"]


def person_walk_rules(
    max_slope_deg: float | None = None,
    max_step: float | None = None,
    headroom: float | None = None,
    resolution: float | None = None,
) -> navmesh.WalkRules:
    """Where a person can run [°, m, m, m]; what is None is as `locomotion.PERSON_RULES` has it."""
    given = {
        "max_slope": None if max_slope_deg is None else math.radians(max_slope_deg),
        "max_step": max_step,
        "headroom": headroom,
        "resolution": resolution,
    }
    person = {name: PERSON_RULES[name] for name in ("headroom", "max_slope", "max_step")}
    return navmesh.WalkRules(
        **{**person, **{name: value for name, value in given.items() if value is not None}}
    )
