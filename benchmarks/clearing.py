"""How well people clear obstacles from a run, height by height, and what goes wrong.

    python -m benchmarks.clearing jump [--heights 0.3 0.4 0.5] [--every 0.1] [--json jumping.json]

For every height the person starts from standing, 10 to 30 m before the obstacle (a stair up, a wall 0.3 m
thick, a ledge), runs up, clears it and goes on to a goal 15 m behind: as in a mission (path tracking, speed
planner, skill), on a triangle mesh, with noise of 0.02 m/s and rad/s in the start. Held: it arrives, and in a
vault its hand has borne on the top. Clean: of these, only permitted parts have touched (feet; vault: hands
and forearms; drop: all but the head). Middle: a vaulting hand came to the middle half of the top. Joint: the
same starts with a ball joint that holds the hand, as in the paper.
"""

import argparse
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from locomotion import Human
from locomotion.gaits.run.skill import load_run_skill
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import learned_skills
from locomotion.skills.vault.skill import Vault
from runtime.evaluation.courses import CourseRun, held, make_course, run_course
from runtime.evaluation.evaluation import WALL, start_noise

NEAREST, FARTHEST = 10.0, 30.0


def with_joint() -> Sequence[ClearingSkill]:
    """The package's skills, of which the vault holds the hand by the paper's joint."""
    skills = learned_skills(load_run_skill())
    for skill in skills:
        if isinstance(skill, Vault):
            skill.joint = True
    return skills


def run_up(
    affordance: str,
    height: float,
    distance: float,
    rehearsals: int,
    clearing: Sequence[ClearingSkill] | None = None,
) -> CourseRun:
    """One start."""
    course = make_course([(affordance, height, WALL)], [distance])
    return run_course(course, clearing, start_noise(17, distance), rehearsals=rehearsals)


def summary(affordance: str, height: float, distances: np.ndarray, rehearsals: int) -> dict[str, Any]:
    """The figures of one height."""
    runs = [run_up(affordance, height, d, rehearsals) for d in distances]
    good = [run.reports[0] for run in runs if held(affordance, run)]
    taken = [run.reports[0] for run in runs if run.reports]

    def mean(values: list) -> float:
        return float(np.mean(values)) if values else np.nan

    figures = {
        "height": height,
        "starts": len(runs),
        "held": mean([held(affordance, run) for run in runs]),
        "clean": mean([not p.touched and p.head == 0.0 for p in good]),
        "takeoff_error_rms": mean([p.takeoff_error**2 for p in taken]) ** 0.5,
        "speed_error_mean": mean([p.speed_error for p in taken]),
        "peak_median": float(np.median([p.peak for p in good])) if good else np.nan,
        "ends": dict(Counter(run.ended for run in runs)),
        "runs": [{"ended": run.ended, "reports": [asdict(p) for p in run.reports]} for run in runs],
    }
    if affordance == "vault":
        others = [run_up(affordance, height, d, rehearsals, with_joint()) for d in distances]
        figures["middle"] = mean([abs(p.planted - 0.5) <= 0.25 for p in good])
        figures["hand_bears"] = mean([p.held for p in good])
        figures["with_joint"] = mean([held(affordance, run) for run in others])
    return figures


def show(figures: dict[str, Any]) -> None:
    """Print one height."""
    line = (
        f"{figures['height']:6.2f} m  {figures['starts']:4d}  {100 * figures['held']:5.1f} %"
        f"  {100 * figures['clean']:5.1f} %  {figures['takeoff_error_rms']:.3f} m"
        f"  {figures['speed_error_mean']:+.2f} m/s  {figures['peak_median']:4.1f}"
    )
    if "middle" in figures:
        line += (
            f"  {100 * figures['middle']:5.1f} %  {figures['hand_bears']:.2f} s"
            f"  {100 * figures['with_joint']:5.1f} %"
        )
    print(f"{line}  {figures['ends']}", flush=True)


def main() -> None:
    """Try every start, print a table, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("affordance", choices=["jump", "vault", "drop"])
    parser.add_argument("--heights", type=float, nargs="+", help="[m]; default: lowest, middle and highest")
    parser.add_argument("--every", type=float, default=0.1, help="step of the distance [m]")
    parser.add_argument("--rehearsals", type=int, default=REHEARSALS, help="0: the bare skill")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    low, high = next(s.heights for s in Human().clearing if s.affordance == options.affordance)
    distances = np.arange(round((FARTHEST - NEAREST) / options.every) + 1) * options.every + NEAREST
    more = "  middle  hand bears  with joint" if options.affordance == "vault" else ""
    print(f"height  starts  held  clean  d error  v error  peak [body weights]{more}  ends")
    result = []
    for height in options.heights or (low, 0.5 * (low + high), high):
        result.append(summary(options.affordance, height, distances, options.rehearsals))
        show(result[-1])
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
