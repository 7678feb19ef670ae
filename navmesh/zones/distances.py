"""Horizontal distances to the outlines of zones."""

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["is_inside", "segment_to_outline", "segments_to_outline", "touches"]


@kernel(error_model="numpy")
def is_inside(outline, x, y):
    """Whether (x, y) is inside an outline (k, 2)."""
    inside = False
    j = outline.shape[0] - 1
    for i in range(outline.shape[0]):
        ax, ay, bx, by = outline[i, 0], outline[i, 1], outline[j, 0], outline[j, 1]
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
        j = i
    return inside


@kernel(error_model="numpy")
def touches(outline, ax, ay, bx, by):
    """Whether the line from a to b touches the outline."""
    j = outline.shape[0] - 1
    for i in range(outline.shape[0]):
        px, py, qx, qy = outline[j, 0], outline[j, 1], outline[i, 0], outline[i, 1]
        j = i
        if max(px, qx) < min(ax, bx) or min(px, qx) > max(ax, bx):
            continue
        if max(py, qy) < min(ay, by) or min(py, qy) > max(ay, by):
            continue
        one = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
        other = (bx - ax) * (qy - ay) - (by - ay) * (qx - ax)
        near = (qx - px) * (ay - py) - (qy - py) * (ax - px)
        far = (qx - px) * (by - py) - (qy - py) * (bx - px)
        if one * other <= 0.0 and near * far <= 0.0:
            return True
    return False


@kernel(error_model="numpy", forceinline=True)
def _square(px, py, ax, ay, bx, by):
    """Squared distance of p from the line from a to b."""
    ex, ey = bx - ax, by - ay
    length = ex * ex + ey * ey
    t = ((px - ax) * ex + (py - ay) * ey) / length if length > 0.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    dx, dy = ax + t * ex - px, ay + t * ey - py
    return dx * dx + dy * dy


@kernel(error_model="numpy")
def segment_to_outline(outline, ax, ay, bx, by):
    """Distance [m] from the line from a to b to an outline (k, 2); 0 if it touches it or is inside."""
    if is_inside(outline, ax, ay) or touches(outline, ax, ay, bx, by):
        return 0.0
    best = np.inf
    j = outline.shape[0] - 1
    for i in range(outline.shape[0]):
        px, py, qx, qy = outline[j, 0], outline[j, 1], outline[i, 0], outline[i, 1]
        best = min(best, _square(px, py, ax, ay, bx, by), _square(ax, ay, px, py, qx, qy))
        best = min(best, _square(bx, by, px, py, qx, qy))
        j = i
    return np.sqrt(best)


@allocating_kernel(error_model="numpy")
def segments_to_outline(outline, segments):
    """(s,) `segment_to_outline` for ``segments`` (s, 4), x and y of both ends."""
    away = np.empty(segments.shape[0])
    for i in range(segments.shape[0]):
        away[i] = segment_to_outline(outline, segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3])
    return away
