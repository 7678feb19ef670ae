"""How often take-offs hold without rehearsals, with and without odds, and who turns away.

    python -m benchmarks.taking_off [--skills jump vault] [--starts 40] [--bravery 0.4] [--beyond]

Everybody stands 9 to 16 m before an obstacle, with the usual noise of 0.02 m/s and rad/s, and is told to go
over it at 3.5 m/s. Sizes are drawn from what people are to clear; with --beyond from what is greater, by up
to the same span: walls of 1 to 1.4 m, drops of 2 to 3.1 m. It holds if a person that took off clears the
obstacle and is still up 2.2 s later (4 s where it walks). For each skill the starts are run by people who
take what comes, and by the same with a bravery. Turned: those that turned away at least once, whatever came
of it.
"""

import argparse
from dataclasses import dataclass

import numpy as np

from locomotion import MOVING, Ground, Human
from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Cleared, TookOff, TurnedAway
from locomotion.preconditions.precondition import load_preconditions
from locomotion.skills.course import make_course
from locomotion.skills.kind import SkillKind
from locomotion.skills.registry import skill_called, skill_words
from locomotion.training.preconditions.sampling import WiderSkill
from locomotion.training.skills.vault import DEPTHS
from runtime.evaluation.courses import SPEED
from runtime.evaluation.evaluation import NOISE

FROM = (9.0, 16.0)
_LONGEST, _RUNS, _WALKS = 60.0, 2.2, 4.0  # [s]


@dataclass
class Try:
    """What came of a start: whether it took off, held, turned away, and fell."""

    off: bool = False
    held: bool = False
    turned: bool = False
    fell: bool = False


def try_once(kind: SkillKind, sizes: tuple[float, float], bravery: float | None, seed: list[int]) -> Try:
    """Run one start."""
    rng = np.random.default_rng(seed)
    size, depth = round(float(rng.uniform(*sizes)), 3), float(rng.uniform(*DEPTHS))
    course = make_course([(kind.affordance, size, depth)], [float(rng.uniform(*FROM))])
    ground = Ground.from_arrays(course.vertices, course.faces)
    wider = [WiderSkill(each) for each in Human(ground, rehearsals=0).clearing]
    human = Human(ground, clearing=wider, rehearsals=0)
    human.composition.preconditions = load_preconditions()
    human.bravery = bravery
    human.reset(course.path[0], 0.0)
    human.data.qvel[:] += NOISE * rng.normal(size=human.model.nv)
    human.follow(course.path, SPEED, course.obstacles)
    seen, result, cleared = 0, Try(), None
    while human.status in MOVING and human.time < _LONGEST and not result.held:
        human.tick()
        for event in human.events[seen:]:
            result.off |= isinstance(event, TookOff)
            result.turned |= isinstance(event, TurnedAway)
            if isinstance(event, Cleared):
                cleared = human.ticks
        seen = len(human.events)
        stays = _WALKS if human.gait_now == "walk" else _RUNS
        result.held = cleared is not None and (human.ticks - cleared) * CONTROL_DT > stays
    result.fell = human.status == "fallen"
    return result


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--skills", nargs="+", choices=skill_words(), default=list(skill_words()))
    parser.add_argument("--starts", type=int, default=40)
    parser.add_argument("--bravery", type=float, nargs="+", default=[0.4])
    parser.add_argument("--beyond", action="store_true", help="sizes above those that people are to clear")
    parser.add_argument("--seed", type=int, default=777)
    options = parser.parse_args()
    print("| skill | bravery | take-offs that hold | turned away | fall in all |")
    print("| --- | --- | --- | --- | --- |")
    for skill in options.skills:
        kind = skill_called(skill)
        low, high = kind.sizes
        sizes = (high, 2.0 * high - low) if options.beyond else (low, high)
        for bravery in (None, *options.bravery):
            tries = [try_once(kind, sizes, bravery, [options.seed, k]) for k in range(options.starts)]
            off, held = sum(each.off for each in tries), sum(each.held for each in tries)
            turned, fell = sum(each.turned for each in tries), sum(each.fell for each in tries)
            share = f"{100.0 * held / off:.0f} % of {off}" if off else "none took off"
            print(f"| {skill} | {bravery} | {share} | {turned} of {len(tries)} | {fell} |", flush=True)


if __name__ == "__main__":
    main()
