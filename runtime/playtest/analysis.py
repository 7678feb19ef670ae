"""What the graph and the geometry prove, before any bot has walked: `analyse`."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from runtime.playtest.barriers import HIGHEST, Barriers
from runtime.playtest.fault import Fault
from runtime.playtest.holes import Hole
from runtime.playtest.openings import Barrier
from runtime.playtest.passages import narrow_passages
from runtime.playtest.sides import Side
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
_TOP = 0.6  # [m] parts that are nowhere as wide are the tops of walls and the like, and no floors
_EVEN = 3.0  # [°] that a ramp's slope may differ from that of the way up it
_TOLD = 20  # notes on parts that cannot be reached that are told one by one, the largest
_LOW_STEP = 0.35  # [m] rises up to this are steps, higher ones ledges


def core_parts(site: Site) -> np.ndarray:
    """The parts that a player is taken to start from when no spawn is named: the largest part, and those
    that can be reached from it and lead back."""
    largest = int(np.argmax(site.areas))
    return np.flatnonzero(site.loops == site.loops[largest])


def analyse(
    site: Site, holes: Sequence[Hole], spawns: np.ndarray, forbidden: np.ndarray, wanted: np.ndarray
) -> list[Fault]:
    """The faults of a level with ``holes`` for players who start in the parts ``spawns`` (s,).

    ``forbidden`` are parts that nobody should reach, ``wanted`` parts that somebody expects to be
    reached; indices.
    """
    return [
        *_unreachable(site, spawns, set(forbidden.tolist()), set(wanted.tolist())),
        *_no_return(site, spawns),
        *_hole_faults(site, holes),
        *_narrow(site, spawns),
        *_unusable(site),
    ]


def _unreachable(site: Site, spawns: np.ndarray, forbidden: set[int], wanted: set[int]) -> list[Fault]:
    words, barriers = Wording(site.character), Barriers(site)
    reached = site.reached(spawns)
    here = site.side(reached)
    faults, tops = [], []
    for parts in _first_missing(site, reached):
        area = float(site.areas[parts].sum())
        if area < LEAST_AREA or forbidden & set(parts.tolist()):
            continue
        is_wanted = bool(wanted & set(parts.tolist()))
        if not is_wanted and 2.0 * site.graph.radii[np.isin(site.node_part, parts)].max() < _TOP:
            tops.append(parts)
        elif is_wanted or not is_inside_solid(site, site.centre_of(int(parts[0]))):
            faults.append(_explained(site, barriers, words, here, parts, is_wanted))
    faults = _shortened(words, faults)
    if tops:
        areas = [float(site.areas[parts].sum()) for parts in tops]
        place = site.centre_of(int(tops[int(np.argmax(areas))][0]))
        text = words.tops(place, len(tops), sum(areas), _TOP)
        faults.append(Fault("tops", triple(place), text, False, extent=sum(areas)))
    return faults


def _shortened(words: Wording, faults: list[Fault]) -> list[Fault]:
    """``faults``, with the smallest of many notes on what cannot be reached, such as the roofs of a city,
    told in one."""
    notes = [fault for fault in faults if fault.kind == "unreachable" and not fault.fails]
    rest = sorted(notes, key=lambda fault: -fault.extent)[_TOLD:]
    if len(rest) < 2:
        return faults
    area = sum(fault.extent for fault in rest)
    text = words.more_unreachable(rest[0].position, len(rest), area, rest[0].extent)
    kept = [fault for fault in faults if not any(fault is each for each in rest)]
    return [*kept, Fault("unreachable", rest[0].position, text, False, extent=area)]


def _first_missing(site: Site, reached: np.ndarray) -> Iterator[np.ndarray]:
    """The parts (k,) that are not ``reached``, in groups that one way in would open: first those that lead
    on to others, with all that they lead to."""
    left = ~reached
    ends = np.diff(site.arcs.indptr) == 0  # they lead nowhere else

    def led_to(part: int) -> np.ndarray:
        return np.array([part]) if ends[part] else np.flatnonzero(site.reached(np.array([part])))

    order = np.argsort([-len(led_to(part)) for part in range(len(left))], kind="stable")
    for part in order.tolist():
        if left[part]:
            group = led_to(part)
            group = group[left[group]]
            left[group] = False
            # the group's own part first: it is where the way in is missing
            yield np.concatenate([[part], group[group != part]])


def _explained(
    site: Site, barriers: Barriers, words: Wording, here: Side, parts: np.ndarray, wanted: bool
) -> Fault:
    """Why ``parts`` cannot be reached, from the easiest thing to mend to the hardest."""
    character = site.character
    there = Side(site.graph.surface, site.cells_of(*parts.tolist()))
    centre, area = site.centre_of(int(parts[0])), float(site.areas[parts].sum())
    climb = max(character.reach("onto"), site.graph.rules.max_step) + ALMOST
    barrier = barriers.between(here, there, climb)
    kind, fails = "unreachable", False
    if barrier is None:
        barrier = barriers.ledge(here, there)
    elif barrier.kind in ("narrow", "low"):
        kind, fails = barrier.kind, True
    elif barrier.kind == "steep":
        kind, fails = "steep", _is_ramp(barrier)
    elif barrier.kind == "wall":
        kind, fails = "walled_off", True
    elif barrier.kind == "rise" and barrier.size > 0.0:
        kind, fails = "step" if barrier.size <= _LOW_STEP else "ledge", True
    elif barrier.kind == "gap":
        low, high = character.span("across")
        if 0.0 < high and (barrier.size < low or high <= barrier.size <= high + _ALMOST_GAP):
            kind, fails = "gap", True
    text = words.unreachable(centre, area, barrier)
    return _measured(kind, centre, text, barrier, fails or wanted, area)


def _is_ramp(steep: Barrier) -> bool:
    """Whether a slope is even, from its foot to its head: something built to be walked up, and no
    hillside."""
    x, y, z = np.abs(steep.span[1] - steep.span[0])
    return abs(math.degrees(math.atan2(z, math.hypot(x, y))) - steep.size) <= _EVEN


def _measured(
    kind: str, centre: np.ndarray, text: str, barrier: Barrier | None, fails: bool, area: float = 0.0
) -> Fault:
    """The fault at ``barrier``, or where there is none at ``centre``."""
    if barrier is None:
        return Fault(kind, triple(centre), text, fails, extent=area)
    if barrier.kind == "wall":  # nobody asks how thick it is
        return Fault(kind, triple(barrier.place), text, fails, extent=area)
    span = tuple(triple(end) for end in barrier.span)
    size = round(abs(float(barrier.size)), 3) if np.isfinite(barrier.size) else None
    return Fault(kind, triple(barrier.place), text, fails, extent=area, size=size, span=span)


def _no_return(site: Site, spawns: np.ndarray) -> list[Fault]:
    """What is entered but not left again: traps where it ends, one-way parts where it goes on elsewhere."""
    words, barriers = Wording(site.character), Barriers(site)
    lost = site.reached(spawns) & ~site.returning(spawns)
    faults = []
    back = site.side(site.returning(spawns))
    for loop in np.unique(site.loops[lost]):
        inside = site.loops == loop
        area = float(site.areas[inside].sum())
        if area < LEAST_AREA:
            continue
        ends = not (inside[site.way_from] & ~inside[site.way_to]).any()
        kind = "trap" if ends and area <= PIT else "one_way"
        entries = site.ways[~inside[site.way_from] & inside[site.way_to]]
        there = site.side(inside)
        out = barriers.between(there, back, HIGHEST) or barriers.ledge(there, back)
        if out is not None and out.kind in ("gap", "wall"):
            out = barriers.ledge(there, back) or out
        largest = int(np.flatnonzero(inside)[np.argmax(site.areas[inside])])
        centre, entry = site.centre_of(largest), _entry(site, entries)
        text = words.no_return(kind, centre, area, entry, out)
        size = None if out is None else round(abs(float(out.size)), 3)
        span = () if out is None else tuple(triple(end) for end in out.span)
        faults.append(Fault(kind, triple(centre), text, extent=area, size=size, span=span))
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


def _hole_faults(site: Site, holes: Sequence[Hole]) -> list[Fault]:
    """Holes are faults, open edges notes."""
    words = Wording(site.character)
    faults = []
    for hole in holes:
        if not hole.enclosed:
            faults.append(Fault("open_edge", triple(hole.place), words.open_edge(hole), False))
            continue
        size = round(float(np.linalg.norm(hole.span[1] - hole.span[0])), 3)
        span = tuple(triple(end) for end in hole.span)
        area = round(hole.area, 3)
        faults.append(Fault("hole", triple(hole.place), words.hole(hole), extent=area, size=size, span=span))
    return faults


def _narrow(site: Site, spawns: np.ndarray) -> list[Fault]:
    """Passages that the body does not fit through where the way around is long."""
    words = Wording(site.character)
    return [
        _measured(
            "narrow",
            each.barrier.place,
            words.passage(each.barrier, each.through, each.around),
            each.barrier,
            True,
        )
        for each in narrow_passages(site, site.reached(spawns))
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
