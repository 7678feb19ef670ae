"""The solver's result."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pathsmooth.problem import Problem

COMPLETE = "complete"
ITERATION_LIMIT = "iteration_limit"
INFEASIBLE = "infeasible"


@dataclass(slots=True, eq=False)
class Solution:
    """A smoothed path and how good it is.

    The status is one of

      "complete"         without a bound on curvature: the objective is within the tolerance of the optimum.
                         With one: the true curvature of the points, see `curvature`, is at most 3 % above it.
                         The objective is then not the least possible: `objective` and `gap` are those of the
                         last convex problem, whose targets and spacing the solver chose (`problem`), possibly
                         along another way through the corridor.
      "iteration_limit"  stopped early; the points are still valid: inside the corridor, ends and tangents
                         exact. Without a bound the objective is no higher than the pulled path's. With one,
                         the curvature is above it: the points are the least curved ones found, and whether
                         any path meets the bound is unknown. Without a limit on iterations this is rare:
                         the corridor must narrow to a fraction of the tightest curve.
      "infeasible"       proven: no path in the corridor has these tangents and this curvature; the points are
                         the smoothest without the bound.
    """

    points: NDArray[np.float64]
    """(n, 3) [m]: x and y are smoothed, z is the pulled path's at the same waypoint."""
    objective: float
    """f of the points, see `Problem`."""
    gap: float
    """Upper bound of how far the objective is above the optimum, in the objective's unit [m²]."""
    iterations: int
    status: str
    state: NDArray[np.float64] = field(repr=False)
    """(4, n, 2) displacements and the dual variables of the distances, the discs and the bound on curvature
    (zero without one), for a warm start."""
    problem: Problem = field(repr=False)
    """What was solved."""

    def __repr__(self) -> str:
        return (
            f"<Solution {self.status}: {len(self.points)} points, objective {self.objective:.6g}, "
            f"{self.iterations} iterations>"
        )
