"""How human the gaits look.

    python -m benchmarks.likeness walk [--seconds 40] [--pushes 300] [--json likeness.json]
    python -m benchmarks.likeness run [--speed 3.5] [--json likeness.json]

Walk: the learned walk beside the planned one at four speeds, on every physics step of the whole figure, from
a stand; against what people do (`benchmarks.human_walk`), and pushed at the waist for 0.1 s from twelve
directions, each at another moment of the cycle.

Run: ground reaction, step frequency, and joint angles against a captured run. The person runs 20 s on a
plane; the last 10 s count. Peak reaction: the greatest ground reaction of each step, read after every tick of
10 ms. Step frequency: against equation 8 of "Terrain Runner" with its own constants and with those of the
captured run. Joint angles: hip, knee and ankle in the sagittal plane over the mean cycle, against the
captured run of the shared data (one stride), after the time shift that aligns them best.
"""

import argparse
import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.gait_measures import compare_curves, figures
from benchmarks.gait_record import learned_walk, planned_walk
from benchmarks.human_walk import CURVES, TARGETS, human_cadence
from benchmarks.shared_data import shared_folder, why_absent
from locomotion.body.person import CONTROL_DT, JOINT_NAMES, MASS
from locomotion.clips.bvh import read_bvh
from locomotion.clips.retargeting import load_mapping, retarget
from locomotion.gaits.policy.skill import WALK_POLICY, PolicySkill, load_policy
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import load_run_skill
from locomotion.training.gaits.rollout import Scenario, Simulator
from locomotion.training.policies.trial import PolicyTrial

JOINTS = ("hip_flexion", "knee_flexion", "ankle_flexion")
MAPPING = Path(__file__).resolve().parents[1] / "examples" / "clips" / "mixamo.yaml"
PREFIX = "Character1_"
WALKS = (0.8, 1.25, 1.6, 2.0)
"""[m/s]"""
_SAMPLES = 100
_PLANNED = 15.0  # [s] at most of the planned walk, which repeats itself to the bit
_DIRECTIONS = 12


def our_run(speed: float) -> dict[str, np.ndarray]:
    """Ticks of the last 10 s: angles (n, joints) [rad], forces (n,) [body weights] and switches of the stance
    to the right foot (n,)."""
    angles, forces, switches, feet = [], [], [], []

    def note(simulator: Simulator) -> None:
        state = simulator.state
        if state[c.TICKS] > 1000:
            angles.append(simulator.data.qpos[7:].copy())
            forces.append(float(state[c.CONTACT].sum()) / (MASS * 9.81))
            switches.append(state[c.STEP_TIME] == 0.0)
            feet.append(state[c.STANCE])

    trial = Simulator().run(load_run_skill(), Scenario(20.0, np.array([[0.0, speed]])), note)
    if trial.figures["time"] < 19.9:
        raise SystemExit(f"the person fell after {trial.figures['time']:.1f} s at {speed} m/s")
    return {
        "angles": np.array(angles), "forces": np.array(forces), "switches": np.array(switches),
        "feet": np.array(feet),
    }  # fmt: skip


def mean_cycle(angles: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(samples, joints) over the cycles between ``starts``."""
    shares = np.linspace(0.0, 1.0, _SAMPLES, endpoint=False)
    cycles = []
    for a, b in pairwise(starts):
        at = a + shares * (b - a)
        cycles.append(np.stack([np.interp(at, np.arange(len(angles)), column) for column in angles.T], 1))
    return np.mean(cycles, axis=0)


def captured_run() -> tuple[np.ndarray, float, float]:
    """Mean of one stride of the captured run (samples, joints) [rad], its speed [m/s] and steps per s."""
    folder = shared_folder()
    if folder is None:
        raise SystemExit(why_absent())
    mapping = {part: PREFIX + joint for part, joint in load_mapping(MAPPING).items()}
    motion = retarget(read_bvh(folder / "mocap" / "mass" / "run.bvh", "cm", "y"), mapping)
    way = float(np.linalg.norm(motion.qpos[-1, :2] - motion.qpos[0, :2]))
    starts = np.array([0, len(motion.qpos) - 1])
    return mean_cycle(motion.qpos[:, 7:], starts), way / motion.duration, 2.0 / motion.duration


def main() -> None:
    """Measure, print, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gait", choices=("walk", "run"))
    parser.add_argument("--speed", type=float, default=3.5, help="of the run [m/s]")
    parser.add_argument("--seconds", type=float, default=40.0, help="of each walk")
    parser.add_argument("--pushes", type=float, default=300.0, help="of the walk [N]; 0: none")
    parser.add_argument("--policy", type=Path, default=WALK_POLICY, help="the learned walk")
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
    """Measure and print the run."""
    run = our_run(options.speed)
    seconds = len(run["forces"]) * CONTROL_DT
    frequency = run["switches"].sum() / seconds
    starts = np.flatnonzero(run["switches"])
    peaks = [run["forces"][a:b].max() for a, b in pairwise(starts)]
    captured, pace, captured_frequency = captured_run()
    paper = 4.2 * (0.2 * options.speed / 4.4 + 0.8)
    as_captured = captured_frequency * (0.2 * options.speed / pace + 0.8)
    ours = mean_cycle(run["angles"], starts[run["feet"][starts] < 0])
    columns = {
        joint: [JOINT_NAMES.index(f"{side}_{joint}") for side in ("right", "left")] for joint in JOINTS
    }
    both = [k for pair in columns.values() for k in pair]
    errors = [np.sqrt(np.mean((np.roll(ours, s, axis=0) - captured)[:, both] ** 2)) for s in range(_SAMPLES)]
    moved = np.roll(ours, int(np.argmin(errors)), axis=0) - captured
    result = {
        "speed": options.speed,
        "peak_median": float(np.median(peaks)),
        "peak_highest": float(max(peaks)),
        "steps_per_s": float(frequency),
        "equation_8": float(paper),
        "equation_8_of_the_captured_run": float(as_captured),
        "captured": {"speed": pace, "steps_per_s": captured_frequency},
        "rms_degrees": {
            joint: float(np.degrees(np.sqrt(np.mean(moved[:, pair] ** 2)))) for joint, pair in columns.items()
        },
    }
    print(f"running at {options.speed} m/s")
    print(
        f"peak reaction: {np.median(peaks):.2f} (median step), {max(peaks):.2f} (highest) body weights"
        " (<= 3.5)"
    )
    print(
        f"step frequency {frequency:.2f} /s; equation 8: {paper:.2f} /s ({frequency / paper - 1:+.0%}); with"
        f" the captured run's constants ({pace:.2f} m/s, {captured_frequency:.2f} /s): {as_captured:.2f} /s"
        f" ({frequency / as_captured - 1:+.0%})"
    )
    for joint, error in result["rms_degrees"].items():
        print(f"{joint}: {error:.1f} degrees RMS from the captured run (<= 20)")
    return result


if __name__ == "__main__":
    main()
