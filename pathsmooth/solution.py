"""What the solver hands back."""

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
        "complete"         the objective is within the tolerance of the optimum (and the curvature within its
        bound) "iteration_limit"  stopped before that; the points are valid all the same: inside the corridor,
                           ends and tangents exact, objective no higher than the pulled path's; only a bound
                           on curvature may be missed, see `curvature`
        "infeasible"       no path in the corridor has the wanted tangents and curvature; the points are then
                           the best found without that bound
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
    """(3, n, 2) displacements and the two dual variables, for a warm start."""
    problem: Problem = field(repr=False)
    """What was solved."""
