"""Where a curve of bounded curvature can go inside a corridor: a search that never misses a curve.

Positions and headings are divided into cells, and a curve into steps of equal length. From a cell, a step
leads to every cell in which some curve from somewhere in the cell can end, so the search finds all reachable
cells. If the goal is not among them, no curve exists. If it is, the chain of cells is a first guess for the
solver; it proves nothing, because the cells allow a little more than the bound.

The corridor's discs are passed in order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import allocating_kernel, kernel

UNREACHABLE = 0
REACHED = 1
UNDECIDED = 2


class End(NamedTuple):
    """An end of a curve: its place (2,) [m], and its heading [rad] or None for any."""

    place: NDArray[np.float64]
    heading: float | None


class Fineness(NamedTuple):
    """How finely to search.

    turn        [rad] greatest turn in one step, below 1; the step is turn / max_curvature long.
    turn_cells  heading cells per such turn.
    cell        size of a position cell, in radii of the tightest curve.
    """

    turn: float = 0.4
    turn_cells: int = 4
    cell: float = 0.025


def search(
    start: End,
    goal: End,
    centers: NDArray[np.float64],
    radii: NDArray[np.float64],
    max_curvature: float,
    fineness: Fineness,
    budget: int = 1_000_000,
) -> tuple[int, NDArray[np.float64], NDArray[np.int64]]:
    """Search from start to goal through discs (m, 2), (m,). budget: greatest number of cells entered.

    Returns (code, positions (k, 2), disc of each (k,)); the last two are empty unless the code is REACHED.
    """
    turn, turn_cells, cell = fineness
    headings = int(np.ceil(2 * np.pi / (turn / turn_cells)))
    delta = 2 * np.pi / headings
    step = turn_cells * delta * (1 - 1e-9) / max_curvature
    size = cell / max_curvature
    offsets, first = _steps(headings, turn_cells, max_curvature, step, size)
    origin = start.place
    reference = 0.0 if start.heading is None else start.heading
    goal_turn = -1.0 if goal.heading is None else (goal.heading - reference) % (2 * np.pi)
    low = np.floor((centers - radii[:, None] - origin) / size).astype(np.int64) - 1
    count = np.ceil(2 * radii[:, None] / size).astype(np.int64).repeat(2, axis=1) + 4
    room = np.concatenate([[0], np.cumsum(count[:, 0] * count[:, 1] * headings)])
    if room[-1] > 200_000_000:
        return UNDECIDED, np.zeros((0, 2)), np.zeros(0, np.int64)
    code, positions, discs = _search(
        goal.place - origin, goal_turn, start.heading is None, reference, centers - origin, radii,
        max_curvature, step, size,
        headings, turn_cells, offsets, first, low, count, room, budget,
    )  # fmt: skip
    return code, positions + origin, discs


def _steps(headings: int, turn_cells: int, max_curvature: float, step: float, size: float):
    """Offsets (dx, dy, dh) of the cells that a step may lead to, for every heading; offsets[first[h]:first[h
    + 1]].

    Offsets are relative to a frame whose heading cell 0 is the x axis; `_search` turns them to the start's
    heading.
    """
    delta = 2 * np.pi / headings
    s = np.linspace(0.0, step, 201)
    middle = 0.5 * (s[1:] + s[:-1])
    pad = 1e-4 * step
    boxes = []
    for dh in range(-turn_cells, turn_cells + 1):
        # all headings that a curve can have on the way, in the frame of the cell that it starts in
        high = np.minimum(
            delta / 2 + max_curvature * middle, dh * delta + delta / 2 + max_curvature * (step - middle)
        )
        low = np.maximum(
            -delta / 2 - max_curvature * middle, dh * delta - delta / 2 - max_curvature * (step - middle)
        )
        widest = np.maximum(np.abs(high), np.abs(low))
        narrowest = np.where((low < 0) & (high > 0), 0.0, np.minimum(np.abs(high), np.abs(low)))
        boxes.append(
            (
                np.mean(np.cos(widest)) * step - pad,
                np.mean(np.cos(narrowest)) * step + pad,
                np.mean(np.sin(low)) * step - pad,
                np.mean(np.sin(high)) * step + pad,
            )
        )
    reach = int(np.ceil(1.2 * step / size)) + 2
    grid = np.arange(-reach, reach + 1)
    gx, gy = np.meshgrid(grid * size, grid * size, indexing="ij")
    ix, iy = np.meshgrid(grid, grid, indexing="ij")
    offsets = []
    first = [0]
    for h in range(headings):
        c, n = np.cos(h * delta), np.sin(h * delta)
        x, y = c * gx + n * gy, -n * gx + c * gy
        # both ends of a step are anywhere in their cells: the box grows by a square of twice the cell's half
        # width
        grow = size * (abs(c) + abs(n))
        total = first[-1]
        for dh, (x0, x1, y0, y1) in zip(range(-turn_cells, turn_cells + 1), boxes, strict=True):
            inside = (x >= x0 - grow) & (x <= x1 + grow) & (y >= y0 - grow) & (y <= y1 + grow)
            corners = np.array([(c * a - n * b, n * a + c * b) for a in (x0, x1) for b in (y0, y1)])
            least, most = corners.min(axis=0) - size, corners.max(axis=0) + size
            inside &= (gx >= least[0]) & (gx <= most[0]) & (gy >= least[1]) & (gy <= most[1])
            offsets.append(np.column_stack([ix[inside], iy[inside], np.full(inside.sum(), dh)]))
            total += int(inside.sum())
        first.append(total)
    return np.concatenate(offsets).astype(np.int32), np.array(first)


@allocating_kernel
def _search(
    goal, goal_turn, any_start, reference, centers, radii, curvature, step, size, headings,
    turn_cells, offsets, first,
    low, count, room, budget,
):  # fmt: skip
    """Over (disc, x, y, heading), farthest disc first, breadth first in a disc.

    The grid is turned so that the start's heading is cell 0.
    """
    m = len(radii)
    delta = 2.0 * np.pi / headings
    half_cell = size * np.sqrt(0.5)
    # a curve strays from the chord of a step by at most this in its middle
    stray = curvature * step * step / 8.0 + half_cell
    cosine = np.cos(reference)
    sine = np.sin(reference)
    # work in the turned frame
    cx = np.empty(m)
    cy = np.empty(m)
    for j in range(m):
        cx[j] = cosine * centers[j, 0] + sine * centers[j, 1]
        cy[j] = -sine * centers[j, 0] + cosine * centers[j, 1]
    goal_x = cosine * goal[0] + sine * goal[1]
    goal_y = -sine * goal[0] + cosine * goal[1]
    low_x = np.empty(m, np.int64)
    low_y = np.empty(m, np.int64)
    for j in range(m):
        low_x[j] = int(np.floor((cx[j] - radii[j]) / size)) - 1
        low_y[j] = int(np.floor((cy[j] - radii[j]) / size)) - 1
    lens = _lens_boxes(cx, cy, radii)
    seen = np.zeros(room[m], np.uint8)
    queue = np.empty((1024, 4), np.int32)  # disc, x, y, heading
    parent = np.empty(1024, np.int64)
    following = np.empty(1024, np.int64)  # the next one in the same disc's line
    front = np.full(m, -1, np.int64)
    back = np.full(m, -1, np.int64)
    farthest = 0
    tail = 0
    for h in range(headings if any_start else 1):
        seen[((0 - low_x[0]) * count[0, 1] - low_y[0]) * headings + h] = 1
        if tail == len(queue):
            queue = _longer(queue)
            parent = _longer_list(parent)
            following = _longer_list(following)
        queue[tail, 0], queue[tail, 1], queue[tail, 2], queue[tail, 3] = 0, 0, 0, h
        parent[tail] = -1
        following[tail] = -1
        if tail == 0:
            front[0] = 0
        else:
            following[tail - 1] = tail
        back[0] = tail
        tail += 1
    found = -1
    while True:
        while farthest >= 0 and front[farthest] < 0:
            farthest -= 1
        if farthest < 0:
            break
        head = front[farthest]
        front[farthest] = following[head]
        j, ix, iy, h = queue[head, 0], queue[head, 1], queue[head, 2], queue[head, 3]
        x = ix * size
        y = iy * size
        last = j
        while last + 1 < m and (
            np.sqrt((x - cx[last + 1]) ** 2 + (y - cy[last + 1]) ** 2) <= radii[last + 1] + step + half_cell
        ):
            last += 1
        if last == m - 1 and _arrives(
            goal_x - x, goal_y - y, h, goal_turn, curvature, step, size, delta, turn_cells, headings
        ):
            found = head
            break
        for o in range(first[h], first[h + 1]):
            nx = ix + offsets[o, 0]
            ny = iy + offsets[o, 1]
            nh = (h + offsets[o, 2] + headings) % headings
            px = nx * size
            py = ny * size
            for jj in range(j, last + 1):
                r = radii[jj] + half_cell
                if (px - cx[jj]) ** 2 + (py - cy[jj]) ** 2 > r * r:
                    continue
                key = room[jj] + ((nx - low_x[jj]) * count[jj, 1] + ny - low_y[jj]) * headings + nh
                if seen[key]:
                    continue
                # from disc to disc the curve goes through their lens
                crosses = True
                for q in range(j, jj):
                    if not _meets(lens, q, x, y, px, py, stray):
                        crosses = False
                        break
                if not crosses:
                    continue
                # half way the curve must be in one of the discs that it passes
                inside = False
                for q in range(j, jj + 1):
                    r = radii[q] + stray
                    if (0.5 * (x + px) - cx[q]) ** 2 + (0.5 * (y + py) - cy[q]) ** 2 <= r * r:
                        inside = True
                        break
                if not inside:
                    continue
                seen[key] = 1
                if tail == len(queue):
                    queue = _longer(queue)
                    parent = _longer_list(parent)
                    following = _longer_list(following)
                queue[tail, 0], queue[tail, 1], queue[tail, 2], queue[tail, 3] = jj, nx, ny, nh
                parent[tail] = head
                following[tail] = -1
                if front[jj] < 0:
                    front[jj] = tail
                else:
                    following[back[jj]] = tail
                back[jj] = tail
                farthest = max(farthest, jj)
                tail += 1
        if tail > budget:
            return UNDECIDED, np.zeros((0, 2)), np.zeros(0, np.int64)
    if found < 0:
        return UNREACHABLE, np.zeros((0, 2)), np.zeros(0, np.int64)
    length = 0
    at = found
    while at >= 0:
        length += 1
        at = parent[at]
    positions = np.empty((length, 2))
    discs = np.empty(length, np.int64)
    at = found
    for i in range(length - 1, -1, -1):
        x = queue[at, 1] * size
        y = queue[at, 2] * size
        positions[i, 0] = cosine * x - sine * y
        positions[i, 1] = sine * x + cosine * y
        discs[i] = queue[at, 0]
        at = parent[at]
    return REACHED, positions, discs


@allocating_kernel
def _lens_boxes(cx, cy, radii):
    """(m - 1, 6) a box around each lens of consecutive discs: centre, unit axis, half length and half
    width."""
    boxes = np.empty((len(radii) - 1, 6))
    for j in range(len(radii) - 1):
        dx = cx[j + 1] - cx[j]
        dy = cy[j + 1] - cy[j]
        distance = max(np.sqrt(dx * dx + dy * dy), 1e-12)
        ux = dx / distance
        uy = dy / distance
        a = radii[j]
        b = radii[j + 1]
        begin = max(distance - b, -a)
        end = min(a, distance + b)
        foot = (distance * distance + a * a - b * b) / (2.0 * distance)
        if 0.0 <= foot <= distance:
            wide = np.sqrt(max(a * a - foot * foot, 0.0))
        else:
            wide = min(a, b)
        middle = 0.5 * (begin + end)
        boxes[j, 0] = cx[j] + middle * ux
        boxes[j, 1] = cy[j] + middle * uy
        boxes[j, 2] = ux
        boxes[j, 3] = uy
        boxes[j, 4] = 0.5 * (end - begin)
        boxes[j, 5] = wide
    return boxes


@kernel
def _meets(boxes, j, x, y, px, py, margin):
    """Whether the segment from (x, y) to (px, py) comes into box j grown by the margin."""
    enter = 0.0
    leave = 1.0
    for axis in range(2):
        ux = boxes[j, 2] if axis == 0 else -boxes[j, 3]
        uy = boxes[j, 3] if axis == 0 else boxes[j, 2]
        half = boxes[j, 4 + axis] + margin
        a = (x - boxes[j, 0]) * ux + (y - boxes[j, 1]) * uy
        b = (px - boxes[j, 0]) * ux + (py - boxes[j, 1]) * uy
        if abs(b - a) < 1e-15:
            if abs(a) > half:
                return False
            continue
        s = (-half - a) / (b - a)
        t = (half - a) / (b - a)
        enter = max(enter, min(s, t))
        leave = min(leave, max(s, t))
    return enter <= leave


@kernel
def _arrives(dx, dy, h, goal_turn, curvature, step, size, delta, turn_cells, headings):
    """Whether a last step, of any length up to a whole one, may end at the goal."""
    half_cell = size * np.sqrt(0.5)
    c = np.cos(h * delta)
    s = np.sin(h * delta)
    along = c * dx + s * dy
    across = -s * dx + c * dy
    if along < -half_cell or along > step + half_cell:
        return False
    if abs(across) > 0.5 * step * (curvature * step + delta) + half_cell:
        return False
    if goal_turn < 0.0:
        return True
    turn = abs((goal_turn - h * delta + np.pi) % (2.0 * np.pi) - np.pi)
    return turn <= (turn_cells + 1) * delta


@allocating_kernel
def _longer(queue):
    longer = np.empty((2 * len(queue), 4), np.int32)
    longer[: len(queue)] = queue
    return longer


@allocating_kernel
def _longer_list(parent):
    longer = np.empty(2 * len(parent), np.int64)
    longer[: len(parent)] = parent
    return longer
