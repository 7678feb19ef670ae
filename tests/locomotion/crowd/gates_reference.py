"""Gates found the slow, obvious way, over all cells and one gate after the other."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from navmesh.surface.surface import Surface


def throats(surface: Surface, limit: float) -> np.ndarray:
    """Cells whose nearest walls and those of a cell beside them lie on opposite sides."""
    toward = surface.nearest / np.maximum(surface.clearance, 1e-9)[:, None]
    narrow = surface.clearance < limit
    found = np.zeros(len(surface), bool)
    for way in range(2):
        other = surface.link[:, way]
        between = (other >= 0) & narrow & narrow[other]
        between &= np.sum(toward * toward[other], axis=1) < -0.5
        found[between] = found[other[between]] = True
    return np.flatnonzero(found)


def under_disc(surface: Surface, link: np.ndarray, cell: int) -> list[int]:
    """The cells linked to ``cell`` inside its disc."""
    ix, iy = np.divmod(surface.cell_column, surface.shape[1])
    x, y = (ix + 0.5) * surface.resolution, (iy + 0.5) * surface.resolution
    reach, found, queue = surface.clearance[cell] + 0.5 * surface.resolution, {cell}, [cell]
    for c in queue:
        for other in link[c].tolist():
            if other >= 0 and other not in found:
                dx, dy = x[other] - x[cell], y[other] - y[cell]
                if dx * dx + dy * dy <= reach * reach:
                    found.add(other)
                    queue.append(other)
    return queue


def gates(surface: Surface, limit: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """For each cell: its gate or -1, the distance from its end, the axis; and half the width of each gate."""
    link, centres, cells = surface.link, surface.centers(), throats(surface, limit)
    at = {cell: t for t, cell in enumerate(cells.tolist())}
    beside = []  # of throats, straight or across a corner
    for cell, t in at.items():
        for way in range(4):
            one = int(link[cell, way])
            corner = int(link[one, (way + 1) % 4]) if one >= 0 else -1
            beside += [(t, at[other]) for other in (one, corner) if other in at]
    ends = np.array(beside).T
    lengths = np.linalg.norm(centres[cells[ends[0]]] - centres[cells[ends[1]]], axis=1)
    joined = coo_array((lengths, ends), shape=(len(cells), len(cells))).tocsr()
    count, part = connected_components(joined, directed=False)
    by = np.full(len(surface), -1)
    meet = [(p, p) for p in range(count)]
    for t, cell in enumerate(cells.tolist()):
        for c in under_disc(surface, link, cell):
            by[c] = t if by[c] < 0 else by[c]
            meet.append((part[by[c]], part[t]))
    meeting = coo_array((np.ones(len(meet)), np.array(meet).T), shape=(count, count))
    whole = connected_components(meeting, directed=False)[1]
    clearance = np.zeros(len(surface) + 1)
    clearance[cells] = surface.clearance[cells]
    half = np.maximum(clearance[cells], clearance[link[cells]].max(axis=1))
    across = surface.nearest[cells] / surface.clearance[cells][:, None]
    passage, way = np.column_stack([-across[:, 1], across[:, 0]]), np.zeros(len(cells))
    width = np.empty(whole.max() + 1)
    for number in range(len(width)):
        members = np.flatnonzero(whole[part] == number)
        width[number] = half[members].min()
        against = passage[members] @ passage[members[np.argmin(half[members])]] < 0.0
        passage[members[against]] *= -1.0
    for number in range(count):
        members = np.flatnonzero(part == number)
        own = joined[members][:, members]
        way[members] = dijkstra(own, indices=int(np.argmax(dijkstra(own, indices=0))))
    covered = by >= 0
    gate, along, axis = np.full(len(surface), -1), np.zeros(len(surface)), np.zeros((len(surface), 2))
    gate[covered], along[covered] = whole[part[by[covered]]], way[by[covered]]
    axis[covered] = passage[by[covered]]
    return gate, along, axis, width
