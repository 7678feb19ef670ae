"""Convex smoothing of paths inside a corridor of discs.

    problem = Problem.from_corridor(waypoints, centers, radii)
    solution = solve(problem)

The points of the solution are as near to the pulled path and as little bent as the corridor allows; `Problem`
states the objective. Everything is planar, in x and y; z is carried along.
"""

from pathsmooth.curvature import curvature, curvature_bound
from pathsmooth.errors import PathSmoothError
from pathsmooth.exact import solve_exact
from pathsmooth.problem import Problem
from pathsmooth.solution import Solution
from pathsmooth.solver import solve, solve_tightest, tightening
from surefoot import __version__
from surefoot.compile_notice import announce

__all__ = [
    "PathSmoothError",
    "Problem",
    "Solution",
    "__version__",
    "curvature",
    "curvature_bound",
    "solve",
    "solve_exact",
    "solve_tightest",
    "tightening",
]

announce()
