"""Where bots start and where they go: what the plan says, and sensible places where it says nothing."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from runtime.errors import RuntimeInputError
from runtime.playtest.analysis import LEAST_AREA, core_parts
from runtime.playtest.bots import Goals
from runtime.playtest.floor_edges import edges_of
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.site import Site

__all__ = ["PATCH", "make_goals", "patches_of", "spawn_parts"]

PATCH = 1.0
"""[m] side of a patch: what coverage counts."""
_SPAWNS, _PLACES = 4, 8
"""How many are chosen where the plan names none."""


def spawn_parts(site: Site, plan: LoadedPlan) -> np.ndarray:
    """The parts that players start in. Raises `FileError` for a spawn where nobody fits."""
    spawns = plan.plan.spawns
    if not spawns:
        return core_parts(site)
    return np.unique(place_parts(site, plan, "spawns"))


def place_parts(site: Site, plan: LoadedPlan, kind: str) -> np.ndarray:
    """The part of each of the plan's ``kind``, "spawns" or "places"; errors name the line."""
    entries = getattr(plan.plan, kind)
    parts = site.part_at(np.array([entry.at for entry in entries]).reshape(-1, 3))
    for i in np.flatnonzero(parts < 0).tolist():
        problem = f"{kind}[{i}].at: {entries[i].at} is not near a place where a {site.character.noun} fits"
        raise plan.error((kind, i, "at"), problem)
    return parts


def patches_of(site: Site, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The patches of floor of ``parts`` (p,) bool: (n, 3) float64 [m], a place near the middle of each
    where the body fits; and the patch of every cell (c,) int, -1 for none."""
    surface = site.graph.surface
    cells = np.flatnonzero(np.append(parts, False)[site.cell_part])
    per = max(1, round(PATCH / surface.resolution))
    ix, iy = np.divmod(surface.columns(cells), surface.shape[1])
    storey = np.round(surface.heights(cells) / site.graph.rules.headroom)
    keys = np.column_stack([ix // per, iy // per, storey.astype(np.int64), site.cell_part[cells]])
    _, patch = np.unique(keys, axis=0, return_inverse=True)
    patch = patch.reshape(-1)
    centres = surface.centers(cells)
    room = surface.clearance[cells]
    order = np.lexsort((cells, -room, patch))
    first = np.concatenate([[True], np.diff(patch[order]) != 0]) if len(order) else np.zeros(0, dtype=bool)
    patch_of = np.full(len(surface), -1)
    patch_of[cells] = patch
    return centres[order[first]], patch_of


def make_goals(site: Site, plan: LoadedPlan, rng: np.random.Generator) -> Goals:
    """Spawns and places of ``plan``; what it leaves out is spread over the parts that players reach."""
    if not len(site.areas):
        raise RuntimeInputError(
            f"{site.graph.terrain.name}: a {site.character.noun} fits nowhere on it; check the up axis "
            "and the unit scale, or say in the playtest file who plays"
        )
    starts = spawn_parts(site, plan)
    reached = site.reached(starts) & (site.areas >= LEAST_AREA)
    if not reached.any():
        raise RuntimeInputError(
            f"{site.graph.terrain.name}: players reach no part with {LEAST_AREA:g} m² of room for the middle "
            f"of a {site.character.noun}; check the unit scale, or say in the playtest file who plays"
        )
    targets, _ = patches_of(site, reached)
    spawns, places = plan.plan.spawns, [each for each in plan.plan.places if each.reachable]
    if spawns:
        spawn_names, spawn_at = tuple(each.name for each in spawns), np.array([each.at for each in spawns])
    else:
        at_start, _ = patches_of(site, np.isin(np.arange(len(site.areas)), starts))
        spawn_at = _spread(at_start, _SPAWNS, rng)
        spawn_names = tuple(f"spawn{k + 1}" for k in range(len(spawn_at)))
    if places:
        place_names, place_at = tuple(each.name for each in places), np.array([each.at for each in places])
    else:
        place_at = _spread(targets, _PLACES, rng)
        place_names = tuple(f"place{k + 1}" for k in range(len(place_at)))
    links = site.graph.links
    obstacles = np.unique(links.obstacle[site.ways[reached[site.way_from]]])
    edges = edges_of(site, reached)
    return Goals(spawn_names, spawn_at, place_names, place_at, targets, tuple(obstacles.tolist()), *edges)


def _spread(points: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """``count`` of ``points`` (k, 3), far from each other: each next one the farthest from those before."""
    chosen = [int(rng.integers(len(points)))]
    while len(chosen) < min(count, len(points)):
        away: ArrayLike = KDTree(points[chosen]).query(points)[0]
        chosen.append(int(np.argmax(away)))
    return points[chosen]
