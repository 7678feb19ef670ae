"""Compiled loops of the solver: Chambolle and Pock's primal-dual algorithm with the quadratic in the primal
step.

Unknowns are the displacements d (n, 2) of the waypoints from their targets, so that large coordinates cost no
precision. The problem is

    minimise  f2(d) + sum_i w_i |d_i|   with  d_i in C_i,       f2(d) = sum_i q_i |D(p + d)_i|^2,

D the divided second difference, C_i a disc or the lens of two. With K = (I; I), one dual variable y for the
norm and one, v, for the discs, one iteration is

    d' = argmin f2(d) + <y + v, d> + sum_i (s_i + r_i) / 2 |d - d_i|^2     (one pentadiagonal solve)
    y' = projection of y + s (2 d' - d) on the balls |y_i| <= w_i
    v' = z - r P_C(z / r),  z = v + r (2 d' - d)

with step sizes s and r per waypoint (Pock and Chambolle 2011), followed by over-relaxation. `reference.py`
has the same steps written plainly.

The rows of the packed array (ROWS, n) that the loops read are the constants below.
"""

from __future__ import annotations

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

AX, AY, AR, BX, BY, BR = (
    0,
    1,
    2,
    3,
    4,
    5,
)  # the two discs relative to the target [m]; equal where there is one
PX, PY, QX, QY = 6, 7, 8, 9  # the two corners of the lens [m]
WEIGHT = 10  # w [m]: mean spacing at the waypoint
LEFT, RIGHT = 11, 12  # second difference: LEFT x[i-1] - (LEFT + RIGHT) x[i] + RIGHT x[i+1] [1/m^2]
BEND = 13  # q [m^4]
EX, EY = 14, 15  # second difference of the targets [1/m]
GX, GY = 16, 17  # gradient of f2 at the targets
NORM_STEP, DISC_STEP = 18, 19  # dual step sizes s and r [m/m]
CURVE_STEP = 20  # dual step size c of the bound on curvature; 0 where there is none
SUB1, SUB2, PIVOT = 21, 22, 23  # factors L and 1 / E of Hessian of f2 + D^T diag(c) D + diag(s + r) = L E L^T
ROWS = 24

DISPLACEMENT, NORM_DUAL, DISC_DUAL, CURVE_DUAL = 0, 1, 2, 3
# rows of a state (4, n, 2), which a solution begins with and leaves: d, y, v; with a bound on curvature u

ROUNDING = 1.0 + 1e-12
NOTHING = 1e-12  # [m^2] objective that is as good as zero
EXACT = 1e-10  # relative gap that is as good as none


@kernel
def factorise(packed, first, last):
    """Fill SUB1, SUB2, PIVOT for the unknowns first..last-1."""
    n = packed.shape[1]
    for i in range(first, last):
        diagonal = packed[NORM_STEP, i] + packed[DISC_STEP, i]
        lower1 = 0.0
        lower2 = 0.0
        for r in range(max(1, i - 1), min(n - 1, i + 2)):
            # row r of D touches i - 1, i, i + 1; coefficient of unknown i in it
            own = _coefficient(packed, r, i)
            bend = 2.0 * packed[BEND, r] + packed[CURVE_STEP, r]
            diagonal += bend * own * own
            if i - 1 >= first:
                lower1 += bend * own * _coefficient(packed, r, i - 1)
            if i - 2 >= first:
                lower2 += bend * own * _coefficient(packed, r, i - 2)
        l2 = 0.0
        l1 = 0.0
        if i - 2 >= first:
            l2 = lower2 * packed[PIVOT, i - 2]
        if i - 1 >= first:
            l1 = lower1
            if i - 2 >= first:
                l1 -= l2 * packed[SUB1, i - 1] / packed[PIVOT, i - 2]
            l1 *= packed[PIVOT, i - 1]
            diagonal -= l1 * l1 / packed[PIVOT, i - 1]
        if i - 2 >= first:
            diagonal -= l2 * l2 / packed[PIVOT, i - 2]
        packed[SUB1, i] = l1
        packed[SUB2, i] = l2
        packed[PIVOT, i] = 1.0 / diagonal


@kernel(forceinline=True)
def _coefficient(packed, row, i):
    if i == row - 1:
        return packed[LEFT, row]
    if i == row:
        return -packed[LEFT, row] - packed[RIGHT, row]
    if i == row + 1:
        return packed[RIGHT, row]
    return 0.0


@kernel(forceinline=True)
def project(packed, i, x, y):
    """The point of C_i nearest to (x, y)."""
    ux = x - packed[AX, i]
    uy = y - packed[AY, i]
    vx = x - packed[BX, i]
    vy = y - packed[BY, i]
    a2 = ux * ux + uy * uy
    b2 = vx * vx + vy * vy
    ra = packed[AR, i]
    rb = packed[BR, i]
    in_a = a2 <= ra * ra * ROUNDING
    in_b = b2 <= rb * rb * ROUNDING
    if in_a and in_b:
        return x, y
    if not in_a:
        f = ra / np.sqrt(a2)
        px = packed[AX, i] + f * ux
        py = packed[AY, i] + f * uy
        if (px - packed[BX, i]) ** 2 + (py - packed[BY, i]) ** 2 <= rb * rb * ROUNDING:
            return px, py
    if not in_b:
        f = rb / np.sqrt(b2)
        px = packed[BX, i] + f * vx
        py = packed[BY, i] + f * vy
        if (px - packed[AX, i]) ** 2 + (py - packed[AY, i]) ** 2 <= ra * ra * ROUNDING:
            return px, py
    p2 = (x - packed[PX, i]) ** 2 + (y - packed[PY, i]) ** 2
    q2 = (x - packed[QX, i]) ** 2 + (y - packed[QY, i]) ** 2
    if p2 <= q2:
        return packed[PX, i], packed[PY, i]
    return packed[QX, i], packed[QY, i]


@kernel(forceinline=True)
def lowest(packed, i, gx, gy):
    """Minimum of <g, d> over C_i."""
    g = np.sqrt(gx * gx + gy * gy)
    if g == 0.0:
        return 0.0
    ra = packed[AR, i]
    rb = packed[BR, i]
    x = packed[AX, i] - ra * gx / g
    y = packed[AY, i] - ra * gy / g
    if (x - packed[BX, i]) ** 2 + (y - packed[BY, i]) ** 2 <= rb * rb * ROUNDING:
        return gx * x + gy * y
    x = packed[BX, i] - rb * gx / g
    y = packed[BY, i] - rb * gy / g
    if (x - packed[AX, i]) ** 2 + (y - packed[AY, i]) ** 2 <= ra * ra * ROUNDING:
        return gx * x + gy * y
    return min(gx * packed[PX, i] + gy * packed[PY, i], gx * packed[QX, i] + gy * packed[QY, i])


@kernel
def objective(packed, d, first, last):
    """f1 + f2 of the displacements d (n, 2); those outside first..last-1 are zero."""
    n = packed.shape[1]
    total = 0.0
    for i in range(1, n - 1):
        left = packed[LEFT, i]
        right = packed[RIGHT, i]
        x = packed[EX, i] + left * (d[i - 1, 0] - d[i, 0]) + right * (d[i + 1, 0] - d[i, 0])
        y = packed[EY, i] + left * (d[i - 1, 1] - d[i, 1]) + right * (d[i + 1, 1] - d[i, 1])
        total += packed[BEND, i] * (x * x + y * y)
    for i in range(first, last):
        total += packed[WEIGHT, i] * np.sqrt(d[i, 0] * d[i, 0] + d[i, 1] * d[i, 1])
    return total


@kernel
def lower_bound(packed, d, y, first, last, pull):
    """A value that no feasible point is below: the dual objective at the second differences of d (n, 2) and
    at y.

    For any z, f2 >= 2 <z, D(p + d)> - |z|^2 / q, which leaves one small problem per waypoint: the least of
    w |d_i| + <g_i, d_i> over C_i, with g = D^T 2 z. It is 0 where |g_i| <= w_i; before convergence many |g_i|
    are a little above, which costs much in wide discs and is cured by scaling z down a little. pull (n, 2):
    room for g.
    """
    n = packed.shape[1]
    linear = 0.0
    square = 0.0
    # second differences times 2 q in rows i - 1, i, i + 1
    ax = ay = bx = by = cx = cy = 0.0
    for i in range(0, n):
        ax, ay, bx, by = bx, by, cx, cy
        r = i + 1
        if r < n - 1:
            left = packed[LEFT, r]
            right = packed[RIGHT, r]
            x = packed[EX, r] + left * (d[r - 1, 0] - d[r, 0]) + right * (d[r + 1, 0] - d[r, 0])
            z = packed[EY, r] + left * (d[r - 1, 1] - d[r, 1]) + right * (d[r + 1, 1] - d[r, 1])
            q = packed[BEND, r]
            linear += 2.0 * q * (x * packed[EX, r] + z * packed[EY, r])
            square += q * (x * x + z * z)
            cx = 2.0 * q * x
            cy = 2.0 * q * z
        else:
            cx = 0.0
            cy = 0.0
        if i < first or i >= last:
            continue
        # column i of D: RIGHT of row i - 1, minus both of row i, LEFT of row i + 1
        middle = packed[LEFT, i] + packed[RIGHT, i]
        pull[i, 0] = packed[RIGHT, i - 1] * ax - middle * bx + packed[LEFT, i + 1] * cx
        pull[i, 1] = packed[RIGHT, i - 1] * ay - middle * by + packed[LEFT, i + 1] * cy
    best = -np.inf
    for scale in (1.0, 0.995, 0.98, 0.95, 0.9):
        value = scale * linear - scale * scale * square
        for i in range(first, last):
            w = packed[WEIGHT, i]
            gx = scale * pull[i, 0]
            gy = scale * pull[i, 1]
            g2 = gx * gx + gy * gy
            if g2 > w * w:
                f = 1.0 - w / np.sqrt(g2)
                least = lowest(packed, i, f * gx, f * gy)
                if least < 0.0:
                    least = max(least, lowest(packed, i, gx + scale * y[i, 0], gy + scale * y[i, 1]))
                value += least
        best = max(best, value)
    return best


@kernel
def iterate(packed, first, last, relaxation, count, d, y, v, rhs):
    """Do `count` iterations on d, y, v (n, 2) in place; the last primal step's unrelaxed result is left in
    rhs."""
    for _ in range(count):
        a0 = a1 = b0 = b1 = 0.0
        for i in range(first, last):
            t = packed[NORM_STEP, i] + packed[DISC_STEP, i]
            c0 = t * d[i, 0] - y[i, 0] - v[i, 0] - packed[GX, i] - packed[SUB1, i] * b0 - packed[SUB2, i] * a0
            c1 = t * d[i, 1] - y[i, 1] - v[i, 1] - packed[GY, i] - packed[SUB1, i] * b1 - packed[SUB2, i] * a1
            rhs[i, 0] = c0
            rhs[i, 1] = c1
            a0, a1, b0, b1 = b0, b1, c0, c1
        a0 = a1 = b0 = b1 = 0.0
        l1 = 0.0  # SUB1[i + 1]
        l2 = 0.0  # SUB2[i + 2]
        m2 = 0.0  # SUB2[i + 1]
        for i in range(last - 1, first - 1, -1):
            c0 = rhs[i, 0] * packed[PIVOT, i] - l1 * b0 - l2 * a0
            c1 = rhs[i, 1] * packed[PIVOT, i] - l1 * b1 - l2 * a1
            rhs[i, 0] = c0
            rhs[i, 1] = c1
            a0, a1, b0, b1 = b0, b1, c0, c1
            l1 = packed[SUB1, i]
            l2 = m2
            m2 = packed[SUB2, i]
            # dual step at i
            s = packed[NORM_STEP, i]
            w = packed[WEIGHT, i]
            e0 = 2.0 * c0 - d[i, 0]
            e1 = 2.0 * c1 - d[i, 1]
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
            d[i, 0] += relaxation * (c0 - d[i, 0])
            d[i, 1] += relaxation * (c1 - d[i, 1])
            y[i, 0] += relaxation * (y0 - y[i, 0])
            y[i, 1] += relaxation * (y1 - y[i, 1])
            v[i, 0] += relaxation * (z0 - s * x0 - v[i, 0])
            v[i, 1] += relaxation * (z1 - s * x1 - v[i, 1])


@allocating_kernel
def solve(
    packed,
    targets,
    heights,
    first,
    last,
    relaxation,
    limit,
    tolerance,
    first_check,
    check_every,
    state,
    points,
):
    """Iterate until the gap is at most `tolerance` of the bound, or `limit` iterations.

    state (4, n, 2): start of d, y and v, changed in place. points (n, 3): the best feasible path found,
    written.
    Returns (iterations, objective, bound).
    """
    n = packed.shape[1]
    d, y, v = state[DISPLACEMENT], state[NORM_DUAL], state[DISC_DUAL]
    best = np.zeros((n, 2))
    candidate = np.zeros((n, 2))
    primal = d.copy()
    value = objective(packed, best, first, last)
    bound = 0.0
    done = 0
    while True:
        if done > 0 or np.any(d):
            for i in range(first, last):
                candidate[i, 0], candidate[i, 1] = project(packed, i, primal[i, 0], primal[i, 1])
            new = objective(packed, candidate, first, last)
            if new < value:
                value = new
                best[:] = candidate
        bound = max(bound, lower_bound(packed, primal, y, first, last, candidate))
        if done >= limit or value <= NOTHING or value - bound <= max(tolerance, EXACT) * bound:
            break
        count = min(first_check if done == 0 else check_every, limit - done)
        iterate(packed, first, last, relaxation, count, d, y, v, primal)
        done += count
    for i in range(n):
        points[i, 0] = targets[i, 0] + best[i, 0]
        points[i, 1] = targets[i, 1] + best[i, 1]
        points[i, 2] = heights[i]
    return done, value, bound
