"""How much longer routes are than the shortest way, and than the same way back. Prints the figures.

    python -m benchmarks.shortest_routes [--scenes 300] [--first 1000] [--pairs 60]

Each scene is a floor with one to seven boxes on it, of any size, at any angle, some of them thin walls, for a
body of a random radius. The oracle is exact (`benchmarks.visibility`), for a body 2 cm wider than the
route's, because narrower passages need not be found.
"""

import argparse
import sys
from dataclasses import dataclass

import numpy as np

from benchmarks.visibility import Boxes, boxes_level, gaps_to_boxes, random_boxes, shortest_ways
from navmesh import NodeGraph, WalkRules

__all__ = ["Comparison", "compare"]

_SLACK = 0.01
"""[m] that the oracle's body is wider than the route's, on either side."""


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """What one scene shows, for the pairs that are complete both ways."""

    longest: np.ndarray
    """(k,) the longer of there and back, as a multiple of the shortest way."""
    uneven: np.ndarray
    """(k,) the longer of there and back, as a multiple of the shorter."""
    pairs: np.ndarray
    """(k, 2, 2) float64 [m]: start and goal."""
    lost: int
    """Pairs that the oracle joins and the graph does not."""
    radius: float


def compare(seed: int, pairs: int, boxes: Boxes | None = None, radius: float | None = None) -> Comparison:
    """Routes between ``pairs`` of random places of a scene, there and back, against the oracle."""
    rng = np.random.default_rng(seed)
    scene = random_boxes(rng, int(rng.integers(1, 8))) if boxes is None else boxes
    wide = float(rng.choice([0.1, 0.2, 0.3, 0.45, 0.6, 0.8])) if radius is None else radius
    graph = NodeGraph.build(boxes_level(scene), WalkRules(), obstacle_rules=None)
    points = rng.uniform((0.0, 0.0), scene.floor, (6 * pairs, 2))
    points = points[gaps_to_boxes(scene, points) >= wide + 0.05][: 2 * pairs]
    count = len(points) // 2
    starts, goals = points[:count], points[count : 2 * count]
    best = shortest_ways(scene, starts, goals, wide + _SLACK)
    first, last = (np.column_stack([ends, np.zeros(count)]) for ends in (starts, goals))
    there, back = graph.find_paths(first, last, wide), graph.find_paths(last, first, wide)
    both = (there.status == "complete") & (back.status == "complete")
    kept = both & np.isfinite(best)
    longer = np.maximum(there.length, back.length)[kept]
    shorter = np.minimum(there.length, back.length)[kept]
    return Comparison(
        longest=longer / best[kept],
        uneven=longer / shorter,
        pairs=np.stack([starts, goals], axis=1)[kept],
        lost=int((np.isfinite(best) & ~both).sum()),
        radius=wide,
    )


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--first", type=int, default=1000, help="seed of the first scene")
    parser.add_argument("--pairs", type=int, default=60, help="of places in each scene")
    options = parser.parse_args()
    found = {
        seed: compare(seed, options.pairs) for seed in range(options.first, options.first + options.scenes)
    }
    longest = np.concatenate([each.longest for each in found.values()])
    uneven = np.concatenate([each.uneven for each in found.values()])
    print(
        f"{len(longest)} pairs in {len(found)} scenes; {sum(each.lost for each in found.values())} not found"
    )
    for name, ratio, limit in (("shortest way", longest, 1.05), ("way back", uneven, 1.02)):
        print(
            f"longer than the {name}: mean {ratio.mean():.5f}, 99 % up to {np.quantile(ratio, 0.99):.4f}, "
            f"at most {ratio.max():.4f}; {(ratio > limit).sum()} above {limit}"
        )
    for seed in sorted(found, key=lambda seed: -found[seed].longest.max(initial=0.0))[:5]:
        each = found[seed]
        worst = int(each.longest.argmax())
        ends = each.pairs[worst].round(3).tolist()
        print(f"  seed {seed}, radius {each.radius}: {each.longest[worst]:.3f} times, {ends[0]} to {ends[1]}")
    return int(longest.max() > 1.05 or uneven.max() > 1.02)


if __name__ == "__main__":
    sys.exit(main())
