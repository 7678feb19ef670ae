"""What the plan expects and the level does not keep: places that can be reached and should not be, ways
too long."""

from collections.abc import Iterator

import numpy as np

from runtime.playtest.fault import Fault
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.site import Site
from runtime.playtest.wording import place, triple

__all__ = ["broken_expectations"]


def broken_expectations(site: Site, plan: LoadedPlan, starts: np.ndarray, at: np.ndarray) -> Iterator[Fault]:
    """Faults for the expectations of ``plan`` that do not hold; ``starts`` are the parts of the spawns,
    ``at`` (p,) the part of each place. Places that cannot be reached are `analyse`'s."""
    reached = site.reached(starts)
    points = {each.name: np.array(each.at) for each in (*plan.plan.spawns, *plan.plan.places)}
    for entry, part in zip(plan.plan.places, at.tolist(), strict=True):
        if not entry.reachable and reached[part]:
            text = (
                f"{entry.name} at {place(entry.at)} can be reached; the playtest file says that nobody should"
            )
            yield Fault("forbidden", triple(entry.at), text)
    for route in plan.plan.routes:
        skills = dict(site.character.skills)
        way = site.graph.find_path(points[route.start], points[route.to], site.character.radius, skills)
        far = f"the way from {route.start} to {route.to}"
        if way.status != "complete":
            yield Fault(
                "detour",
                triple(points[route.to]),
                f"{far} does not exist; at most {route.at_most:g} m are allowed",
            )
        elif way.length > route.at_most:
            text = f"{far} is {way.length:.1f} m long; at most {route.at_most:g} m are allowed"
            yield Fault("detour", triple(points[route.to]), text)
