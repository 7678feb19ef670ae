"""What the graph and the geometry prove, before any bot has walked: `analyse`."""

from collections.abc import Iterator, Mapping

import numpy as np

from runtime.playtest.barriers import Barrier, Barriers
from runtime.playtest.fault import Fault
from runtime.playtest.holes import find_holes
from runtime.playtest.passages import narrow_passages
from runtime.playtest.site import Site
from runtime.playtest.solids import is_inside_solid
from runtime.playtest.wording import Wording, triple

__all__ = ["LEAST_AREA", "analyse", "core_parts"]

LEAST_AREA = 1.0
"""[m²] parts with less room for the body's middle are not worth a word."""
PIT = 25.0
"""[m²] what cannot be left again is a trap up to this size, and a one-way part of the level above."""
ALMOST = 0.5
"""[m] a rise that is out of reach by no more than this is taken for a mistake, and not for a wall."""
_ALMOST_GAP = 1.0  # [m] the same for a gap
_SLIT = 0.3  # [m] passages narrower than this are cracks
_TOP = 0.6  # [m] parts that are nowhere as wide are the tops of walls and the like, and no floors
_LOW_STEP = 0.35  # [m] rises up to this are steps, higher ones ledges


def core_parts(site: Site) -> np.ndarray:
    """The parts that a player is taken to start from when no spawn is named: the largest part, and those
    that can be reached from it and lead back."""
    largest = int(np.argmax(site.areas))
    return np.flatnonzero(site.loops == site.loops[largest])


def analyse(site: Site, spawns: np.ndarray, forbidden: np.ndarray, wanted: np.ndarray) -> list[Fault]:
    """The faults of a level for players who start in the parts ``spawns`` (s,).

    ``forbidden`` are parts that nobody should reach, ``wanted`` parts that somebody expects to be
    reached; indices.
    """
    return [
        *_unreachable(site, spawns, set(forbidden.tolist()), set(wanted.tolist())),
        *_no_return(site, spawns),
        *_holes(site),
        *_narrow(site, spawns),
        *_unusable(site),
    ]


def _unreachable(site: Site, spawns: np.ndarray, forbidden: set[int], wanted: set[int]) -> list[Fault]:
    words, barriers = Wording(site.character), Barriers(site)
    reached = site.reached(spawns)
    faults, tops = [], []
    for parts in _first_missing(site, reached):
        area = float(site.areas[parts].sum())
        if area < LEAST_AREA or forbidden & set(parts.tolist()):
            continue
        is_wanted = bool(wanted & set(parts.tolist()))
        if not is_wanted and 2.0 * site.graph.radii[np.isin(site.node_part, parts)].max() < _TOP:
            tops.append(parts)
        elif is_wanted or not is_inside_solid(site, site.centre_of(int(parts[0]))):
            faults.append(_explained(site, barriers, words, reached, parts, is_wanted))
    if tops:
        areas = [float(site.areas[parts].sum()) for parts in tops]
        place = site.centre_of(int(tops[int(np.argmax(areas))][0]))
        text = words.tops(place, len(tops), sum(areas), _TOP)
        faults.append(Fault("tops", triple(place), text, False, extent=sum(areas)))
    return faults


def _first_missing(site: Site, reached: np.ndarray) -> Iterator[np.ndarray]:
    """The parts (k,) that are not ``reached``, in groups that one way in would open: first those that lead
    on to others, with all that they lead to."""
    left = ~reached
    order = np.argsort([-site.reached(np.array([part])).sum() for part in range(len(left))], kind="stable")
    for part in order.tolist():
        if left[part]:
            group = np.flatnonzero(left & site.reached(np.array([part])))
            left[group] = False
            # the group's own part first: it is where the way in is missing
            yield np.concatenate([[part], group[group != part]])


def _explained(
    site: Site, barriers: Barriers, words: Wording, reached: np.ndarray, parts: np.ndarray, wanted: bool
) -> Fault:
    """Why ``parts`` cannot be reached, from the easiest thing to mend to the hardest."""
    skills, graph = site.character, site.graph
    node_reached = np.append(reached, False)[site.node_part]
    node_there = np.isin(site.node_part, parts)
    cell_reached, cell_there = (_on_cells(site, nodes) for nodes in (node_reached, node_there))
    centre, area = site.centre_of(int(parts[0])), float(site.areas[parts].sum())

    def fault(kind: str, barrier: Barrier | None, fails: bool) -> Fault:
        place = centre if barrier is None else barrier.place
        text = words.unreachable(kind, centre, area, barrier)
        return Fault(kind, triple(place), text, fails or wanted, extent=area)

    narrow = barriers.narrow(node_reached, node_there)
    if narrow is not None and narrow.size >= _SLIT:
        return fault("narrow", narrow, True)
    rise = barriers.rise(cell_reached, cell_there)
    if rise is not None and 0.0 < rise.size <= max(skills.reach("jump"), graph.rules.max_step) + ALMOST:
        return fault("step" if rise.size <= _LOW_STEP else "ledge", rise, True)
    gap = barriers.gap(node_reached, node_there)
    if gap is not None and 0.0 < skills.reach("gap") <= gap.size <= skills.reach("gap") + _ALMOST_GAP:
        return fault("gap", gap, True)
    wall = barriers.wall(cell_reached, cell_there)
    if wall is not None:
        return fault("walled_off", wall, True)
    return fault("unreachable", gap or rise, False)


def _on_cells(site: Site, nodes: np.ndarray) -> np.ndarray:
    """(n,) bool: the cells that belong to ``nodes`` (m,) bool."""
    label = site.graph.label
    return (label >= 0) & nodes[label]


def _no_return(site: Site, spawns: np.ndarray) -> list[Fault]:
    """What is entered but not left again: traps where it ends, one-way parts where it goes on elsewhere."""
    words, barriers = Wording(site.character), Barriers(site)
    lost = site.reached(spawns) & ~site.returning(spawns)
    faults = []
    back = np.append(site.returning(spawns), False)[site.node_part]
    for loop in np.unique(site.loops[lost]):
        inside = site.loops == loop
        area = float(site.areas[inside].sum())
        if area < LEAST_AREA:
            continue
        ends = not (inside[site.way_from] & ~inside[site.way_to]).any()
        kind = "trap" if ends and area <= PIT else "one_way"
        entries = site.ways[~inside[site.way_from] & inside[site.way_to]]
        there = np.append(inside, False)[site.node_part]
        out = barriers.rise(_on_cells(site, there), _on_cells(site, back))
        largest = int(np.flatnonzero(inside)[np.argmax(site.areas[inside])])
        entry = _entry(site, entries)
        text = words.no_return(kind, site.centre_of(largest), area, entry, out)
        faults.append(Fault(kind, triple(site.centre_of(largest)), text, extent=area))
    return faults


def _entry(site: Site, entries: np.ndarray) -> Mapping[str, object]:
    """The way in: of several the one in the middle of them."""
    links = site.graph.links
    link = int(entries[len(entries) // 2])
    return {
        "affordance": str(links.affordance[link]),
        "height": float(links.height[link]),
        "place": links.edge[link],
    }


def _holes(site: Site) -> list[Fault]:
    words = Wording(site.character)
    faults = []
    for hole in find_holes(site):
        kind = "hole" if hole.enclosed else "open_edge"
        text = (
            words.hole(hole.place, hole.area) if hole.enclosed else words.open_edge(hole.place, len(hole.rim))
        )
        faults.append(
            Fault(kind, triple(hole.place), text, hole.enclosed, extent=hole.area if hole.enclosed else 0.0)
        )
    return faults


def _narrow(site: Site, spawns: np.ndarray) -> list[Fault]:
    """Passages that the body does not fit through where the way around is long."""
    words = Wording(site.character)
    reached = site.reached(spawns)
    return [
        Fault("narrow", triple(each.place), words.passage(each.place, each.width, each.through, each.around))
        for each in narrow_passages(site, reached)
    ]


def _unusable(site: Site) -> list[Fault]:
    """Obstacles within the range of a skill over which no link leads that the body can take."""
    words = Wording(site.character)
    obstacles, links = site.graph.obstacles, site.graph.links
    used, sizes = np.unique(links.obstacle[site.ways]), obstacles.size
    faults = []
    for index in range(len(obstacles)):
        name = str(obstacles.affordance[index])
        low, high = site.character.skills.get(name, (1.0, 0.0))
        if not low <= round(float(sizes[index]), 4) <= high or index in used:
            continue
        text = words.unusable(obstacles, index)
        faults.append(
            Fault("unusable", triple(obstacles.position[index]), text, bool(obstacles.authored[index]))
        )
    return faults
