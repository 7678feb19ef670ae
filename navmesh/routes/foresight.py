"""What walking a line through discs takes, asked for before it is walked.

A walk goes from where one disc ends to where the next one does (`navmesh.surface.clearance_field.walk`), and
waits for the memory of each of these places. The chain of discs says beforehand where they are.
"""

from math import sqrt

import numpy as np

from navmesh.surface.clearance_field import fetch_cell
from navmesh.surface.columns import about_column, column_of
from surefoot.kernels import kernel
from surefoot.kernels.fetching import fetch

__all__ = ["fetch_corners", "fetch_line"]


@kernel(error_model="numpy", forceinline=True)
def _where_it_leaves(net, node, ax, ay, ux, uy, length, room):
    """The column in which the line from a along the unit vector u leaves the disc of ``node``, shrunk by
    ``room``, or ends; -1 where it misses the disc."""
    dx, dy = net.position[node, 0] - ax, net.position[node, 1] - ay
    along, off = dx * ux + dy * uy, dx * uy - dy * ux
    radius = net.node_radius[node] - room
    inside = radius * radius - off * off
    if (radius <= 0.0) | (inside < 0.0):
        return np.int64(-1)
    far = min(along + sqrt(inside), length)
    ix, iy = np.int64((ax + far * ux) / net.cell), np.int64((ay + far * uy) / net.cell)
    return ix * net.ny + iy if (0 <= ix < net.nx) & (0 <= iy < net.ny) else np.int64(-1)


@kernel(error_model="numpy")
def fetch_line(net, nodes, low, high, ax, ay, bx, by, radius):
    """Ask for the memory that a body of ``radius`` takes to walk from a to b through nodes[low:high]."""
    dx, dy = bx - ax, by - ay
    length = sqrt(dx * dx + dy * dy)
    if length <= 0.0:
        return
    ux, uy, room = dx / length, dy / length, max(radius, 0.7072 * net.cell)
    for i in range(low, high):
        fetch(net.column_start, _where_it_leaves(net, np.int64(nodes[i]), ax, ay, ux, uy, length, room))
    for i in range(low, high):
        column = _where_it_leaves(net, np.int64(nodes[i]), ax, ay, ux, uy, length, room)
        if column >= 0:
            fetch_cell(net, np.int64(net.column_start[column]))


@kernel(error_model="numpy", forceinline=True)
def _cell_of(doors, edges, at):
    """The cell at the end of a portal, told as `navmesh.routes.funnel.funnel` does."""
    return np.int64(doors.portal_cell[edges[at >> 1], at & 1])


@kernel(error_model="numpy")
def fetch_corners(net, doors, edges, at, count):
    """Ask for the memory that it takes to find the room around the corners of a funnel, but its ends: ``at``
    (count,) are the ends of portals where they are."""
    for i in range(1, count - 1):
        k = _cell_of(doors, edges, at[i])
        fetch_cell(net, k)
        fetch(net.column_start, about_column(net, k))
    for i in range(1, count - 1):
        k = _cell_of(doors, edges, at[i])
        column = column_of(net, k)
        fetch(net.column_start, column - net.ny)
        fetch(net.column_start, column)
        fetch(net.column_start, column + net.ny)
        fetch(net.list_start, np.int64(net.source[k]))
    for i in range(1, count - 1):
        source = np.int64(net.source[_cell_of(doors, edges, at[i])])
        if source >= 0:
            first = np.int64(net.list_start[source])
            fetch(net.blocker, first)
            fetch(net.blocker, first + 2)
