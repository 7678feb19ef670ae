"""Corners that lead a line round what it comes too near, or what ends walking on it."""

from math import sqrt

import numpy as np

from navmesh.graph.portals import MARGIN
from navmesh.routes.funnel import tangents
from navmesh.surface.clearance_field import gap_at, walk
from navmesh.surface.ridges import middle
from surefoot.kernels import kernel

__all__ = ["SLACK", "lead_round", "push_off", "round_in_disc"]

SLACK = 0.01
"""Share of the radius kept on top of it where there is room: discs of the corridor hold the path inside."""


@kernel(error_model="numpy")
def push_off(net, k, x, y, qx, qy, radius):
    """Move (x, y) in cell ``k`` away from (qx, qy) until the body fits with a margin; returns (fits, x, y,
    cell)."""
    target = radius * (1.0 + MARGIN)
    enough = radius * (1.0 + SLACK)
    gap = 0.0
    first = k
    ax, ay = x, y
    for _ in range(4):
        dx = x - qx
        dy = y - qy
        d = sqrt(dx * dx + dy * dy)
        if d < 1e-9:
            return False, x, y, k
        nx = qx + dx / d * target
        ny = qy + dy / d * target
        reached, cell = walk(net, k, x, y, nx, ny, 0.0, True)[:2]
        if not reached:
            return False, x, y, k
        x, y, k = nx, ny, cell
        gap, qx, qy = gap_at(net, k, x, y)
        if gap >= enough:
            return True, x, y, k
    if gap < radius:  # pushed to and fro: the passage is hardly wider than the body
        _, x, y, gap = middle(net, first, ax, ay, net.cell)
        reached, k = walk(net, first, ax, ay, x, y, 0.0, True)[:2]
        gap = gap_at(net, k, x, y)[0] if reached else 0.0
    return gap >= radius, x, y, k


@kernel(error_model="numpy")
def _free_place(net, k, x, y, px, py, enough):
    """The cell of p, reached straight from (x, y) in cell ``k``; -1 where it is not, or the gap at p is not
    ``enough``."""
    reached, cell = walk(net, k, x, y, px, py, 0.0, True)[:2]
    return cell if reached and gap_at(net, cell, px, py)[0] >= enough else np.int64(-1)


@kernel(error_model="numpy")
def lead_round(net, scratch, height, k, ax, ay, x, y, bx, by, qx, qy, radius):
    """Put corners on the stack, of ``height``, that lead the line a-b round q, which it is too close to at
    (x, y) in cell ``k``; returns how many.

    They lie on the tangents where the body fits there; else (x, y) is pushed.
    """
    bend, stack, stack_cell = scratch.bend, scratch.stack, scratch.stack_cell
    enough = radius * (1.0 + SLACK)
    parts = tangents(ax, ay, x, y, bx, by, qx, qy, radius * (1.0 + MARGIN), bend)
    for part in range(parts):
        cell = _free_place(net, k, x, y, bend[part, 0], bend[part, 1], enough)
        if cell < 0:
            parts = 0
            break
        at = height + parts - 1 - part
        stack[at, 0], stack[at, 1], stack_cell[at] = bend[part, 0], bend[part, 1], cell
    if parts == 0:
        pushed, x, y, k = push_off(net, k, x, y, qx, qy, radius)
        if pushed and (x - ax) ** 2 + (y - ay) ** 2 > 1e-12 and (x - bx) ** 2 + (y - by) ** 2 > 1e-12:
            stack[height, 0], stack[height, 1], stack_cell[height] = x, y, k
            parts = 1
    return parts


@kernel(error_model="numpy", forceinline=True)
def _inside(cx, cy, room, x, y):
    """The point of the disc of radius ``room`` about c that is nearest to (x, y)."""
    d = sqrt((x - cx) ** 2 + (y - cy) ** 2)
    share = room / d if d > room else 1.0
    return cx + share * (x - cx), cy + share * (y - cy)


@kernel(error_model="numpy", forceinline=True)
def _apart(x, y, ax, ay, bx, by):
    """Whether (x, y) is a place of its own beside a and b."""
    return (x - ax) ** 2 + (y - ay) ** 2 > 1e-6 and (x - bx) ** 2 + (y - by) ** 2 > 1e-6


@kernel(error_model="numpy")
def round_in_disc(net, doors, scratch, low, high, ax, ay, bx, by, place, aside):
    """A corner inside a disc that leads the line a-b round what ends walking at ``place`` on it.

    The disc is the one of nodes[low:high] that the place is deepest in; the corner is where it comes nearest
    to the line or, if that is an end of the line and ``aside``, to the place. Returns (found, x, y, cell).
    """
    x = ax + place * (bx - ax)
    y = ay + place * (by - ay)
    node = -1
    least = 1e300
    for i in range(low, high):
        other = scratch.nodes[i]
        dx = x - net.position[other, 0]
        dy = y - net.position[other, 1]
        power = dx * dx + dy * dy - net.node_radius[other] ** 2
        if power < least and net.node_radius[other] > doors.radius:
            least = power
            node = other
    if node < 0:
        return False, x, y, -1
    cx, cy = net.position[node, 0], net.position[node, 1]
    room = net.node_radius[node] - doors.radius
    dx, dy = bx - ax, by - ay
    s = ((cx - ax) * dx + (cy - ay) * dy) / (dx * dx + dy * dy)
    s = min(max(s, 0.0), 1.0)
    px, py = _inside(cx, cy, room, ax + s * dx, ay + s * dy)
    if aside and not _apart(px, py, ax, ay, bx, by):  # the line leads away from the disc or towards it
        px, py = _inside(cx, cy, room, x, y)
    if not _apart(px, py, ax, ay, bx, by):
        return False, px, py, -1
    reached, cell = walk(net, np.int64(net.node_cell[node]), cx, cy, px, py, 0.0, True)[:2]
    return reached, px, py, cell
