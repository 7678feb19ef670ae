"""Placing waypoints: how a corridor of discs covers a pulled path, and where the subdivided waypoints lie.

A disc cuts the path into stretches, written as intervals of arc length. One stretch per disc is chosen so
that consecutive ones overlap. A *portal* is a waypoint in the overlap of two consecutive stretches; it
belongs to both discs, so each segment between two waypoints has both its ends in one disc, and lies inside
it.

Arc length is measured horizontally, in metres. Everything here is planar and compiled.
"""

from __future__ import annotations

import numpy as np

from pathsmooth.geometry import nearest_in_lens
from surefoot.kernels import allocating_kernel, kernel

COVERED = 0
START_OUTSIDE = 1
GAP = 2
END_OUTSIDE = 3

MERGE = 0.3
"""Waypoints closer than this fraction of the spacing are merged where the discs allow it."""

SHIFT = 0.1
"""Fraction of the spacing by which a merged waypoint's target may leave the pulled path."""


@kernel(forceinline=True)
def _inside_part(x, y, ux, uy, length, cx, cy, radius):
    """Part of a segment inside a disc: its first and last arc length from the segment's start; last <
    first: none."""
    along = (cx - x) * ux + (cy - y) * uy
    off_x = cx - x - along * ux
    off_y = cy - y - along * uy
    half_squared = radius * radius - off_x * off_x - off_y * off_y
    if half_squared < 0.0:
        return 1.0, 0.0
    half = np.sqrt(half_squared)
    return max(along - half, 0.0), min(along + half, length)


@allocating_kernel
def cover(path, arc, centers, radii, slack):
    """Choose for every disc the stretch of the path that it covers.

    path (k, 2), arc (k,) increasing, centers (m, 2), radii (m,), slack [m] by which a disc may be missed
    (rounding).
    Returns (code, disc, reached, begin (m,), end (m,)): the code is COVERED or the failure, `disc` the first
    disc that fails and `reached` the arc length to which the discs before it cover the path.
    """
    k = len(path)
    m = len(centers)
    begin = np.zeros(m)
    end = np.zeros(m)
    # every stretch of every disc that can be entered from the disc before it
    first = np.zeros(m + 1, np.int64)
    stretch_begin = [0.0]
    stretch_end = [0.0]
    earliest = [0.0]
    parent = [-1]
    total = arc[k - 1]
    reached = 0.0
    for j in range(m):
        first[j] = len(parent)
        if j == 0:
            low, high = 0.0, 0.0
        else:
            low, high = total, 0.0
            for q in range(first[j - 1], first[j]):
                low = min(low, earliest[q])
                high = max(high, stretch_end[q])
        reached = high
        radius = radii[j] + slack
        segment = np.searchsorted(arc, low, side="right") - 1
        segment = min(max(segment, 0), k - 2)
        # the stretch that holds `low` may begin before it
        while segment > 0:
            x = path[segment, 0] - centers[j, 0]
            y = path[segment, 1] - centers[j, 1]
            if x * x + y * y > radius * radius:
                break
            segment -= 1
        a = -1.0
        b = -1.0
        open_stretch = False
        while segment < k - 1:
            length = arc[segment + 1] - arc[segment]
            ux = (path[segment + 1, 0] - path[segment, 0]) / length
            uy = (path[segment + 1, 1] - path[segment, 1]) / length
            s0, s1 = _inside_part(
                path[segment, 0], path[segment, 1], ux, uy, length, centers[j, 0], centers[j, 1], radius
            )
            if s1 >= s0:
                if open_stretch and s0 <= slack:
                    b = arc[segment] + s1
                else:
                    if open_stretch:
                        _enter(a, b, j, first, stretch_begin, stretch_end, earliest, parent, slack)
                    a = arc[segment] + s0
                    b = arc[segment] + s1
                    open_stretch = True
            segment += 1
            if open_stretch and b < arc[segment] - slack:
                _enter(a, b, j, first, stretch_begin, stretch_end, earliest, parent, slack)
                open_stretch = False
            if not open_stretch and arc[segment] > high + slack:
                break
        if open_stretch:
            _enter(a, b, j, first, stretch_begin, stretch_end, earliest, parent, slack)
        if len(parent) == first[j]:
            return (START_OUTSIDE if j == 0 else GAP), j, reached, begin, end
    first[m] = len(parent)
    chosen = -1
    reached = 0.0
    for q in range(first[m - 1], first[m]):
        reached = max(reached, stretch_end[q])
        if stretch_end[q] >= total - slack and (chosen < 0 or earliest[q] < earliest[chosen]):
            chosen = q
    if chosen < 0:
        return END_OUTSIDE, m - 1, reached, begin, end
    for j in range(m - 1, -1, -1):
        begin[j] = stretch_begin[chosen]
        end[j] = stretch_end[chosen]
        chosen = parent[chosen]
    begin[0] = 0.0
    end[m - 1] = total
    return COVERED, m, total, begin, end


@allocating_kernel
def _enter(a, b, j, first, stretch_begin, stretch_end, earliest, parent, slack):
    """Record the stretch [a, b] of disc j if it can be entered, with the earliest place where that is
    possible."""
    best = np.inf
    source = -1
    if j == 0:
        if a <= slack:
            best = 0.0
    else:
        for q in range(first[j - 1], first[j]):
            if stretch_end[q] + slack >= a and earliest[q] <= b + slack:
                entry = min(max(a, earliest[q]), b)
                if entry < best:
                    best = entry
                    source = q
    if best < np.inf:
        stretch_begin.append(a)
        stretch_end.append(b)
        earliest.append(best)
        parent.append(source)


@allocating_kernel
def point_at(path, arc, s):
    """The point (x, y) of a polyline at arc length s."""
    segment = min(max(np.searchsorted(arc, s, side="right") - 1, 0), len(arc) - 2)
    t = min(max((s - arc[segment]) / (arc[segment + 1] - arc[segment]), 0.0), 1.0)
    return (
        path[segment, 0] + t * (path[segment + 1, 0] - path[segment, 0]),
        path[segment, 1] + t * (path[segment + 1, 1] - path[segment, 1]),
    )


@kernel
def _balance_point(path, arc, low, high, ax, ay, ra, bx, by, rb):
    """Arc length in [low, high] where the path changes from being deeper in disc a to being deeper in disc b.

    "Deeper" by the power distance, which is equal on the line through the two corners of the lens.
    """
    for _ in range(40):
        if high - low <= 1e-6:
            break
        middle = 0.5 * (low + high)
        x, y = point_at(path, arc, middle)
        if (x - ax) ** 2 + (y - ay) ** 2 - ra * ra < (x - bx) ** 2 + (y - by) ** 2 - rb * rb:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def _shared(path, arc, s, centers, radii, a, b, shift):
    """Whether the path at s is within `shift` of both discs a and b, and these overlap."""
    if (
        np.sqrt((centers[a, 0] - centers[b, 0]) ** 2 + (centers[a, 1] - centers[b, 1]) ** 2)
        > radii[a] + radii[b]
    ):
        return False
    x, y = point_at(path, arc, s)
    px, py = nearest_in_lens(
        x, y, centers[a, 0], centers[a, 1], radii[a], centers[b, 0], centers[b, 1], radii[b]
    )
    return (px - x) ** 2 + (py - y) ** 2 <= (shift + 1e-9) ** 2


@allocating_kernel
def place(path, arc, centers, radii, begin, end, spacing):
    """Choose the arc lengths of the waypoints and the disc of every segment.

    begin, end (m,): the stretches from `cover`. Overlaps shorter than the spacing get a waypoint of their
    own; between those the path is divided evenly, and a wide overlap takes a waypoint that is there already.
    Returns (waypoint arc lengths (n,), disc of each segment (n - 1,)).
    """
    m = len(centers)
    total = arc[-1]
    low = np.empty(m - 1)
    high = np.empty(m - 1)
    wanted = np.empty(m - 1)
    for j in range(m - 1):
        low[j] = max(begin[j], begin[j + 1])
        if j > 0:
            low[j] = max(low[j], low[j - 1])
    for j in range(m - 2, -1, -1):
        high[j] = min(end[j], end[j + 1])
        if j < m - 2:
            high[j] = min(high[j], high[j + 1])
        high[j] = max(high[j], low[j])
    for j in range(m - 1):
        wanted[j] = _balance_point(
            path, arc, low[j], high[j],
            centers[j, 0], centers[j, 1], radii[j], centers[j + 1, 0], centers[j + 1, 1], radii[j + 1],
        )  # fmt: skip

    # portals in narrow overlaps, with both ends of the path; close ones share a waypoint where their discs
    # allow it
    close = MERGE * spacing
    shift = SHIFT * spacing
    marks = [0.0]
    mark_of = np.full(m - 1, -1)
    group_first = 0  # the disc before the last mark
    group_start = 0.0  # arc length of the first portal at the last mark
    for j in range(m - 1):
        if high[j] - low[j] >= spacing:
            continue
        t = min(max(wanted[j], marks[-1]), total)
        merged = False
        if t - group_start < close:
            at = max(marks[-1], low[j]) if len(marks) > 1 else 0.0
            allowed = shift if len(marks) > 1 else 0.0
            merged = _shared(path, arc, at, centers, radii, group_first, j + 1, allowed)
            if merged:
                marks[-1] = at
        if not merged:
            if t - marks[-1] < close:
                t = min(high[j], marks[-1] + close)
            marks.append(t)
            group_first = j
            group_start = t
        mark_of[j] = len(marks) - 1
    if total - group_start < close and len(marks) > 1:
        if _shared(path, arc, total, centers, radii, group_first, m - 1, 0.0):
            marks[-1] = total
    if marks[-1] < total:
        marks.append(total)
    for j in range(m - 1):
        if mark_of[j] >= 0:
            low[j] = marks[mark_of[j]]
            high[j] = low[j]
    for j in range(1, m - 1):
        low[j] = max(low[j], low[j - 1])
    for j in range(m - 3, -1, -1):
        high[j] = min(high[j], high[j + 1])

    places = [0.0]
    for q in range(1, len(marks)):
        length = marks[q] - marks[q - 1]
        pieces = max(1, int(np.ceil(length / spacing - 1e-9)))
        for piece in range(1, pieces):
            places.append(marks[q - 1] + length * piece / pieces)
        places.append(marks[q])
    waypoint_arc = np.array(places)
    n = len(waypoint_arc)

    # the waypoint of every portal, then the discs between portals
    segment_disc = np.empty(n - 1, np.int32)
    done = 0
    for j in range(m - 1):
        left = np.searchsorted(waypoint_arc, low[j] - 1e-12, side="left")
        right = np.searchsorted(waypoint_arc, high[j] + 1e-12, side="right") - 1
        w = min(np.searchsorted(waypoint_arc, wanted[j]), n - 1)
        if w > 0 and wanted[j] - waypoint_arc[w - 1] < waypoint_arc[w] - wanted[j]:
            w -= 1
        w = max(min(max(w, left), right), done)
        segment_disc[done:w] = j
        done = w
    segment_disc[done:] = m - 1
    return waypoint_arc, segment_disc
