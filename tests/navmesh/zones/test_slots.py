"""Lists of edges: by rising target, both ways, and free again when a node goes."""

from collections import defaultdict
from types import SimpleNamespace

import numpy as np

from navmesh.zones.slots import add_edge, let_go
from navmesh.zones.switches import FREE, SLOTS, SWITCHES, TURNS
from surefoot.kernels.bundles import Bundle

NODES, ROOM = 12, 200


def empty_lists():
    arrays = {}
    for name, kind in SWITCHES.fields.items():
        dims = getattr(kind, "ndim", None)
        if dims is None:
            arrays[name] = 0
        else:
            dtype = np.dtype(str(kind.dtype))
            arrays[name] = np.zeros((ROOM,) if dims == 1 else (ROOM, 2), dtype)
    arrays["head"][:] = -1
    arrays["numbers"][:] = 0
    arrays["numbers"][FREE] = -1
    return SimpleNamespace(**arrays), Bundle(SWITCHES, **arrays)


def test_lists_are_those_of_a_dictionary():
    arrays, switches = empty_lists()
    rng = np.random.default_rng(0)
    wanted: dict[int, dict[int, float]] = defaultdict(dict)
    most = 0
    for step in range(400):
        arrays.numbers[TURNS] = step
        a, b = (int(node) for node in rng.choice(NODES, 2, replace=False))
        if rng.random() < 0.1:
            let_go(switches, a)
            for other in wanted.pop(a, {}):
                del wanted[other][a]
        elif b not in wanted[a]:
            width = float(rng.random())
            add_edge(switches, a, b, (width, 1.0, 2.0), (10 * a, 10 * b))
            wanted[a][b] = wanted[b][a] = width
        most = max(most, sum(map(len, wanted.values())))
        for node in range(NODES):
            found, slot = [], arrays.head[node]
            while slot >= 0:
                target = int(arrays.target[slot])
                found.append((target, float(arrays.width[slot])))
                assert arrays.border[slot].tolist() == [10 * node, 10 * target]
                assert arrays.target[slot ^ 1] == node
                slot = arrays.following[slot]
            assert found == sorted(wanted[node].items())
    assert arrays.numbers[SLOTS] == most > 40
