"""Speed planner for the run-up: which speed for each remaining step, so that the last one ends at take-off.

Equation 15 of "Terrain Runner" (Liu and others, 2012): the steps i = 1..n, of length a v_i + b, lead from
the stance foot to the take-off mark with as little change of speed as possible,

    minimise  w_u (u - u_h)² + Σ w_i (v_i - v_{i-1})²   subject to  v_n = v_in,

where u = distance - Σ (a v_i + b). In the changes e_i = v_i - v_{i-1} the optimum has the form
e_i = (λ + a m (n - i + 1)) / w_i with two unknowns, which gives the closed form in `_closed_form`.
Bounds on speed make it a small quadratic programme, solved by an active set; `plan_approach_exact` is the
same programme through cvxpy. The planner is meant to be asked again at the beginning of every step.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from locomotion.errors import LocomotionError
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["ApproachPlan", "ApproachWeights", "plan_approach", "plan_approach_exact"]

_MAX_STEPS = 512


@dataclass(frozen=True)
class ApproachPlan:
    """The rest of a run-up, as planned at the beginning of a step.

    speeds: (n,) float64 [m/s], the wanted mean speed of each remaining step; the last is the entry speed.
        Empty: the stance foot stands at the mark, take off from it.
    takeoff_error: u - u_h [m], distance to the obstacle at take-off beyond the wanted one; above 0: the
        last foothold is short of the mark, below 0: past it.
    cost: value of the objective of equation 15.
    """

    speeds: np.ndarray
    takeoff_error: float
    cost: float


@kernel
def _closed_form(
    gap: float, v0: float, entry: float, a: float, b: float, wu: float, w: np.ndarray, v: np.ndarray
) -> None:
    """Optimum without bounds into v (n,): the stationarity conditions reduce to one linear equation in m."""
    n = v.size
    s0 = s1 = s2 = 0.0
    for i in range(n):
        c = float(n - i)
        s0 += 1.0 / w[i]
        s1 += c / w[i]
        s2 += c * c / w[i]
    rest = gap - n * b - a * n * v0
    m = wu * (rest - a * s1 * (entry - v0) / s0) / (1.0 + wu * a * a * (s2 - s1 * s1 / s0))
    lam = (entry - v0 - a * m * s1) / s0
    speed = v0
    for i in range(n):
        speed += (lam + a * m * (n - i)) / w[i]
        v[i] = speed
    v[n - 1] = entry


@kernel
def _free_optimum(
    gap: float,
    v0: float,
    a: float,
    b: float,
    wu: float,
    w: np.ndarray,
    v: np.ndarray,
    fixed: np.ndarray,
    x: np.ndarray,
    work: np.ndarray,
) -> None:
    """Optimum over the free speeds, the fixed ones kept at v: tridiagonal solve plus the rank-one term."""
    n = v.size
    upper, p, q = work[0], work[1], work[2]
    for i in range(n):
        if fixed[i]:
            upper[i], p[i], q[i] = 0.0, v[i], 0.0
            continue
        after = w[i + 1]  # the last speed is always fixed, so i + 1 exists
        left = v0 if i == 0 else p[i - 1]
        left_q = 0.0 if i == 0 else q[i - 1]
        left_upper = 0.0 if i == 0 else upper[i - 1]
        pivot = w[i] + after - w[i] * left_upper
        upper[i] = after / pivot
        p[i] = w[i] * left / pivot
        q[i] = (1.0 + w[i] * left_q) / pivot
    for i in range(n - 2, -1, -1):
        p[i] += upper[i] * p[i + 1]
        q[i] += upper[i] * q[i + 1]
    sum_p = sum_q = 0.0
    for i in range(n):
        sum_p += p[i]
        sum_q += q[i]
    m = wu * (gap - n * b - a * sum_p) / (1.0 + wu * a * a * sum_q)
    for i in range(n):
        x[i] = p[i] + a * m * q[i]


@allocating_kernel
def _active_set(
    gap: float,
    v0: float,
    entry: float,
    a: float,
    b: float,
    wu: float,
    w: np.ndarray,
    low: float,
    high: float,
    v: np.ndarray,
) -> None:
    """Optimum with low <= v <= high into v (n,), which holds the optimum without bounds on entry."""
    n = v.size
    fixed = np.zeros(n, dtype=np.bool_)
    x = np.empty(n)
    work = np.empty((3, n))
    for i in range(n):
        v[i] = min(max(v[i], low), high)
        fixed[i] = v[i] == low or v[i] == high
    v[n - 1] = entry
    fixed[n - 1] = True
    for _ in range(20 * n + 20):
        _free_optimum(gap, v0, a, b, wu, w, v, fixed, x, work)
        step, hit = 1.0, -1
        for i in range(n - 1):
            if fixed[i]:
                continue
            bound = high if x[i] > v[i] else low
            reach = x[i] - v[i]
            if (x[i] > high or x[i] < low) and (bound - v[i]) / reach < step:
                step, hit = (bound - v[i]) / reach, i
        for i in range(n - 1):
            if not fixed[i]:
                v[i] += step * (x[i] - v[i])
        if hit >= 0:
            v[hit] = high if x[hit] > high else low
            fixed[hit] = True
            continue
        total = 0.0
        for i in range(n):
            total += v[i]
        pull = wu * a * (gap - n * b - a * total)
        worst, release = 1e-10, -1
        for i in range(n - 1):
            if fixed[i]:
                before = v0 if i == 0 else v[i - 1]
                slope = w[i] * (v[i] - before) - w[i + 1] * (v[i + 1] - v[i]) - pull
                gain = slope if v[i] == high else -slope
                if low == high:
                    gain = 0.0
                if gain > worst:
                    worst, release = gain, i
        if release < 0:
            return
        fixed[release] = False


@kernel
def _evaluate(
    gap: float, v0: float, a: float, b: float, wu: float, w: np.ndarray, v: np.ndarray
) -> tuple[float, float]:
    """(take-off error, cost) of the speeds v (n,)."""
    before, cost, error = v0, 0.0, gap
    for i in range(v.size):
        cost += w[i] * (v[i] - before) ** 2
        error -= a * v[i] + b
        before = v[i]
    return error, cost + wu * error * error


@allocating_kernel
def plan_kernel(
    gap: float,
    v0: float,
    entry: float,
    a: float,
    b: float,
    wu: float,
    tail: np.ndarray,
    low: float,
    high: float,
    first: int,
    last: int,
    speeds: np.ndarray,
) -> tuple[int, float, float]:
    """Best plan over n = first..last into speeds (>= last,); returns (n, take-off error, cost).

    tail: (k,) weights of the changes of speed counted from the last step backwards; the k-th serves all
    earlier steps too.
    """
    best_n, best_error, best_cost = -1, 0.0, np.inf
    w = np.empty(last)
    trial = np.empty(last)
    for n in range(first, last + 1):
        for i in range(n):
            w[i] = tail[min(n - 1 - i, tail.size - 1)]
        v = trial[:n]
        if n == 0:
            error = gap
            cost = wu * gap * gap + tail[0] * (entry - v0) ** 2
        else:
            _closed_form(gap, v0, entry, a, b, wu, w[:n], v)
            outside = False
            for i in range(n - 1):
                outside = outside or v[i] < low or v[i] > high
            if outside:
                _active_set(gap, v0, entry, a, b, wu, w[:n], low, high, v)
            error, cost = _evaluate(gap, v0, a, b, wu, w[:n], v)
        if cost < best_cost:
            best_n, best_error, best_cost = n, error, cost
            speeds[:n] = v
    return best_n, best_error, best_cost


class ApproachWeights(NamedTuple):
    """What counts how much in the plan of a run-up.

    error: w_u [1/m²], at least 0, of a stance foot that is not at its mark.
    change: w_i [s²/m²], above 0, of changes of speed: one for all, or several counted from the last step
        backwards; the last one given serves all earlier steps.
    """

    error: float = 100.0
    change: float | Sequence[float] = 1.0


_USUAL = ApproachWeights()


def _check(
    distance: float,
    speed: float,
    entry: float,
    takeoff: float,
    step_length: tuple[float, float],
    bounds: tuple[float, float] | None,
    weights: ApproachWeights,
    steps: int | None,
) -> tuple[float, float, float, float, float, np.ndarray]:
    values = {"distance": distance, "speed": speed, "entry": entry, "takeoff": takeoff}
    for name, value in values.items():
        if not np.isfinite(value):
            raise LocomotionError(f"{name} must be a finite number, not {value}")
    if speed < 0 or entry <= 0:
        raise LocomotionError(f"speed must be >= 0 and entry > 0 [m/s], not {speed} and {entry}")
    a, b = step_length
    if not (np.isfinite(a) and np.isfinite(b) and a >= 0 and a * entry + b > 0):
        raise LocomotionError(f"step_length (a, b) must have a >= 0 and a step > 0 m at entry, not {(a, b)}")
    low, high = (-np.inf, np.inf) if bounds is None else bounds
    if not low <= entry <= high:
        raise LocomotionError(f"bounds {(low, high)} must hold the entry speed {entry} m/s")
    tail = np.atleast_1d(np.asarray(weights.change, dtype=np.float64))
    if tail.ndim != 1 or tail.size == 0 or not np.all(np.isfinite(tail)) or np.any(tail <= 0):
        raise LocomotionError("weights.change must be one or more finite numbers above 0")
    if not (np.isfinite(weights.error) and weights.error >= 0):
        raise LocomotionError(f"weights.error must be a finite number >= 0, not {weights.error}")
    if steps is not None and not 0 <= steps <= _MAX_STEPS:
        raise LocomotionError(f"steps must be in 0..{_MAX_STEPS}, not {steps}")
    return float(distance - takeoff), float(a), float(b), float(low), float(high), tail


def _range_of_steps(
    gap: float, speed: float, entry: float, a: float, b: float, low: float, high: float, steps: int | None
) -> tuple[int, int]:
    """Numbers of steps worth trying: what the distance takes between the two speeds, and more."""
    if steps is not None:
        return steps, steps
    present = min(max(speed, low), high)
    lengths = [max(a * v + b, 0.05) for v in (0.95 * min(present, entry), 1.05 * max(present, entry))]
    first, last = (int(np.clip(gap / length, 0, _MAX_STEPS - 2)) for length in reversed(lengths))
    return max(first - 1, 0), last + 2


def plan_approach(
    distance: float,
    speed: float,
    entry: float,
    takeoff: float = 0.0,
    step_length: tuple[float, float] = (0.2, 0.17),
    *,
    bounds: tuple[float, float] | None = None,
    weights: ApproachWeights = _USUAL,
    steps: int | None = None,
) -> ApproachPlan:
    """Speeds of the remaining steps of a run-up (equation 15, in closed form; with bounds, an active set).

    distance: from the stance foot to the obstacle's edge, along the run-up [m].
    speed: present speed [m/s], >= 0.
    entry: wanted speed of the last step, v_in [m/s], > 0.
    takeoff: wanted distance from the last stance foot to the edge, u_h [m].
    step_length: (a, b) of the step length a v + b: a [s] >= 0, b [m]; the default is the paper's character.
    bounds: lowest and highest planned speed [m/s]; must hold `entry`. None: unbounded.
    weights: what counts how much.
    steps: number of steps; None: the best of the numbers that the distance suggests (0 to 512).

    Raises LocomotionError for values out of these ranges.
    """
    gap, a, b, low, high, tail = _check(distance, speed, entry, takeoff, step_length, bounds, weights, steps)
    first, last = _range_of_steps(gap, speed, entry, a, b, low, high, steps)
    speeds = np.empty(last)
    n, error, cost = plan_kernel(gap, speed, entry, a, b, weights.error, tail, low, high, first, last, speeds)
    return ApproachPlan(speeds[:n].copy(), error, cost)


def plan_approach_exact(
    distance: float,
    speed: float,
    entry: float,
    takeoff: float = 0.0,
    step_length: tuple[float, float] = (0.2, 0.17),
    *,
    bounds: tuple[float, float] | None = None,
    weights: ApproachWeights = _USUAL,
    steps: int | None = None,
) -> ApproachPlan:
    """The same plan through cvxpy (needs the `exact` extra): arguments as `plan_approach`."""
    import cvxpy

    gap, a, b, low, high, tail = _check(distance, speed, entry, takeoff, step_length, bounds, weights, steps)
    first, last = _range_of_steps(gap, speed, entry, a, b, low, high, steps)
    best: ApproachPlan | None = None
    for n in range(first, last + 1):
        changing = np.array([tail[min(n - 1 - i, tail.size - 1)] for i in range(n)])
        if n == 0:
            plan = ApproachPlan(np.empty(0), gap, weights.error * gap**2 + tail[0] * (entry - speed) ** 2)
        else:
            v = cvxpy.Variable(n)
            error = gap - n * b - a * cvxpy.sum(v)
            changes = cvxpy.diff(cvxpy.hstack([np.array([speed]), v]))
            effort = cvxpy.sum(cvxpy.multiply(changing, cvxpy.square(changes)))
            objective = weights.error * cvxpy.square(error) + effort
            constraints: list[Any] = [v[n - 1] == entry]
            if np.isfinite(low):
                constraints.append(v >= low)
            if np.isfinite(high):
                constraints.append(v <= high)
            problem = cvxpy.Problem(cvxpy.Minimize(objective), constraints)
            problem.solve(solver=cvxpy.CLARABEL)
            if v.value is None:
                raise LocomotionError(f"the reference solver did not solve the plan: {problem.status}")
            speeds = np.asarray(v.value, dtype=np.float64)
            final = gap - n * b - a * float(speeds.sum())
            plan = ApproachPlan(speeds, final, float(np.asarray(problem.value)))
        if best is None or plan.cost < best.cost:
            best = plan
    assert best is not None
    return best
