"""Slow, obvious versions of the crowd's kernels, for tests."""

import numpy as np
from scipy.optimize import minimize_scalar

__all__ = ["orca_plane", "velocity", "worst_violation"]


def velocity(planes: np.ndarray, hard: int, speed: float, wish: np.ndarray) -> tuple[np.ndarray, bool]:
    """`program.choose_velocity` with cvxpy, and whether all planes (k, 3) could be satisfied."""
    import cvxpy as cp

    v = cp.Variable(2)
    disc = cp.norm(v) <= speed
    normals, limits = planes[:, :2], planes[:, 2]
    keep = [normals @ v <= limits] if len(planes) else []
    nearest = cp.Problem(cp.Minimize(cp.sum_squares(v - wish)), [disc, *keep])
    nearest.solve(solver=cp.CLARABEL)
    if nearest.status in ("optimal", "optimal_inaccurate"):
        return np.array(v.value), True
    for kept in (hard, 0):
        slack = cp.Variable()
        rules = [disc, normals[kept:] @ v - limits[kept:] <= slack]
        if kept:
            rules.append(normals[:kept] @ v <= limits[:kept])
        least = cp.Problem(cp.Minimize(slack), rules)
        least.solve(solver=cp.CLARABEL)
        if least.status in ("optimal", "optimal_inaccurate"):
            break
    return np.array(v.value), False


def worst_violation(planes: np.ndarray, v: np.ndarray) -> float:
    """[m/s] by which ``v`` (2,) violates the worst of ``planes`` (k, 3); negative if it satisfies all."""
    return float((planes[:, :2] @ v - planes[:, 2]).max()) if len(planes) else -np.inf


def orca_plane(
    offset: np.ndarray, own: np.ndarray, other: np.ndarray, reach: float, share: float, horizon: float
) -> np.ndarray:
    """`avoidance.body_plane` from its definition: the relative velocities that lead to a collision within
    ``horizon`` form a cone cut off by a disc; u is the least change that leaves it, found by sampling its
    border.

    offset (2,): where the other is [m]. own, other (2,) velocities. reach: sum of the radii, less than the
    distance.
    """
    relative = own - other
    distance = float(np.linalg.norm(offset))
    toward = np.arctan2(offset[1], offset[0])
    opening = np.arcsin(reach / distance)
    best, normal = np.inf, np.zeros(2)

    def nearer(point: np.ndarray, outward: np.ndarray) -> None:
        nonlocal best, normal
        gap = float(np.linalg.norm(point - relative))
        if gap < best:
            best, normal = gap, outward

    for sign in (1.0, -1.0):  # the legs, from where they touch the disc
        along = np.array([np.cos(toward + sign * opening), np.sin(toward + sign * opening)])
        outward = sign * np.array([-along[1], along[0]])
        begin = np.sqrt(distance**2 - reach**2) / horizon
        t = max(float(relative @ along), begin)
        nearer(t * along, outward)
    middle = offset / horizon
    front = np.pi / 2.0 - opening  # half of the arc that faces the origin

    def gap_at(angle: float) -> float:
        spot = middle - reach / horizon * np.array([np.cos(toward + angle), np.sin(toward + angle)])
        return float(np.linalg.norm(spot - relative))

    angles = np.linspace(-front, front, 181)
    rough = angles[np.argmin([gap_at(a) for a in angles])]
    step = angles[1] - angles[0]
    found = minimize_scalar(
        gap_at, bounds=(max(rough - step, -front), min(rough + step, front)), method="bounded",
        options={"xatol": 1e-10},
    )  # fmt: skip
    outward = -np.array([np.cos(toward + found.x), np.sin(toward + found.x)])
    nearer(middle + reach / horizon * outward, outward)
    inside = _collides(relative, offset, reach, horizon)
    change = normal * (best if inside else -best)
    return np.array([-normal[0], -normal[1], -float(normal @ (own + share * change))])


def _collides(relative: np.ndarray, offset: np.ndarray, reach: float, horizon: float) -> bool:
    """Whether moving at ``relative`` comes within ``reach`` of ``offset`` before ``horizon``."""
    t = float(np.clip(relative @ offset / max(float(relative @ relative), 1e-300), 0.0, horizon))
    return float(np.linalg.norm(t * relative - offset)) < reach
