"""Common parts of the benchmarks of graph and routes: levels, the peer, the table and the JSON."""

import argparse
import json
import math
import os
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.shared_data import LEVELS, level_path, queries_path, shared_folder, why_absent
from navmesh import WalkRules

__all__ = ["Target", "ask_peer", "run"]

Target = tuple[str, str, Callable]
"""What is said when it is missed, the figure's key, and whether a value of it holds."""


def ask_peer(mode: str, level: str | Path, *arguments: object) -> str:
    """What the peer (Recast and Detour) prints in ``mode`` for one of `LEVELS` or for an OBJ file (Y up); it
    is compiled on the first call. Raises `subprocess.CalledProcessError` if it gives up."""
    folder = shared_folder()
    assert folder is not None
    program = Path(os.environ.get("TMPDIR", "/tmp")) / "surefoot-peer" / "recast_bench"
    if not program.exists():
        script = folder / "bench" / "peer" / "run_native.sh"
        example = (level_path(LEVELS[0]), queries_path(LEVELS[0]))
        subprocess.run([script, *example], check=True, capture_output=True)
    command = [program, mode, level if isinstance(level, Path) else level_path(level), *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def _show(title: str, results: dict[str, dict]) -> None:
    """Print the figures as a table, one column for each level."""
    table = Table("figure", *results, title=title)
    for key in next(iter(results.values())):
        row = []
        for figures in results.values():
            value = figures[key]
            if isinstance(value, dict):
                row.append(" ".join(str(v) for v in value.values()))
            else:
                row.append(f"{value:.5g}" if isinstance(value, float) else str(value))
        table.add_row(key, *row)
    Console(width=120).print(table)


def run(
    doc: str | None,
    title: str,
    measure: Callable[[str, WalkRules, int, int, np.random.Generator], dict],
    targets: list[Target],
    *,
    samples: int,
    samples_of: str,
) -> int:
    """Measure the shared levels, as the command line says; exit code 1 when a figure misses its target.

    ``measure`` takes a level's name, the rules, how many ``samples_of`` to take, the rounds of timing and the
    generator, and returns the figures. The rules are those of the body of the shared queries.
    """
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--levels", nargs="+", choices=LEVELS, default=LEVELS, metavar="LEVEL")
    parser.add_argument("--json", type=Path, help="where to write the figures")
    parser.add_argument("--resolution", type=float, default=0.25, help="[m] side of a cell")
    parser.add_argument("--samples", type=int, default=samples, help=f"{samples_of} per level")
    parser.add_argument("--repeats", type=int, default=12, help="rounds of timing")
    options = parser.parse_args()
    if shared_folder() is None:
        print(f"skipped: {why_absent()}")
        return 0
    rules = WalkRules(max_slope=math.radians(45), max_step=0.9, headroom=2.0, resolution=options.resolution)
    rng = np.random.default_rng(1)
    results = {name: measure(name, rules, options.samples, options.repeats, rng) for name in options.levels}
    _show(title, results)
    missed = [
        f"{name}: {what} ({figures[key]})"
        for name, figures in results.items()
        for what, key, holds in targets
        if not holds(figures[key])
    ]
    print("missed: " + "; ".join(missed) if missed else "every figure meets its target")
    if options.json:
        with tempfile.NamedTemporaryFile("w", dir=options.json.parent, delete=False) as file:
            json.dump({"resolution": options.resolution, "levels": results, "missed": missed}, file, indent=1)
        os.replace(file.name, options.json)
    return 1 if missed else 0
