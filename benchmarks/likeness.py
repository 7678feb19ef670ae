"""How human the gaits look.

    python -m benchmarks.likeness walk [--speeds 0.8 1.25 1.6 2] [--seconds 40] [--pushes 300]
    python -m benchmarks.likeness run [--speeds 2.5 3.5 5] [--seconds 40]

The learned walk and run beside the planned ones, on every physics step of the whole figure, from a stand; a
run once it has its speed. Their figures and curves of joints stand beside those of people:

- thigh, knee and ankle from a foot's strike on: beside the mean of a group of people; walks at all speeds
  beside one curve, taken at some 1.2 m/s (`benchmarks.human_walk`), runs beside 28 runners at 2.5, 3.5 and
  4.5 m/s, in between interpolated, and above that beside the last (`benchmarks.human_run`)
- the same, shoulder and elbow: beside each captured stride of one person that the shared data has, whatever
  its speed, the nearest one first (`benchmarks.captured`), shifted in time until thighs and knees fit best

Printed of each curve: root mean square difference and correlation. Walks are also pushed at the waist for
0.1 s from twelve directions, each at another moment of the cycle.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import human_run, human_walk
from benchmarks.captured import captured_strides
from benchmarks.gait_measures import SAMPLES, compare_curves, deepest_limb, figures
from benchmarks.gait_record import Record, learned_walk, planned_walk
from benchmarks.shared_data import why_absent
from locomotion.gaits.policy.skill import WALK_POLICY, PolicySkill, load_policy
from locomotion.training.policies.trial import PolicyTrial

_PLANNED = 15.0  # [s] at most of the planned walk, which repeats itself to the bit
_DIRECTIONS = 12
_SPEEDS = {"walk": (0.8, 1.25, 1.6, 2.0), "run": (2.5, 3.5, 5.0)}  # [m/s]
_WARM_UP = {"walk": 5.0, "run": 8.0}  # [s] in which it comes to its speed


def main() -> None:
    """Measure, print, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gait", choices=("walk", "run"))
    parser.add_argument("--speeds", type=float, nargs="+", help="[m/s]")
    parser.add_argument("--seconds", type=float, default=40.0, help="of each walk or run")
    parser.add_argument("--pushes", type=float, default=300.0, help="of a walk [N]; 0: none")
    parser.add_argument("--policy", type=Path, default=WALK_POLICY, help="the learned walk and run")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    skill, gait, result = load_policy(options.policy), options.gait, {}
    for speed in options.speeds or _SPEEDS[gait]:
        records = {
            "learned": learned_walk(skill, speed, options.seconds, _WARM_UP[gait]),
            "planned": planned_walk(speed, min(options.seconds, _PLANNED), _WARM_UP[gait]),
        }
        result[f"{speed:g}"] = found = measured(gait, speed, records)
        show(gait, speed, found)
        if gait == "walk" and options.pushes:
            found["pushed"] = pushes(skill, speed, options.pushes)
            print(f"pushed with {options.pushes:.0f} N from {_DIRECTIONS} directions: {found['pushed']} hold")
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


def measured(gait: str, speed: float, records: dict[str, Record]) -> dict[str, Any]:
    """Figures, curves and the limbs that were deepest in each other, of each that did not fall."""
    people = human_walk.human_curves(SAMPLES) if gait == "walk" else human_run.runners_curves(speed, SAMPLES)
    strides = sorted(captured_strides(gait), key=lambda each: abs(each.speed - speed))
    walks = {name: record for name, record in records.items() if not record.fell}
    curves = {name: {"people": compare_curves(record, people)} for name, record in walks.items()}
    for stride in strides:
        title = f"{stride.name}, {stride.speed:.1f} m/s, {stride.cadence:.2f} steps/s"
        for name, record in walks.items():
            curves[name][title] = compare_curves(record, stride.curves, shifted=True)
    return {
        "figures": {name: figures(record) for name, record in walks.items()}, "curves": curves,
        "deepest": {name: deepest_limb(record)[0] for name, record in walks.items()},
        "fell": [name for name, record in records.items() if record.fell],
    }  # fmt: skip


def show(gait: str, speed: float, found: dict[str, Any]) -> None:
    """Print what was `measured`."""
    module = human_walk if gait == "walk" else human_run
    cadence = human_walk.human_cadence if gait == "walk" else human_run.runners_cadence
    names = list(found["figures"])
    print(f"\n{gait} at {speed:g} m/s" + "".join(f"; the {name} one fell" for name in found["fell"]))
    print(f"| {'':24} |" + "".join(f" {name:>9} |" for name in names) + " people")
    print(f"| {'-' * 24} |" + " --------- |" * len(names) + " ---")
    for name, (unit, wanted) in module.TARGETS.items():
        row = "".join(f" {found['figures'][each][name]:9.2f} |" for each in names)
        people = f"{cadence(speed):.2f} +- 10 %" if name == "cadence" else wanted
        print(f"| {f'{name} [{unit}]':24} |{row} {people}")
    for each, deepest in found["deepest"].items():
        print(f"deepest of the {each} one: {deepest}")
    beside = list(found["curves"][names[0]]) if names else []
    for title in beside:
        print(f"beside {title}: RMS [deg] and correlation; asked are <= 12 and >= 0.85")
        for joint in found["curves"][names[0]][title]:
            rows = (found["curves"][each][title][joint] for each in names)
            print(f"| {joint:24} |" + "".join(f" {off:4.1f} {alike:4.2f} |" for off, alike in rows))
    if len(beside) == 1:
        print(f"no captured strides: {why_absent()}")


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


if __name__ == "__main__":
    main()
