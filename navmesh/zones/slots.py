"""Edges of pieces: pairs of slots in lists, one list for each node, see `navmesh.zones.switches.SWITCHES`."""

import numpy as np

from navmesh.zones.switches import FREE, SLOTS, TURNS
from surefoot.kernels import kernel

__all__ = ["add_edge", "let_go"]


@kernel
def let_go(switches, node):
    """Free the slots of a node, and those back to it."""
    following, head = switches.following, switches.head
    slot = np.int64(head[node])
    while slot >= 0:
        after = np.int64(following[slot])
        back = slot ^ 1
        other = np.int64(switches.target[slot])
        at = np.int64(head[other])
        if at == back:
            head[other] = following[back]
        else:
            while following[at] != back:
                at = np.int64(following[at])
            following[at] = following[back]
        pair = min(slot, back)
        following[pair] = switches.numbers[FREE]
        switches.numbers[FREE] = pair
        slot = after
    head[node] = -1


@kernel
def add_edge(switches, a, b, place, border):
    """Take two slots for the edge between nodes ``a`` and ``b``. ``place``: its width, and its gate's x and
    y; ``border``: its border cells, that of ``a`` first."""
    numbers, following, head, target = switches.numbers, switches.following, switches.head, switches.target
    pair = numbers[FREE]
    if pair >= 0:
        numbers[FREE] = following[pair]
    else:
        pair = numbers[SLOTS]
        numbers[SLOTS] += 2
    for way in range(2):
        slot = pair + way
        source, to = (a, b) if way == 0 else (b, a)
        target[slot], switches.made[slot] = to, numbers[TURNS]
        switches.width[slot] = place[0]
        for i in range(2):
            switches.gate[slot, i] = place[1 + i]
            switches.border[slot, i] = border[i if way == 0 else 1 - i]
        at = np.int64(head[source])
        if at < 0 or target[at] > to:
            following[slot] = at
            head[source] = slot
            continue
        while following[at] >= 0 and target[following[at]] < to:
            at = np.int64(following[at])
        following[slot] = following[at]
        following[at] = slot
