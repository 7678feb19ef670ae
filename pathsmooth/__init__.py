"""Convex smoothing of paths inside a corridor of discs."""

from pathsmooth.errors import PathSmoothError
from pathsmooth.exact import solve_exact
from pathsmooth.problem import Problem
from pathsmooth.solver import Solution, solve

__all__ = ["PathSmoothError", "Problem", "Solution", "solve", "solve_exact"]
