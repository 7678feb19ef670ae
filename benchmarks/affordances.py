"""Obstacle detection: synthetic obstacles against the truth, counts on levels, and time.

python -m benchmarks.affordances [--scenes 200] [--json affordances.json]
"""

import argparse
import json
import time
from collections import Counter
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import navmesh
from benchmarks.obstacle_scenes import KINDS, Scene, random_scene
from benchmarks.shared_data import LEVELS, level_path, shared_folder, why_absent
from navmesh.graph.links import make_links
from navmesh.obstacles.detection import detect_obstacles
from navmesh.obstacles.kinds import affordances
from navmesh.obstacles.obstacles import Obstacles
from navmesh.surface.build import build_surface

ERRORS = ("edge", "middle", "normal", "height", "depth", "width")
OWN = Path(__file__).resolve().parents[1] / "examples" / "levels" / "courtyard.obj"


def compare(scene: Scene, found: Obstacles) -> dict[str, list[float]]:
    """Errors of what was found in a scene: position off the edge and off its middle [m], normal [degrees],
    height, depth and width [m], one per match; and how many are missed or false."""
    errors: dict[str, list[float]] = {
        name: [] for name in ("edge", "middle", "normal", "height", "depth", "width")
    }
    used: set[int] = set()
    missed = 0
    for truth in scene.truths:
        a, b = truth.ends
        best, nearest = -1, 0.3
        for k in range(len(found)):
            part = np.clip((found.position[k] - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            off = float(np.linalg.norm(found.position[k] - a - part * (b - a)))
            if k not in used and found.affordance[k] == truth.affordance and off < nearest:
                if found.normal[k] @ truth.normal > 0.9:
                    best, nearest = k, off
        if best < 0:
            missed += 1
            continue
        used.add(best)
        errors["edge"].append(nearest)
        errors["middle"].append(float(np.linalg.norm(found.position[best] - (a + b) / 2)))
        cosine = float(np.clip(found.normal[best] @ truth.normal, -1, 1))
        errors["normal"].append(float(np.degrees(np.arccos(cosine))))
        errors["height"].append(abs(float(found.height[best]) - truth.height))
        errors["width"].append(abs(float(found.width[best]) - float(np.linalg.norm(b - a))))
        if truth.depth is not None:
            errors["depth"].append(abs(float(found.depth[best]) - truth.depth))
    return {**errors, "missed": [missed], "false": [len(found) - len(used)]}


def synthetic(scenes: int, seed: int) -> dict[str, dict[str, float]]:
    """The accuracy table: per kind of scene the largest error of each sort, missed and false."""
    rules = navmesh.WalkRules()
    table: dict[str, dict[str, float]] = {}
    for kind in KINDS:
        rng = np.random.default_rng([seed, KINDS.index(kind)])
        total: dict[str, list[float]] = {}
        for _ in range(scenes):
            scene = random_scene(kind, rng)
            found = detect_obstacles(scene.terrain, build_surface(scene.terrain, rules), rules)
            for name, values in compare(scene, found).items():
                total.setdefault(name, []).extend(values)
        row: dict[str, float] = {"scenes": scenes, "found": len(total["edge"])}
        row |= {name: sum(total[name]) for name in ("missed", "false")}
        row |= {name: max(total[name], default=0.0) for name in total if name not in ("missed", "false")}
        table[kind] = row
    return table


def on_level(path: Path, up: str, repeats: int) -> dict[str, float | dict[str, int]]:
    """Counts on one level and the least time of each stage [ms]."""
    terrain = navmesh.Terrain.load(path, up=up)
    rules = navmesh.WalkRules()
    builds, finds, joins = [], [], []
    obstacles, links = Obstacles.empty(), None
    for _ in range(repeats):
        begin = time.perf_counter()
        graph = navmesh.NodeGraph.build(terrain, rules, obstacle_rules=None)
        built = time.perf_counter()
        obstacles = detect_obstacles(terrain, graph.surface, rules)
        detected = time.perf_counter()
        links = make_links(obstacles, graph.surface, rules)
        done = time.perf_counter()
        builds.append(built - begin)
        finds.append(detected - built)
        joins.append(done - detected)
    counts = Counter(obstacles.affordance.tolist())
    return {
        "triangles": len(terrain.faces),
        "counts": {name: counts.get(name, 0) for name in affordances()},
        "links": len(links) if links is not None else 0,
        "build_ms": 1e3 * min(builds),
        "detect_ms": 1e3 * min(finds),
        "links_ms": 1e3 * min(joins),
        "ratio": (min(finds) + min(joins)) / min(builds),
    }


def main() -> None:
    """Print both tables; write them as JSON where asked."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=200, help="synthetic scenes per kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=5, help="timed runs per level; the least time counts")
    parser.add_argument("--json", type=Path, help="also write the figures here")
    arguments = parser.parse_args()
    console = Console(width=120)
    levels = {"courtyard": on_level(OWN, "z", arguments.repeats)}
    if shared_folder() is None:
        console.print(f"shared levels left out: {why_absent()}")
    else:
        levels |= {name: on_level(level_path(name), "y", arguments.repeats) for name in LEVELS}
    sheet = Table(
        "level",
        "triangles",
        "jump",
        "vault",
        "drop",
        "gap",
        "links",
        "build, ms",
        "detect, ms",
        "links, ms",
        "ratio",
    )
    for name, row in levels.items():
        counts = row["counts"]
        assert isinstance(counts, dict)
        numbers = [f"{row[key]:.1f}" for key in ("build_ms", "detect_ms", "links_ms")]
        sheet.add_row(
            name, str(row["triangles"]), *(str(v) for v in counts.values()), str(row["links"]), *numbers,
            f"{row['ratio']:.2f}",
        )  # fmt: skip
    console.print(sheet)
    accuracy = synthetic(arguments.scenes, arguments.seed)
    heads = [f"{name}, {'°' if name == 'normal' else 'm'}" for name in ERRORS]
    sheet = Table("kind", "scenes", "found", "missed", "false", *heads)
    for kind, row in accuracy.items():
        sheet.add_row(
            kind,
            *(str(int(row[name])) for name in ("scenes", "found", "missed", "false")),
            *(f"{row[name]:.4f}" for name in ERRORS),
        )
    console.print("largest errors on synthetic obstacles:")
    console.print(sheet)
    if arguments.json:
        arguments.json.write_text(json.dumps({"levels": levels, "synthetic": accuracy}, indent=1) + "\n")


if __name__ == "__main__":
    main()
