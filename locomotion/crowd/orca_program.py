"""The velocity nearest to a wish within half-planes and a disc: the linear programs of ORCA.

J. van den Berg, S. Guy, M. Lin, D. Manocha, "Reciprocal n-Body Collision Avoidance", Robotics Research, STAR
70 (2011), sections 5.2 and 5.3; the incremental method follows M. de Berg and others, "Computational
Geometry", chapter 4. A half-plane is a row (nx, ny, c): velocities v with n·v ≤ c, n a unit vector. Slow
references: `locomotion.crowd.reference`.
"""

from math import sqrt

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["choose_velocity"]

_PARALLEL = 1e-9


@kernel
def _on_border(planes, i, speed, wx, wy, outward):
    """The best velocity on the border of plane ``i`` within the disc and the planes before it: the one
    nearest to w, or with ``outward`` the one farthest along it. Returns (found, x, y)."""
    nx, ny, c = planes[i, 0], planes[i, 1], planes[i, 2]
    half = speed * speed - c * c
    if half < 0.0:
        return False, 0.0, 0.0
    high = sqrt(half)
    low = -high
    px, py = c * nx, c * ny
    dx, dy = -ny, nx
    for j in range(i):
        along = planes[j, 0] * dx + planes[j, 1] * dy
        room = planes[j, 2] - (planes[j, 0] * px + planes[j, 1] * py)
        if abs(along) <= _PARALLEL:
            if room < -_PARALLEL:
                return False, 0.0, 0.0
            continue
        t = room / along
        if along > 0.0:
            high = min(high, t)
        else:
            low = max(low, t)
        if low > high:
            return False, 0.0, 0.0
    t = dx * wx + dy * wy
    if outward:
        t = high if t > 0.0 else low
    else:
        t = min(max(t, low), high)
    return True, px + t * dx, py + t * dy


@kernel
def _within(planes, count, speed, wx, wy, outward):
    """The best velocity within the disc of radius ``speed`` and the first ``count`` planes.

    Returns (planes kept, x, y): fewer than ``count`` where they leave no velocity; then the best within
    those.
    """
    size = sqrt(wx * wx + wy * wy)
    if outward or size > speed:
        share = speed / max(size, 1e-300)
        vx, vy = wx * share, wy * share
    else:
        vx, vy = wx, wy
    for i in range(count):
        if planes[i, 0] * vx + planes[i, 1] * vy > planes[i, 2] + 1e-12:
            found, x, y = _on_border(planes, i, speed, wx, wy, outward)
            if not found:
                return i, vx, vy
            vx, vy = x, y
    return count, vx, vy


@allocating_kernel
def _least_violation(planes, count, hard, begin, speed, vx, vy, work):
    """Move (vx, vy) so that the greatest violation of the planes from ``hard`` on is least, within the disc
    and the first ``hard`` planes: the paper's three-dimensional program."""
    worst = 0.0
    for i in range(begin, count):
        if planes[i, 0] * vx + planes[i, 1] * vy - planes[i, 2] <= worst:
            continue
        used = hard
        for j in range(hard):
            work[j] = planes[j]
        for j in range(hard, i):
            # where plane j is violated no more than plane i
            nx, ny = planes[j, 0] - planes[i, 0], planes[j, 1] - planes[i, 1]
            size = sqrt(nx * nx + ny * ny)
            if size <= _PARALLEL:
                continue
            work[used, 0], work[used, 1] = nx / size, ny / size
            work[used, 2] = (planes[j, 2] - planes[i, 2]) / size
            used += 1
        kept, x, y = _within(work, used, speed, -planes[i, 0], -planes[i, 1], True)
        if kept == used:  # infeasible only by rounding: keep the last velocity
            vx, vy = x, y
        worst = planes[i, 0] * vx + planes[i, 1] * vy - planes[i, 2]
    return vx, vy


@kernel
def choose_velocity(planes, count, hard, speed, wx, wy, work):
    """The velocity (x, y) [m/s] nearest to the wish (wx, wy), no faster than ``speed`` and within the first
    ``count`` rows of ``planes`` (k, 3).

    Where there is none, the one that violates the planes from ``hard`` on least at the worst, and the first
    ``hard`` not at all if that can be. ``work`` (k, 3) is scratch.
    """
    kept, vx, vy = _within(planes, count, speed, wx, wy, False)
    if kept == count:
        return vx, vy
    if kept < hard:  # the walls on both sides are nearer than the body's width
        return _least_violation(planes, count, 0, 0, speed, vx, vy, work)
    return _least_violation(planes, count, hard, kept, speed, vx, vy, work)
