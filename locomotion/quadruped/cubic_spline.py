"""Natural cubic splines through points of the plane: `scipy.interpolate.CubicSpline` to the last bit, in less
time."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs

from surefoot.kernels import kernel

__all__ = ["along_spline", "length_along", "natural_spline"]

(_solve_tridiagonal,) = get_lapack_funcs(("gtsv",))  # of float64


def natural_spline(at: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4, n - 1, 2) coefficients of the cubics between the knots ``at`` (n,), at least 2, which increase,
    through ``values`` (n, 2): highest power first, of the distance from the knot before."""
    apart = np.diff(at)
    wide = apart[:, None]
    slopes = np.diff(values, axis=0) / wide
    diagonal, right = np.empty(len(at)), np.empty((len(at), 2))
    diagonal[0], diagonal[-1] = 2.0 * apart[0], 2.0 * apart[-1]
    diagonal[1:-1] = 2.0 * (apart[:-1] + apart[1:])
    right[0], right[-1] = 3.0 * (values[1] - values[0]), 3.0 * (values[-1] - values[-2])
    right[1:-1] = 3.0 * (wide[1:] * slopes[:-1] + wide[:-1] * slopes[1:])
    below, above = np.append(apart[1:], apart[-1]), np.append(apart[0], apart[:-1])
    rates = _solve_tridiagonal(below, diagonal, above, right)[3]  # first derivatives at the knots
    out = np.empty((4, len(apart), 2))
    excess = (rates[:-1] + rates[1:] - 2.0 * slopes) / wide
    out[0], out[1] = excess / wide, (slopes - rates[:-1]) / wide - excess
    out[2], out[3] = rates[:-1], values[:-1]
    return out


@kernel(forceinline=True)
def _place(pieces, piece, i, s):
    """Coordinate ``i`` of a spline, ``s`` behind the first knot of ``piece``."""
    a, b, c = pieces[0, piece, i], pieces[1, piece, i], pieces[2, piece, i]
    return pieces[3, piece, i] + c * s + b * (s * s) + a * (s * s * s)


@kernel
def along_spline(at, pieces, where, place, first, second):
    """Places, first and second derivatives (k, 2) of a spline of `natural_spline` at ``where`` (k,), which
    increase."""
    piece = 0
    for k in range(len(where)):
        while piece < len(at) - 2 and where[k] >= at[piece + 1]:
            piece += 1
        s = where[k] - at[piece]
        for i in range(2):
            a, b, c = pieces[0, piece, i], pieces[1, piece, i], pieces[2, piece, i]
            place[k, i] = _place(pieces, piece, i, s)
            first[k, i] = c + b * s * 2.0 + a * (s * s) * 3.0
            second[k, i] = b * 2.0 + a * s * 6.0


@kernel
def length_along(at, pieces, fine, along):
    """Write into ``along`` (k,) the lengths, up to each of ``fine`` (k,), which increase, of the line through
    a spline's places there."""
    piece, length, last_x, last_y = 0, 0.0, 0.0, 0.0
    for k in range(len(fine)):
        while piece < len(at) - 2 and fine[k] >= at[piece + 1]:
            piece += 1
        s = fine[k] - at[piece]
        x, y = _place(pieces, piece, 0, s), _place(pieces, piece, 1, s)
        if k > 0:
            length += math.sqrt((x - last_x) * (x - last_x) + (y - last_y) * (y - last_y))
        along[k] = length
        last_x, last_y = x, y
