"""How valid, how near the optimum and how fast path smoothing is. Prints a table and writes JSON.

    python -m benchmarks.smoothing [--json FILE] [--routes 1002] [--exact 1002] [--bounded 60] [--constructed
    40]

On routes between the shared queries' pairs on the three shared levels (body radius 0.6 m), or on random
corridors without the shared data: points of the curve outside the corridor, the objective against cvxpy,
times against cvxpy and against springs at equal objective, and the bound on curvature with end tangents.
"""

import argparse
import csv
import json
import time
from collections import Counter
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.corridors import bounded_curve, disc_chain, sharp_corner, turn_on_the_spot
from benchmarks.shared_data import LEVELS, level_path, queries_path, shared_folder
from benchmarks.springs import DAMPINGS, simulate
from pathsmooth import PathSmoothError, Problem, curvature, kernels, reference, solve, solve_exact
from pathsmooth.solver import CHECKS, MAX_ITERATIONS, RELAXATION

BODY = 0.6  # [m]
BOUNDS = (0.2, 0.5, 1.0)  # [1/m]


def real_routes(count):
    """(waypoints, centers, radii) of walked legs on the shared levels, evenly from each."""
    from navmesh import NodeGraph, Terrain, WalkRules

    routes = []
    for level in LEVELS:
        graph = NodeGraph.build(Terrain.load(str(level_path(level)), up="y"), WalkRules())
        found = []
        with open(queries_path(level)) as file:
            for row in csv.DictReader(file):
                start, goal = ([float(row[a + "x"]), -float(row[a + "z"]), float(row[a + "y"])] for a in "sg")
                route = graph.find_path(np.array(start), np.array(goal), radius=BODY)
                if route.status == "complete":
                    found += [(leg.waypoints, leg.centers, leg.radii) for leg in route.legs()]
                if len(found) >= -(-count // len(LEVELS)):
                    break
        routes += found
    return routes


def usable(routes):
    """The routes whose corridor covers the pulled path, and what is wrong with the others."""
    good, refused = [], []
    for route in routes:
        try:
            Problem.from_corridor(*route)
        except PathSmoothError as error:
            refused.append(str(error))
        else:
            good.append(route)
    return good, refused


def outside(points, problem, per_segment=10):
    """How many samples of the polyline are more than 1e-9 m outside every disc of the corridor; how many
    there are."""
    t = np.linspace(0, 1, per_segment, endpoint=False)[:, None, None]
    curve = ((1 - t) * points[:-1, :2] + t * points[1:, :2]).reshape(-1, 2)
    beyond = np.full(len(curve), np.inf)
    for center, radius in zip(problem.centers, problem.radii, strict=True):
        beyond = np.minimum(beyond, np.hypot(*(curve - center).T) - radius)
    return int((beyond > 1e-9).sum()), len(curve)


def median_time(call, repeats):
    """Median CPU time of a call [µs]."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return float(np.median(times)) * 1e6


def summary(values):
    """Median, 95th percentile and greatest of some values."""
    return {
        k: float(v)
        for k, v in zip(("median", "p95", "max"), np.percentile(values, [50, 95, 100]), strict=True)
    }


def validity_and_optimality(routes, exact_count):
    """Points outside, and the objective above cvxpy's, at the default stopping rule and after fixed
    iterations."""
    problems = [Problem.from_corridor(*route) for route in routes]
    solutions = [solve(problem) for problem in problems]
    bad, samples = np.sum([outside(s.points, p) for s, p in zip(solutions, problems, strict=True)], axis=0)
    raised = sum(
        s.objective > p.objective(p.targets) * (1 + 1e-12) for s, p in zip(solutions, problems, strict=True)
    )
    above = {name: [] for name in ("default", "12 iterations", "25 iterations")}
    times = []
    stride = max(1, len(problems) // max(exact_count, 1))
    for problem, solution in list(zip(problems, solutions, strict=True))[::stride][:exact_count]:
        begin = time.process_time()
        best = solve_exact(problem).objective
        times.append(time.process_time() - begin)
        # the optimum is known to the other solver's accuracy only
        scale = max(best, 1e-4)
        above["default"].append((solution.objective - best) / scale)
        for count in (12, 25):
            value = solve(problem, iterations=count, tolerance=0.0).objective
            above[f"{count} iterations"].append((value - best) / scale)
    return {
        "routes": len(problems),
        "waypoints": summary([p.count for p in problems]),
        "samples of the curve": int(samples),
        "samples outside the corridor": int(bad),
        "objectives raised": int(raised),
        "status": dict(Counter(s.status for s in solutions)),
        "iterations": summary([s.iterations for s in solutions]),
        "routes compared with cvxpy": len(times),
        "objective above cvxpy's": {name: summary(values) for name, values in above.items()},
        "share of routes within 1 %": {
            name: float(np.mean(np.array(v) <= 0.01)) for name, v in above.items()
        },
    }


def of_128(routes, count):
    """Problems of 128 waypoints: routes divided a little finer or coarser."""
    problems = []
    for route in routes:
        length = np.hypot(*np.diff(route[0][:, :2], axis=0).T).sum()
        for pieces in range(127, 90, -2):
            problem = Problem.from_corridor(*route, spacing=length / pieces) if 20 < length < 50 else None
            if problem is None or problem.count <= 128:
                break
        if problem is not None and problem.count == 128 and solve(problem).objective > 0.01:
            problems.append((route, problem))
        if len(problems) == count:
            break
    return problems


def speed(routes):
    """Times at 128 waypoints, interleaved with those of cvxpy and of the springs."""
    chosen = of_128(routes, 60)
    rows = []
    best_damping = min(
        DAMPINGS,
        key=lambda damping: np.median(
            [
                simulate(p.packed, p.first, p.last, damping, 200, 0.0, 200)[1] / solve(p).objective
                for _, p in chosen
            ]
        ),
    )
    for route, problem in chosen:
        state, points = np.zeros((3, problem.count, 2)), np.empty((problem.count, 3))

        def kernel(problem=problem, state=state, points=points):
            state.fill(0.0)
            kernels.solve(
                problem.packed, problem.targets, problem.heights, problem.first, problem.last, RELAXATION,
                MAX_ITERATIONS, 0.01, *CHECKS, state, points,
            )  # fmt: skip

        solution = solve(problem)
        target = 1.01 * solution.objective
        spring_call = (problem.packed, problem.first, problem.last, best_damping, 20000, target, 5)
        steps, reached = simulate(*spring_call)
        row = {
            "solve": median_time(lambda p=problem: solve(p), 25),
            "kernel": median_time(kernel, 25),
            "from_corridor": median_time(
                lambda r=route, p=problem: Problem.from_corridor(*r, spacing=p.spacing), 9
            ),
            "springs": median_time(lambda c=spring_call: simulate(*c), 3),
            "cvxpy": median_time(lambda p=problem: solve_exact(p), 1),
            "iterations": solution.iterations,
            "spring steps": steps,
            "springs get there": reached <= target,
        }
        for count in (12, 25, 50, 200):
            row[f"springs after {count}"] = (
                simulate(*spring_call[:4], count, 0.0, count)[1] / solution.objective - 1
            )
        for count in (12, 50):
            plain = problem.objective(reference.two_pass(problem, count))
            row[f"two passes after {count}"] = plain / solution.objective - 1
        rows.append(row)
    column = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    times = {key: summary(column[key]) for key in ("solve", "kernel", "from_corridor", "springs", "cvxpy")}
    return {
        "paths of 128 waypoints": len(rows),
        "time [µs]": times,
        "iterations": summary(column["iterations"]),
        "cvxpy / solve": float(np.median(column["cvxpy"] / column["solve"])),
        "springs / kernel at an objective 1 % higher": float(np.median(column["springs"] / column["kernel"])),
        "springs' damping": best_damping,
        "springs that reach it in 20,000 steps": float(column["springs get there"].mean()),
        "springs' objective above the solver's": {
            count: summary(column[f"springs after {count}"]) for count in (12, 25, 50, 200)
        },
        "plain two-pass algorithm's above the solver's": {
            count: summary(column[f"two passes after {count}"]) for count in (12, 50)
        },
    }


def bounded_row(problems):
    """Statuses, true curvature of the complete ones over the bound, and times."""
    statuses, worst, times, bad = Counter(), 0.0, [], 0
    for problem in problems:
        begin = time.process_time()
        solution = solve(problem)
        times.append((time.process_time() - begin) * 1e3)
        statuses[solution.status] += 1
        bad += outside(solution.points, solution.problem)[0]
        if solution.status == "complete":
            worst = max(worst, float(curvature(solution.points).max()) / problem.max_curvature)
    return {
        "problems": len(problems),
        "status": dict(statuses),
        "worst curvature / bound": worst,
        "samples outside": bad,
        "time [ms]": summary(times),
    }


def with_bound(routes, count, constructed):
    """The bound on curvature on routes, and on corridors where it is known whether it can be held."""
    result = {}
    for bound in BOUNDS:
        chosen = routes[:: max(1, len(routes) // max(count, 1))][:count]
        tangents = [{"start_tangent": w[1] - w[0], "end_tangent": w[-1] - w[-2]} for w, _, _ in chosen]
        sets = {
            "routes": [
                Problem.from_corridor(*route, max_curvature=bound, **ends)
                for route, ends in zip(chosen, tangents, strict=True)
            ]
        }
        makers = {
            "a curve exists": lambda rng, b=bound: bounded_curve(rng, b, rng.uniform(0.1, 0.5)),
            "none: sharp corner": lambda rng, b=bound: sharp_corner(rng, b),
            "none: turn on the spot": lambda rng, b=bound: turn_on_the_spot(rng, b, 0.8),
            "room to turn round": lambda rng, b=bound: turn_on_the_spot(rng, b, 3.5),
        }
        for name, make in makers.items():
            rng = np.random.default_rng(1)
            sets[name] = []
            for _ in range(constructed):
                *corridor, start, end = make(rng)
                problem = Problem.from_corridor(*corridor, 0.25, start, end, bound)
                sets[name].append(problem)
        result[str(bound)] = {name: bounded_row(problems) for name, problems in sets.items()}
    return result


def show(result):
    """Print the result as a table."""
    table = Table("what", "figure", title=f"Smoothing: {result['source']}")

    def add(name, value):
        if isinstance(value, dict) and set(value) == {"median", "p95", "max"}:
            value = f"median {value['median']:.4g}, 95 % {value['p95']:.4g}, max {value['max']:.4g}"
        if isinstance(value, dict):
            for key, inner in value.items():
                add(f"{name}: {key}" if name else str(key), inner)
        else:
            table.add_row(name, f"{value:.4g}" if isinstance(value, float) else str(value))

    add("", {key: value for key, value in result.items() if key != "source"})
    Console(width=150).print(table)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, default=Path("out/smoothing.json"))
    parser.add_argument("--routes", type=int, default=1002)
    parser.add_argument("--exact", type=int, default=1002, help="routes compared with cvxpy")
    parser.add_argument("--bounded", type=int, default=60, help="routes with a bound on curvature")
    parser.add_argument(
        "--constructed", type=int, default=40, help="corridors made for the bound, of each kind"
    )
    options = parser.parse_args()
    if shared_folder() is not None:
        source, routes = "routes on the shared levels", real_routes(options.routes)
    else:
        rng = np.random.default_rng(0)
        source = "random corridors (no shared levels here)"
        routes = [disc_chain(rng, int(rng.integers(2, 30)), (0.3, 4.0), 0.4) for _ in range(options.routes)]
    routes, refused = usable(routes)
    solve(Problem.from_corridor(*routes[0]))
    result = validity_and_optimality(routes, options.exact)
    result = {"source": source, "corridors refused": refused, **result, "speed": speed(routes)}
    result["bound on curvature"] = with_bound(routes, options.bounded, options.constructed)
    options.json.parent.mkdir(parents=True, exist_ok=True)
    options.json.write_text(json.dumps(result, indent=2) + "\n")
    show(result)


if __name__ == "__main__":
    main()
