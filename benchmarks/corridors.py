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
    """Shortest path (k, 2) from start to goal through the lens chords of consecutive discs (string
    pulling)."""
    portals = [
        lens_chord(a, ra, b, rb)
        for a, ra, b, rb in zip(centers[:-1], radii[:-1], centers[1:], radii[1:], strict=True)
    ]
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


def bounded_curve(rng, curvature, room=0.3, turns=5):
    """A corridor around a curve of bounded curvature, so that one exists in it by construction.

    curvature [1/m]: the curve's own is at most 0.9 of it; room: the discs' radius in radii of the tightest
    curve.
    Returns (waypoints (k, 2), centers (m, 2), radii (m,), start tangent (2,), end tangent (2,)).
    """
    radius = room / curvature
    step = 0.05 * radius
    heading = rng.uniform(-np.pi, np.pi)
    start = heading
    bends = rng.uniform(-0.9, 0.9, turns) * curvature
    points = [rng.uniform(-20, 20, 2)]
    for bend in bends:
        for _ in range(int(rng.uniform(0.5, 1.5) / curvature / step)):
            heading += bend * step
            points.append(points[-1] + step * np.array([np.cos(heading), np.sin(heading)]))
    curve = np.array(points)
    centers = curve[::16]
    if np.hypot(*(centers[-1] - curve[-1])) > 0.05 * radius:
        centers = np.vstack([centers, curve[-1]])
    radii = np.full(len(centers), radius)
    waypoints = funnel(curve[0], curve[-1], centers, radii)
    tangents = [np.array([np.cos(a), np.sin(a)]) for a in (start, heading)]
    return waypoints, centers, radii, *tangents


def sharp_corner(rng, curvature):
    """A corridor with a bend that no curve of bounded curvature gets through; returned as by `bounded_curve`.

    In a corridor of half width w, an arc round a bend of angle a has at most the radius 2 w / (1 - cos(a /
    2)); the width here is half of what that would need, and the legs are straight.
    """
    angle = rng.uniform(0.5 * np.pi, 0.8 * np.pi) * rng.choice([-1, 1])
    width = 0.25 * (1 - np.cos(angle / 2)) / curvature
    heading = rng.uniform(-np.pi, np.pi)
    legs = [np.array([np.cos(h), np.sin(h)]) for h in (heading, heading + angle)]
    count = int(rng.integers(4, 9))
    along = 1.2 * width * np.arange(1, count + 1)[:, None]
    centers = np.vstack([-along[::-1] * legs[0], [[0.0, 0.0]], along * legs[1]]) + rng.uniform(-20, 20, 2)
    radii = np.full(len(centers), width)
    return funnel(centers[0], centers[-1], centers, radii), centers, radii, *legs


def turn_on_the_spot(rng, curvature, room):
    """A straight corridor whose start tangent points backwards, in a disc `room` times as wide as the
    tightest curve."""
    heading = rng.uniform(-np.pi, np.pi)
    leg = np.array([np.cos(heading), np.sin(heading)])
    radius = room / curvature
    centers = rng.uniform(-20, 20, 2) + np.outer(np.arange(4) * 1.2 * radius, leg)
    return np.array([centers[0], centers[-1]]), centers, np.full(4, radius), -leg, leg
