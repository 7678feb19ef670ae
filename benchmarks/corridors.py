"""Synthetic corridors: chains of discs with the shortest path through them."""

from __future__ import annotations

import numpy as np


def lens_chord(a, ra, b, rb):
    """End points (left, right), seen from a to b, of the chord in which two discs meet."""
    offset = b - a
    distance = np.hypot(*offset)
    unit = offset / distance
    along = (distance**2 + ra**2 - rb**2) / (2 * distance)
    across = np.sqrt(max(ra**2 - along**2, 0.0))
    normal = np.array([-unit[1], unit[0]])
    foot = a + along * unit
    return foot + across * normal, foot - across * normal


def funnel(start, goal, centers, radii):
    """Shortest path (k, 2) from start to goal through the lens chords of consecutive discs (string pulling)."""
    portals = [lens_chord(a, ra, b, rb) for a, ra, b, rb in zip(
        centers[:-1], radii[:-1], centers[1:], radii[1:], strict=True)]
    portals.append((goal, goal))

    def area(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    path = [start]
    apex, left, right = start, portals[0][0], portals[0][1]
    left_index = right_index = 0
    i = 1
    while i < len(portals):
        new_left, new_right = portals[i]
        if area(apex, right, new_right) >= 0:
            if np.array_equal(apex, right) or area(apex, left, new_right) < 0:
                right, right_index = new_right, i
            else:
                path.append(left)
                apex, i = left, left_index
                left_index = right_index = i
                left = right = apex
                i += 1
                if i < len(portals):
                    left, right = portals[i]
                    left_index = right_index = i
                    i += 1
                continue
        if area(apex, left, new_left) <= 0:
            if np.array_equal(apex, left) or area(apex, right, new_left) > 0:
                left, left_index = new_left, i
            else:
                path.append(right)
                apex, i = right, right_index
                left_index = right_index = i
                i += 1
                if i < len(portals):
                    left, right = portals[i]
                    left_index = right_index = i
                    i += 1
                continue
        i += 1
    path.append(goal)
    points = np.array(path)
    keep = np.concatenate([[True], np.hypot(*np.diff(points, axis=0).T) > 1e-9])
    return points[keep]


def disc_chain(rng, discs, radius=(0.15, 2.0), wander=0.5):
    """A random corridor: (waypoints (k, 2), centers (m, 2), radii (m,)) with the shortest path inside it.

    radius: range [m], drawn evenly in its logarithm; wander: standard deviation of the turn per disc [rad].
    """
    low, high = np.log(radius[0]), np.log(radius[1])
    heading = rng.uniform(-np.pi, np.pi)
    radii = np.exp(rng.uniform(low, high, discs))
    centers = np.zeros((discs, 2))
    centers[0] = rng.uniform(-20, 20, 2)
    for j in range(1, discs):
        a, b = radii[j - 1], radii[j]
        nearest, farthest = abs(a - b), a + b
        distance = nearest + (farthest - nearest) * rng.uniform(0.3, 0.95)
        heading += rng.normal(0.0, wander)
        centers[j] = centers[j - 1] + distance * np.array([np.cos(heading), np.sin(heading)])

    def inside(j):
        angle, r = rng.uniform(-np.pi, np.pi), 0.9 * radii[j] * np.sqrt(rng.uniform())
        return centers[j] + r * np.array([np.cos(angle), np.sin(angle)])

    return funnel(inside(0), inside(discs - 1), centers, radii), centers, radii
