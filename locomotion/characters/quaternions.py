"""Unit quaternions (w, x, y, z) in kernels; results go into ``out``, which may be one of the operands."""

import math

from surefoot.kernels import kernel

__all__ = ["between", "from_axes", "multiply", "rotate"]


@kernel
def multiply(a, b, out):
    """``b``, then ``a``."""
    w = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3]
    x = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2]
    y = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1]
    z = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]
    out[0], out[1], out[2], out[3] = w, x, y, z


@kernel
def rotate(q, v, out):
    """The vector ``v`` (3,) turned by ``q``."""
    x, y, z = v[0], v[1], v[2]
    a = 2.0 * (q[2] * z - q[3] * y)
    b = 2.0 * (q[3] * x - q[1] * z)
    c = 2.0 * (q[1] * y - q[2] * x)
    out[0] = x + q[0] * a + q[2] * c - q[3] * b
    out[1] = y + q[0] * b + q[3] * a - q[1] * c
    out[2] = z + q[0] * c + q[1] * b - q[2] * a


@kernel
def between(a, b, share, out):
    """A ``share`` of the shorter way from ``a`` to ``b``, along its chord."""
    dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    there = share if dot >= 0.0 else -share
    length = 0.0
    for k in range(4):
        value = (1.0 - share) * a[k] + there * b[k]
        out[k] = value
        length += value * value
    length = math.sqrt(length)
    for k in range(4):
        out[k] /= length


@kernel
def from_axes(x, y, z, out):
    """The rotation whose matrix has the columns ``x``, ``y``, ``z`` (3,)."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(1.0 + trace)
        out[0], out[1], out[2], out[3] = 0.25 * s, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s
    elif x[0] > y[1] and x[0] > z[2]:
        s = 2.0 * math.sqrt(max(1.0 + x[0] - y[1] - z[2], 1e-12))
        out[0], out[1], out[2], out[3] = (y[2] - z[1]) / s, 0.25 * s, (y[0] + x[1]) / s, (z[0] + x[2]) / s
    elif y[1] > z[2]:
        s = 2.0 * math.sqrt(max(1.0 - x[0] + y[1] - z[2], 1e-12))
        out[0], out[1], out[2], out[3] = (z[0] - x[2]) / s, (y[0] + x[1]) / s, 0.25 * s, (z[1] + y[2]) / s
    else:
        s = 2.0 * math.sqrt(max(1.0 - x[0] - y[1] + z[2], 1e-12))
        out[0], out[1], out[2], out[3] = (x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, 0.25 * s
