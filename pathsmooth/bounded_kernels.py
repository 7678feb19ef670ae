"""Compiled loops of the solver with a bound on the second divided difference, a convex stand-in for
curvature.

This is the problem of `kernels` with the constraint |D(p + d)_i| <= kappa_i. K = (I; I; D) has a third dual
variable, u, and the metric of the primal step is K^T S K for the dual step sizes S, so that the step stays
one pentadiagonal solve:

    d' = argmin f2(d) + <y + v + D^T u, d> + 1/2 |d - d_i|^2 in the metric diag(s + r) + D^T diag(c) D
    u' = z - c clip(z / c, kappa),  z = u + c D(p + 2 d' - d)

y' and v' are as in `kernels`. Targets need not lie in their discs here.
"""

from __future__ import annotations

import numpy as np

from pathsmooth.kernels import (
    AR,
    AX,
    AY,
    BEND,
    CURVE_DUAL,
    CURVE_STEP,
    DISC_DUAL,
    DISC_STEP,
    DISPLACEMENT,
    EX,
    EY,
    GX,
    GY,
    LEFT,
    NORM_DUAL,
    NORM_STEP,
    PIVOT,
    RIGHT,
    SUB1,
    SUB2,
    WEIGHT,
    lowest,
    objective,
    project,
)  # fmt: skip
from surefoot.kernels import allocating_kernel, kernel

CONVERGED = 0
LIMIT = 1
IMPOSSIBLE = 2

CERTAIN = 1e-6  # share of the bound by which a proof must hold, for rounding


@kernel(forceinline=True)
def _bend(packed, d, i, axis):
    """Second difference of the displacements at an inner waypoint."""
    return packed[LEFT, i] * (d[i - 1, axis] - d[i, axis]) + packed[RIGHT, i] * (d[i + 1, axis] - d[i, axis])


@kernel
def _spread(packed, force, out, first, last):
    """out (n, 2) = D^T force for the unknowns first..last-1."""
    n = packed.shape[1]
    for i in range(first, last):
        for axis in range(2):
            value = -(packed[LEFT, i] + packed[RIGHT, i]) * force[i, axis]
            if i > 1:
                value += packed[RIGHT, i - 1] * force[i - 1, axis]
            if i < n - 2:
                value += packed[LEFT, i + 1] * force[i + 1, axis]
            out[i, axis] = value


@kernel(forceinline=True)
def _curve_dual(packed, kappa, u, r, relaxation, back, here, ahead):
    """Update u at inner waypoint r; back, here, ahead: 2 d' - d at r - 1, r, r + 1, as (x, y)."""
    c = packed[CURVE_STEP, r]
    left = packed[LEFT, r]
    right = packed[RIGHT, r]
    z0 = u[r, 0] + c * (packed[EX, r] + left * (back[0] - here[0]) + right * (ahead[0] - here[0]))
    z1 = u[r, 1] + c * (packed[EY, r] + left * (back[1] - here[1]) + right * (ahead[1] - here[1]))
    size = np.sqrt(z0 * z0 + z1 * z1)
    f = 1.0 - c * kappa[r] / size if size > c * kappa[r] else 0.0
    u[r, 0] += relaxation * (f * z0 - u[r, 0])
    u[r, 1] += relaxation * (f * z1 - u[r, 1])


@kernel
def iterate(packed, kappa, first, last, relaxation, count, d, y, v, u, new):
    """Do `count` iterations on d, y, v, u (n, 2) in place; the last primal step's result is left in new."""
    n = packed.shape[1]
    for _ in range(count):
        # primal step, forwards: its right-hand side with D^T (c D d - u), f at i - 1, i, i + 1
        f0 = f1 = g0 = g1 = h0 = h1 = 0.0
        a0 = a1 = b0 = b1 = 0.0
        for i in range(max(first - 2, 0), last):
            f0, f1, g0, g1 = g0, g1, h0, h1
            h0 = h1 = 0.0
            r = i + 1
            if r < n - 1:
                h0 = packed[CURVE_STEP, r] * _bend(packed, d, r, 0) - u[r, 0]
                h1 = packed[CURVE_STEP, r] * _bend(packed, d, r, 1) - u[r, 1]
            if i < first:
                continue
            t = packed[NORM_STEP, i] + packed[DISC_STEP, i]
            middle = packed[LEFT, i] + packed[RIGHT, i]
            c0 = t * d[i, 0] - y[i, 0] - v[i, 0] - packed[GX, i]
            c1 = t * d[i, 1] - y[i, 1] - v[i, 1] - packed[GY, i]
            c0 += packed[RIGHT, i - 1] * f0 - middle * g0 + packed[LEFT, i + 1] * h0
            c1 += packed[RIGHT, i - 1] * f1 - middle * g1 + packed[LEFT, i + 1] * h1
            c0 -= packed[SUB1, i] * b0 + packed[SUB2, i] * a0
            c1 -= packed[SUB1, i] * b1 + packed[SUB2, i] * a1
            new[i, 0] = c0
            new[i, 1] = c1
            a0, a1, b0, b1 = b0, b1, c0, c1
        # backwards, with the dual steps; e: 2 d' - d at i, i + 1, i + 2
        a0 = a1 = b0 = b1 = 0.0
        l1 = l2 = m2 = 0.0  # SUB1[i + 1], SUB2[i + 2], SUB2[i + 1]
        here = (0.0, 0.0)
        ahead = (0.0, 0.0)
        for i in range(last - 1, first - 1, -1):
            c0 = new[i, 0] * packed[PIVOT, i] - l1 * b0 - l2 * a0
            c1 = new[i, 1] * packed[PIVOT, i] - l1 * b1 - l2 * a1
            new[i, 0] = c0
            new[i, 1] = c1
            a0, a1, b0, b1 = b0, b1, c0, c1
            l1, l2, m2 = packed[SUB1, i], m2, packed[SUB2, i]
            e0 = 2.0 * c0 - d[i, 0]
            e1 = 2.0 * c1 - d[i, 1]
            d[i, 0] += relaxation * (c0 - d[i, 0])
            d[i, 1] += relaxation * (c1 - d[i, 1])
            s = packed[NORM_STEP, i]
            w = packed[WEIGHT, i]
            y0 = y[i, 0] + s * e0
            y1 = y[i, 1] + s * e1
            size2 = y0 * y0 + y1 * y1
            if size2 > w * w:
                f = w / np.sqrt(size2)
                y0 *= f
                y1 *= f
            s = packed[DISC_STEP, i]
            z0 = v[i, 0] + s * e0
            z1 = v[i, 1] + s * e1
            x0, x1 = project(packed, i, z0 / s, z1 / s)
            y[i, 0] += relaxation * (y0 - y[i, 0])
            y[i, 1] += relaxation * (y1 - y[i, 1])
            v[i, 0] += relaxation * (z0 - s * x0 - v[i, 0])
            v[i, 1] += relaxation * (z1 - s * x1 - v[i, 1])
            if i + 1 < n - 1:
                _curve_dual(packed, kappa, u, i + 1, relaxation, (e0, e1), here, ahead)
            here, ahead = (e0, e1), here
        for r in range(first, 0, -1):
            _curve_dual(packed, kappa, u, r, relaxation, (0.0, 0.0), here, ahead)
            here, ahead = (0.0, 0.0), here


@kernel
def _bounds(packed, kappa, d, y, u, force, pull, first, last):
    """(a value no feasible point is below, a value no feasible point is above)."""
    n = packed.shape[1]
    low = 0.0
    high = 0.0
    for i in range(1, n - 1):
        q = packed[BEND, i]
        size2 = 0.0
        for axis in range(2):
            e = packed[EX + axis, i]
            force[i, axis] = 2.0 * q * (e + _bend(packed, d, i, axis)) + u[i, axis]
            size2 += force[i, axis] ** 2
            low += force[i, axis] * e
        size = np.sqrt(size2)
        if size <= 2.0 * q * kappa[i]:
            low -= size2 / (4.0 * q)
        else:
            low -= kappa[i] * size - q * kappa[i] ** 2
        high += q * kappa[i] ** 2
    _spread(packed, force, pull, first, last)
    for i in range(first, last):
        g0 = pull[i, 0]
        g1 = pull[i, 1]
        w = packed[WEIGHT, i]
        size = np.sqrt(g0 * g0 + g1 * g1)
        if size > w:
            f = 1.0 - w / size
            low += max(lowest(packed, i, f * g0, f * g1), lowest(packed, i, g0 + y[i, 0], g1 + y[i, 1]))
        high += w * (np.sqrt(packed[AX, i] ** 2 + packed[AY, i] ** 2) + packed[AR, i])
    return low, high


@kernel
def excludes(packed, kappa, ray, pull, first, last):
    """Whether ``ray`` (n, 2) proves that no displacements inside the discs keep the bound: of every feasible
    d, <ray, D(p + d)> is at most sum_i kappa_i |ray_i|, but its least value over the discs is more.

    Where there are no such displacements, u grows along such a ray for ever, and its change over some
    iterations is one (Applegate et al., Infeasibility detection with primal-dual hybrid gradient, 2021). Ends
    of ray do not count; pull (n, 2): room for D^T ray.
    """
    n = packed.shape[1]
    value = 0.0
    size = 0.0
    for i in range(1, n - 1):
        length = np.sqrt(ray[i, 0] ** 2 + ray[i, 1] ** 2)
        value += ray[i, 0] * packed[EX, i] + ray[i, 1] * packed[EY, i] - kappa[i] * length
        size += kappa[i] * length
    _spread(packed, ray, pull, first, last)
    for i in range(first, last):
        value += lowest(packed, i, pull[i, 0], pull[i, 1])
    return value > CERTAIN * size


@allocating_kernel
def solve_bounded(
    packed, kappa, first, last, relaxation, limit, tolerance, slack, check_every, gives_up, state, best
):  # fmt: skip
    """Iterate until the gap and the violation of the bound are small, or the bound is proven impossible.

    kappa (n,) [1/m]; slack: relative violation of it that counts as small; gives_up: whether to look for the
    proof by `excludes` as well, which comes sooner; state (4, n, 2): d, y, v, u, changed in place; best
    (n, 2): displacements inside the discs, written.
    Returns (code, iterations, objective, bound on the optimum).
    """
    n = packed.shape[1]
    d, y, v, u = state[DISPLACEMENT], state[NORM_DUAL], state[DISC_DUAL], state[CURVE_DUAL]
    new = np.zeros((n, 2))
    force = np.zeros((n, 2))
    pull = np.zeros((n, 2))
    before = u.copy()
    widened = (1.0 + slack) * kappa
    done = 0
    code = LIMIT
    bound = 0.0
    value = 0.0
    while done < limit:
        iterate(packed, kappa, first, last, relaxation, check_every, d, y, v, u, new)
        done += check_every
        for i in range(first, last):
            best[i, 0], best[i, 1] = project(packed, i, new[i, 0], new[i, 1])
        value = objective(packed, best, first, last)
        low, high = _bounds(packed, kappa, new, y, u, force, pull, first, last)
        bound = max(bound, low)
        if low > high * (1.0 + 1e-6) + 1e-9:
            code = IMPOSSIBLE
            break
        if gives_up:
            for i in range(n):
                force[i, 0], force[i, 1] = u[i, 0] - before[i, 0], u[i, 1] - before[i, 1]
            before[:] = u
            if excludes(packed, widened, force, pull, first, last):
                code = IMPOSSIBLE
                break
        worst = 0.0
        for i in range(1, n - 1):
            x = packed[EX, i] + _bend(packed, best, i, 0)
            z = packed[EY, i] + _bend(packed, best, i, 1)
            worst = max(worst, np.sqrt(x * x + z * z) / kappa[i])
        if worst <= 1.0 + slack and value - bound <= tolerance * bound + 1e-12:
            code = CONVERGED
            break
    return code, done, value, bound
