"""Whether two graphs with zones are the same, whatever came before."""

import numpy as np

from navmesh import NodeGraph
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.zones.zones import zones_of

SURFACE = ("link", "clearance", "nearest", "blocker", "source")
DOORS = ("target", "portal", "portal_cell")


def edges_of_pieces(graph: NodeGraph) -> list[tuple]:
    """(node, target, width, gate, border) in the order in which searches see them."""
    switches = zones_of(graph).switches
    found = []
    for node in range(len(graph)):
        slot = switches.head[node]
        while slot >= 0:
            gate, border = switches.gate[slot].tolist(), switches.border[slot].tolist()
            found.append((node, int(switches.target[slot]), float(switches.width[slot]), *gate, *border))
            slot = switches.following[slot]
    return found


def doors_seen(graph: NodeGraph, radius: float) -> list[np.ndarray]:
    """What a search sees of the doors of each node, in its order: nodes, and rows of their doors that are
    open."""
    doors = doors_of(graph, radius, None, None)
    first_slot = len(doors.doors) - len(doors.following)
    rows, nodes = [], []
    for node in range(len(graph)):
        seen = list(range(doors.start[node], doors.start[node + 1]))
        slot = doors.head[node]
        while slot >= 0:
            seen.append(first_slot + slot)
            slot = doors.following[slot]
        seen = [door for door in seen if doors.doors["target"][door] >= 0]
        rows += seen
        nodes += [node] * len(seen)
    columns = [doors.doors[name][rows] for name in DOORS]
    return [np.array(nodes), *columns, doors.lens[rows], doors.block[rows]]


def assert_alike(one: NodeGraph, other: NodeGraph, radii: tuple[float, ...] = (0.2, 0.45)) -> None:
    """All that queries read is the same, bit for bit."""
    assert one.zones == other.zones
    np.testing.assert_array_equal(one.radii, other.radii)
    there = one.radii > 0.0
    np.testing.assert_array_equal(one.positions[there], other.positions[there])
    np.testing.assert_array_equal(one.label, other.label)
    for name in SURFACE:
        np.testing.assert_array_equal(getattr(one.surface, name), getattr(other.surface, name), name)
    a, b = net_of(one), net_of(other)
    for net in (a, b):
        np.testing.assert_array_equal(net.nodes["node_radius"], one.radii)
    np.testing.assert_array_equal(a.nodes["position"][there], b.nodes["position"][there])
    np.testing.assert_array_equal(a.node_cell[there], b.node_cell[there])
    assert edges_of_pieces(one) == edges_of_pieces(other)
    for radius in radii:
        for mine, theirs in zip(doors_seen(one, radius), doors_seen(other, radius), strict=True):
            np.testing.assert_array_equal(mine, theirs)
