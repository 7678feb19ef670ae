"""Routes with area costs, compared with Dijkstra's algorithm over a fine grid, on random patchworks.

    python -m benchmarks.area_costs --scenes 20 --first 5000

Each scene is a floor of 20 m with patches of random materials in a random grid, turned by a random angle,
and a few pillars. The reference goes over squares of 10 cm in 80 directions, with exact materials and
distances: a way that can be walked, dearer than the cheapest by about 1 %.
"""

import argparse
import itertools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from navmesh import NodeGraph, Terrain
from navmesh.routes.route import Route

__all__ = ["COSTS", "RADIUS", "Patchwork", "patchwork", "price"]

COSTS = {"grass": 1.0, "mud": 3.0, "rock": 1.5, "swamp": 10.0}
RADIUS = 0.3
_SIZE = 20.0
_H = 0.1  # [m], side of the reference's squares
_REACH = 5  # squares of one step of the reference


@dataclass(frozen=True)
class Patchwork:
    """A level whose materials are known everywhere."""

    terrain: Terrain
    kind: np.ndarray
    """(n, n) int: the place in `COSTS` of each patch."""
    angle: float
    pillars: list[tuple[float, float, float, float]]

    def costs_at(self, points: np.ndarray) -> np.ndarray:
        """What a metre costs at ``points`` (k, 2) [m]."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        flat = points @ np.array([[c, -s], [s, c]])
        n = len(self.kind)
        at = np.clip(((flat + _SIZE) / (2.0 * _SIZE) * n).astype(int), 0, n - 1)
        return np.array(list(COSTS.values()))[self.kind[at[:, 0], at[:, 1]]]

    def gap_at(self, points: np.ndarray) -> np.ndarray:
        """Distance [m] from ``points`` (k, 2) to the pillars and the rim."""
        x, y = points.T
        half = _SIZE / 2.0
        gap = half - np.maximum(np.abs(x), np.abs(y))
        for x0, x1, y0, y1 in self.pillars:
            dx = np.maximum(np.maximum(x0 - x, x - x1), 0.0)
            dy = np.maximum(np.maximum(y0 - y, y - y1), 0.0)
            gap = np.minimum(gap, np.hypot(dx, dy))
        return gap


def _clipped(corners: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """A convex polygon, cut at the square of the floor."""
    half = _SIZE / 2.0
    for axis, sign in itertools.product((0, 1), (1.0, -1.0)):
        kept: list[tuple[float, float]] = []
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            da, db = half - sign * a[axis], half - sign * b[axis]
            if da >= 0.0:
                kept.append(a)
            if da * db < 0.0:
                t = da / (da - db)
                kept.append((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
        corners = kept
    return corners


def patchwork(seed: int) -> Patchwork:
    """A random level."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(8, 17))
    angle = float(rng.uniform(0.0, math.pi / 2.0))
    kind = rng.integers(0, len(COSTS), (n, n))
    c, s = math.cos(angle), math.sin(angle)
    side = 2.0 * _SIZE / n
    names = list(COSTS)
    vertices, faces, materials = [], [], []

    def add(corners: list[tuple[float, float]], z: float, name: str) -> None:
        first = len(vertices)
        vertices.extend((x, y, z) for x, y in corners)
        for k in range(1, len(corners) - 1):
            faces.append((first, first + k, first + k + 1))
            materials.append(name)

    for i, j in itertools.product(range(n), range(n)):
        square = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        flat = [(a * side - _SIZE, b * side - _SIZE) for a, b in square]
        add(_clipped([(c * x - s * y, s * x + c * y) for x, y in flat]), 0.0, names[kind[i, j]])
    pillars = []
    for _ in range(int(rng.integers(2, 7))):
        x, y = rng.uniform(-8.0, 6.0, 2)
        wide, deep = rng.uniform(0.4, 3.0, 2)
        pillars.append((x, x + wide, y, y + deep))
        corners = [(x, y), (x + wide, y), (x + wide, y + deep), (x, y + deep)]
        add(corners, 2.5, "")
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
            first = len(vertices)
            vertices.extend([(ax, ay, 0.0), (bx, by, 0.0), (bx, by, 2.5), (ax, ay, 2.5)])
            faces.extend([(first, first + 1, first + 2), (first, first + 2, first + 3)])
            materials.extend(["", ""])
    terrain = Terrain.from_arrays(np.array(vertices), np.array(faces), materials=materials)
    return Patchwork(terrain, kind, angle, pillars)


def price(scene: Patchwork, waypoints: np.ndarray) -> float:
    """What a line costs, by its own points every 2 mm."""
    total = 0.0
    for a, b in itertools.pairwise(waypoints[:, :2]):
        length = float(np.linalg.norm(b - a))
        count = int(length / 2e-3) + 1
        at = a + (b - a) * ((np.arange(count) + 0.5) / count)[:, None]
        total += length * float(scene.costs_at(at).mean())
    return total


def reference(scene: Patchwork, start: np.ndarray, goals: np.ndarray) -> np.ndarray:
    """What the cheapest ways over the fine grid cost, from ``start`` (2,) to ``goals`` (k, 2), all of them
    middles of squares."""
    k = round(_SIZE / _H)
    ii, jj = np.meshgrid(np.arange(k), np.arange(k), indexing="ij")
    places = (np.stack([ii, jj], axis=-1).reshape(-1, 2) + 0.5) * _H - _SIZE / 2.0
    free = scene.gap_at(places) >= RADIUS
    sources, targets, weights = [], [], []
    for a, b in itertools.product(range(_REACH + 1), range(-_REACH, _REACH + 1)):
        if math.gcd(a, abs(b)) != 1 or (a == 0 and b < 0):
            continue
        inside = ((ii + a < k) & (jj + b >= 0) & (jj + b < k)).reshape(-1)
        source = np.flatnonzero(inside & free)
        target = source + a * k + b
        source, target = source[free[target]], target[free[target]]
        count = 6 * max(a, abs(b))
        total = np.zeros(len(source))
        for t in (np.arange(count) + 0.5) / count:
            on = places[source] + t * np.array([a, b]) * _H
            total += np.where(scene.gap_at(on) >= RADIUS, scene.costs_at(on), np.inf)
        fits = np.isfinite(total)
        sources.append(source[fits])
        targets.append(target[fits])
        weights.append(total[fits] / count * math.hypot(a, b) * _H)
    joined = np.concatenate(sources), np.concatenate(targets)
    grid = coo_matrix((np.concatenate(weights), joined), (k * k, k * k)).tocsr()
    index = [int(i) * k + int(j) for i, j in np.floor((np.vstack([start, goals]) + _SIZE / 2.0) / _H)]
    return dijkstra(grid, directed=False, indices=index[0])[index[1:]]


def _clocked(ask: Callable[[], Route]) -> tuple[Route, float]:
    """What a question answers, and how long [s] that takes: the least of five times."""
    times = []
    for _ in range(5):
        begun = time.perf_counter()
        route = ask()
        times.append(time.perf_counter() - begun)
    return route, min(times)


def compare(seed: int, pairs: int) -> list[tuple[float, float, float, float, float]]:
    """For each of ``pairs``: the price of the route with costs, of the way back, and of the route without, as
    shares of the reference's; then how long [s] a query takes with costs, and without."""
    scene, rng = patchwork(seed), np.random.default_rng(seed + 1)
    graph = NodeGraph.build(scene.terrain, obstacle_rules=None)
    places = (np.floor(rng.uniform(-9.5, 9.5, (20 * pairs, 2)) / _H) + 0.5) * _H
    places = places[scene.gap_at(places) > RADIUS + 0.05]
    start, goals = places[0], places[1 : pairs + 1]
    found = []
    for goal, best in zip(goals, reference(scene, start, goals), strict=True):
        if not 1.0 < best < math.inf:
            continue
        a, b = (*start, 0.0), (*goal, 0.0)
        there, with_costs = _clocked(lambda a=a, b=b: graph.find_path(a, b, RADIUS, costs=COSTS))
        plain, without = _clocked(lambda a=a, b=b: graph.find_path(a, b, RADIUS))
        routes = there, graph.find_path(b, a, RADIUS, costs=COSTS), plain
        if any(route.status != "complete" for route in routes):
            raise AssertionError(f"scene {seed}: no route from {a} to {b}")
        shares = [price(scene, route.waypoints) / best for route in routes]
        found.append((*shares, with_costs, without))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description="Area costs against a fine grid.")
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--first", type=int, default=5000)
    parser.add_argument("--pairs", type=int, default=20)
    options = parser.parse_args()
    rows = []
    for seed in range(options.first, options.first + options.scenes):
        rows += compare(seed, options.pairs)
    ratio, back, plain, with_costs, without = np.array(rows).T
    print(f"{len(rows)} pairs in {options.scenes} scenes; price as a share of the reference's")
    for name, each in (("with costs", ratio), ("without", plain)):
        print(
            f"{name:>11}: mean {each.mean():.3f}, worst {each.max():.3f}, "
            f"above 1.05: {(each > 1.05).mean():.1%}, above 1.10: {(each > 1.1).mean():.1%}"
        )
    turn = np.maximum(ratio / back, back / ratio)
    print(f"there and back: worst {turn.max():.3f}, above 1.02: {(turn > 1.02).mean():.1%}")
    print(
        f"a query takes {1e6 * np.median(with_costs):.0f} µs with costs, {1e6 * np.median(without):.0f} µs "
        f"without (medians): {np.median(with_costs / without):.1f} times as long"
    )


if __name__ == "__main__":
    main()
