"""How human the gaits look.

    python -m benchmarks.likeness walk [--seconds 40] [--pushes 300] [--json likeness.json]
    python -m benchmarks.likeness run [--speed 3.5] [--seconds 40] [--json likeness.json]

Walk: the learned walk beside the planned one at four speeds, on every physics step of the whole figure, from
a stand; against what people do (`benchmarks.human_walk`), and pushed at the waist for 0.1 s from twelve
directions, each at another moment of the cycle.

Run: the learned run beside the planned one, measured in the same way once it has its speed. Joint angles:
hip, knee and ankle in the sagittal plane over the mean cycle, against the captured run of the shared data
(one stride), after the time shift that aligns them best.
"""

import argparse
import json
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.gait_measures import compare_curves, figures, strikes
from benchmarks.gait_record import Record, learned_walk, planned_walk
from benchmarks.human_walk import CURVES, RUN_TARGETS, TARGETS, human_cadence
from benchmarks.shared_data import shared_folder, why_absent
from locomotion.body.person import JOINT_NAMES, MASS
from locomotion.clips.bvh import read_bvh
from locomotion.clips.retargeting import load_mapping, retarget
from locomotion.gaits.policy.skill import WALK_POLICY, PolicySkill, load_policy
from locomotion.training.policies.trial import PolicyTrial

JOINTS = ("hip_flexion", "knee_flexion", "ankle_flexion")
MAPPING = Path(__file__).resolve().parents[1] / "examples" / "clips" / "mixamo.yaml"
PREFIX = "Character1_"
WALKS = (0.8, 1.25, 1.6, 2.0)
"""[m/s]"""
_SAMPLES = 100
_PLANNED = 15.0  # [s] at most of the planned walk, which repeats itself to the bit
_DIRECTIONS = 12
_TO_SPEED = 8.0  # [s] in which a run comes to its speed


def mean_cycle(angles: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(samples, joints) over the cycles between ``starts``."""
    shares = np.linspace(0.0, 1.0, _SAMPLES, endpoint=False)
    cycles = []
    for a, b in pairwise(starts):
        at = a + shares * (b - a)
        cycles.append(np.stack([np.interp(at, np.arange(len(angles)), column) for column in angles.T], 1))
    return np.mean(cycles, axis=0)


@dataclass(frozen=True)
class Captured:
    """The mean cycle of a captured run (samples, joints) [rad], its speed [m/s] and steps per s."""

    cycle: np.ndarray
    speed: float
    steps_per_s: float


def captured_run() -> Captured:
    """One stride of the shared data."""
    folder = shared_folder()
    if folder is None:
        raise SystemExit(why_absent())
    mapping = {part: PREFIX + joint for part, joint in load_mapping(MAPPING).items()}
    motion = retarget(read_bvh(folder / "mocap" / "mass" / "run.bvh", "cm", "y"), mapping)
    way = float(np.linalg.norm(motion.qpos[-1, :2] - motion.qpos[0, :2]))
    starts = np.array([0, len(motion.qpos) - 1])
    return Captured(mean_cycle(motion.qpos[:, 7:], starts), way / motion.duration, 2.0 / motion.duration)


def main() -> None:
    """Measure, print, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gait", choices=("walk", "run"))
    parser.add_argument("--speed", type=float, default=3.5, help="of the run [m/s]")
    parser.add_argument("--seconds", type=float, default=40.0, help="of each walk or run")
    parser.add_argument("--pushes", type=float, default=300.0, help="of the walk [N]; 0: none")
    parser.add_argument("--policy", type=Path, default=WALK_POLICY, help="the learned walk and run")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    if options.gait == "walk":
        result = walks(load_policy(options.policy), options.seconds, options.pushes)
    else:
        result = run(options)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


def walks(skill: PolicySkill, seconds: float, force: float) -> dict[str, Any]:
    """Measure and print both walks, and pushes of the learned one."""
    result: dict[str, Any] = {}
    for speed in WALKS:
        rows = {
            "learned": learned_walk(skill, speed, seconds),
            "planned": planned_walk(speed, min(seconds, _PLANNED)),
        }
        fell = [name for name, record in rows.items() if record.fell]
        measured = {name: figures(record) for name, record in rows.items() if name not in fell}
        curves = {name: compare_curves(rows[name]) for name in measured}
        pushed = pushes(skill, speed, force) if force else None
        result[f"{speed:g}"] = {"figures": measured, "curves": curves, "fell": fell, "pushed": pushed}
        print(f"\nwalking at {speed:g} m/s" + "".join(f"; the {name} walk fell" for name in fell))
        print(f"| {'':24} |" + "".join(f" {name:>9} |" for name in measured) + " people")
        print(f"| {'-' * 24} |" + " --------- |" * len(measured) + " ---")
        for name, (unit, wanted) in TARGETS.items():
            row = "".join(f" {each[name]:9.2f} |" for each in measured.values())
            people = f"{human_cadence(speed):.2f}" if name == "cadence" else wanted
            print(f"| {f'{name} [{unit}]':24} |{row} {people}")
        for name in CURVES:
            row = "".join(f" {off:4.1f} {alike:4.2f} |" for off, alike in (c[name] for c in curves.values()))
            print(f"| {f'{name}: RMS [deg], corr.':24} |{row} <= 12, >= 0.85")
        if pushed is not None:
            print(f"pushed with {force:.0f} N from {_DIRECTIONS} directions: {pushed} hold")
    return result


def pushes(skill: PolicySkill, speed: float, force: float) -> int:
    """How many of the pushes from all directions do not make it fall."""
    held = 0
    for k in range(_DIRECTIONS):
        trial = PolicyTrial(skill)
        trial.go(1.0)
        trial.asked[0] = speed
        trial.go(4.0 + 0.09 * k)
        trial.push(force, 2.0 * np.pi * k / _DIRECTIONS)
        held += trial.go(5.0)
    return held


def run(options: argparse.Namespace) -> dict[str, Any]:
    """Measure and print both runs."""
    speed, captured = options.speed, captured_run()
    records = {
        "learned": learned_walk(load_policy(options.policy), speed, options.seconds, _TO_SPEED),
        "planned": planned_walk(speed, min(options.seconds, _PLANNED), _TO_SPEED),
    }
    fell = [name for name, record in records.items() if record.fell]
    print(f"\nrunning at {speed:g} m/s" + "".join(f"; the {name} run fell" for name in fell))
    measured = {name: _run_figures(record, captured) for name, record in records.items() if not record.fell}
    as_captured = captured.steps_per_s * (0.2 * speed / captured.speed + 0.8)
    people = {**RUN_TARGETS, "cadence": ("steps/s", f"{as_captured:.2f} by equation 8 as captured")}
    print(f"| {'':24} |" + "".join(f" {name:>9} |" for name in measured) + " people")
    print(f"| {'-' * 24} |" + " --------- |" * len(measured) + " ---")
    for name, (unit, wanted) in people.items():
        row = "".join(f" {each[name]:9.2f} |" for each in measured.values())
        print(f"| {f'{name} [{unit}]':24} |{row} {wanted}")
    return {"speed": speed, "figures": measured, "fell": fell}


def _run_figures(record: Record, captured: Captured) -> dict[str, float]:
    """Those of `RUN_TARGETS`."""
    found, marks = figures(record), strikes(record, 0)
    events = np.sort(np.concatenate([marks, strikes(record, 1)]))
    reaction = record.forces.sum(axis=1) / (MASS * 9.81)
    ours = mean_cycle(record.angles, marks)
    columns = {j: [JOINT_NAMES.index(f"{side}_{j}") for side in ("right", "left")] for j in JOINTS}
    both = [k for pair in columns.values() for k in pair]
    off = [np.roll(ours, shift, axis=0) - captured.cycle for shift in range(_SAMPLES)]
    best = min(off, key=lambda each: float(np.mean(each[:, both] ** 2)))
    apart = {j: float(np.degrees(np.sqrt(np.mean(best[:, pair] ** 2)))) for j, pair in columns.items()}
    return {
        **found, **{f"{joint} off": value for joint, value in apart.items()},
        "flight": 100.0 * float((reaction < 0.05).mean()),
        "hardest step": float(max(reaction[a:b].max() for a, b in pairwise(events))),
    }  # fmt: skip


if __name__ == "__main__":
    main()
