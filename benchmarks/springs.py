"""The talk's first approach to smoothing: torsion springs straighten the path, linear springs hold its shape.

The springs pull as the objective's two terms do, so that they come to rest at the solver's result, and only
the way there differs. Each waypoint's mass makes its own spring as fast as a simulation step allows;
waypoints that leave their discs are put back.
"""

import numpy as np
from numba import njit

from pathsmooth import kernels as k

DAMPINGS = (0.5, 0.7, 0.8, 0.9, 0.95)
"""Share of the velocity kept per step; the best one over all routes is taken."""


@njit(cache=True)
def simulate(packed, first, last, damping, steps, target, check_every):
    """Run the springs until the objective is at most `target`, or for `steps` steps.

    Returns (steps done, objective). packed: see `pathsmooth.kernels`.
    """
    n = packed.shape[1]
    d = np.zeros((n, 2))
    velocity = np.zeros((n, 2))
    force = np.zeros((n, 2))
    mass = np.zeros(n)
    for i in range(1, n - 1):
        q = 2.0 * packed[k.BEND, i]
        left = packed[k.LEFT, i]
        right = packed[k.RIGHT, i]
        # an upper bound of the stiffness that a waypoint feels: the row sum of the bending energy's Hessian
        total = 2.0 * (left + right)
        mass[i - 1] += q * left * total
        mass[i] += q * (left + right) * total
        mass[i + 1] += q * right * total
    soft = 0.01
    value = k.objective(packed, d, first, last)
    best = value
    done = 0
    while done < steps and best > target:
        for _ in range(check_every):
            force[:] = 0.0
            for i in range(1, n - 1):
                left = packed[k.LEFT, i]
                right = packed[k.RIGHT, i]
                for axis in range(2):
                    e = packed[k.EX + axis, i]
                    e += left * (d[i - 1, axis] - d[i, axis]) + right * (d[i + 1, axis] - d[i, axis])
                    e *= 2.0 * packed[k.BEND, i]
                    force[i - 1, axis] -= left * e
                    force[i, axis] += (left + right) * e
                    force[i + 1, axis] -= right * e
            for i in range(first, last):
                w = packed[k.WEIGHT, i]
                far = np.sqrt(d[i, 0] ** 2 + d[i, 1] ** 2 + soft * soft)
                for axis in range(2):
                    push = force[i, axis] - w * d[i, axis] / far
                    velocity[i, axis] = damping * velocity[i, axis] + push / (mass[i] + w / soft)
                x = d[i, 0] + velocity[i, 0]
                y = d[i, 1] + velocity[i, 1]
                px, py = k.project(packed, i, x, y)
                velocity[i, 0] = px - d[i, 0]
                velocity[i, 1] = py - d[i, 1]
                d[i, 0] = px
                d[i, 1] = py
        done += check_every
        value = k.objective(packed, d, first, last)
        best = min(best, value)
    return done, best
