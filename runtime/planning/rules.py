"""Walk rules as people write them: degrees, and only what differs from what the bodies need."""

import math
from collections.abc import Iterable, Mapping

import navmesh
from locomotion import PERSON_RULES
from navmesh.obstacles.kinds import obstacle_kinds
from runtime.bodies.registry import USUAL, kind_of
from runtime.errors import RuntimeInputError

__all__ = ["obstacle_rules", "person_walk_rules", "walk_rules"]


def person_walk_rules(
    max_slope_deg: float | None = None,
    max_step: float | None = None,
    headroom: float | None = None,
    resolution: float | None = None,
) -> navmesh.WalkRules:
    """Where a person can run [°, m, m, m]; what is None is as `locomotion.PERSON_RULES` has it."""
    return walk_rules(
        [USUAL], max_slope_deg=max_slope_deg, max_step=max_step, headroom=headroom, resolution=resolution
    )


def walk_rules(
    bodies: Iterable[str],
    max_slope_deg: float | None = None,
    max_step: float | None = None,
    headroom: float | None = None,
    resolution: float | None = None,
) -> navmesh.WalkRules:
    """Where every one of ``bodies`` can go [°, m, m, m]; what is None is as the most demanding of them needs
    it."""
    if max_slope_deg is not None and not 0.0 <= max_slope_deg < 90.0:
        raise RuntimeInputError(
            f"max_slope_deg = {max_slope_deg:g}: expected degrees, 0 or more and below 90"
        )
    needs = [kind_of(body).walk_rules(body) for body in bodies]
    given = {
        "max_slope": None if max_slope_deg is None else math.radians(max_slope_deg),
        "max_step": max_step,
        "headroom": headroom,
        "resolution": resolution,
    }
    common = {
        "headroom": max(each.headroom for each in needs),
        "max_slope": min(each.max_slope for each in needs),
        "max_step": min(each.max_step for each in needs),
        "min_radius": min(each.min_radius for each in needs),
        "resolution": min(each.resolution for each in needs),
    }
    return navmesh.WalkRules(
        **{**common, **{name: value for name, value in given.items() if value is not None}}
    )


def obstacle_rules(
    skills: Mapping[str, tuple[float, float]], body_radius: float = PERSON_RULES["radius"]
) -> navmesh.ObstacleRules:
    """What counts as an obstacle for a body of ``body_radius`` [m] with ``skills`` (least and greatest size
    [m] by affordance): all that it can clear, and the usual rest."""
    usual, ranges = navmesh.ObstacleRules(), {}
    for kind in obstacle_kinds():
        if (looked_for := usual.range_of(kind)) is not None:
            ranges[kind.rule] = _both(looked_for, skills.get(kind.affordance))
    return navmesh.ObstacleRules(**ranges, body_radius=body_radius)


def _both(usual: tuple[float, float], own: tuple[float, float] | None) -> tuple[float, float]:
    if own is None:
        return usual
    return min(usual[0], max(own[0], 1e-3)), max(usual[1], own[1])
