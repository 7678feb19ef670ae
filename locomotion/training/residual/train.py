"""Training of the networks that correct braking, and landings behind obstacles."""

import hashlib
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from locomotion.body.person import person_digest
from locomotion.gaits.residual.skill import (
    BRAKE_RESIDUAL,
    LANDING_RESIDUAL,
    ResidualSkill,
    load_brake_residual,
    load_landing_residual,
)
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import MOVING, HumanState
from locomotion.skills.library import package_skill, skill_digest
from locomotion.skills.registry import skill_kinds
from locomotion.training.gaits.brake import draw_starts
from locomotion.training.policies.groups import Group, Groups
from locomotion.training.policies.learning import Learning, tells
from locomotion.training.residual.braking import SPEEDS, BrakingStage, braking_group
from locomotion.training.residual.landing import LandingStage, landing_group, on_course
from locomotion.training.search.checkpoint import claim
from locomotion.training.training import NotLearnedError, Training
from surefoot.files.archive import check_target

__all__ = [
    "BRAKING_STAGES", "LANDING_STAGES", "outdated_residuals", "train_brake_residual",
    "train_landing_residual",
]  # fmt: skip

BRAKING_STAGES = (
    BrakingStage("brake", 1_500_000, noise=(0.3, 0.2)),
    BrakingStage("pushed", 1_500_000, pushed=0.4, push=250.0, noise=(0.2, 0.1)),
    BrakingStage("short", 2_000_000, harder=(1.2, 2.8), pushed=0.4, push=250.0, noise=(0.15, 0.08)),
)
LANDING_STAGES = (
    LandingStage("land", 4_000_000, noise=(0.2, 0.12)),
    LandingStage("pushed", 2_500_000, noise=(0.12, 0.08), pushed=0.35, push=220.0, shaken=0.1),
    LandingStage("fine", 1_500_000, noise=(0.08, 0.05), pushed=0.25, push=220.0),
)
"""What is learned, in turn."""
_GROUPS = {"brake-residual": 3, "landing-residual": 15}
_PEOPLE = 32  # of each group
_STARTS = 300  # runs that each group brakes from
_GAITS = ("walk", "run", "slow-down")
_TRIALS, _HARDER, _HOLD = 20, 2.5, 0.7  # tests of what was learned; share of them that has to hold


def train_brake_residual(training: Training, out: str | os.PathLike[str] = BRAKE_RESIDUAL) -> ResidualSkill:
    """Train what corrects the package's braking, and write it to ``out``."""
    starts = max(round(_STARTS * min(training.effort, 1.0)), 2)
    make = partial(braking_group, _people(training), starts, training.seed)
    return _train(training, out, "brake-residual", BRAKING_STAGES, make, _stand)


def train_landing_residual(
    training: Training, out: str | os.PathLike[str] = LANDING_RESIDUAL
) -> ResidualSkill:
    """Train what corrects the landings of the package's skills, and write it to ``out``."""
    make = partial(landing_group, _people(training), training.seed)
    return _train(training, out, "landing-residual", LANDING_STAGES, make, _land)


def outdated_residuals() -> list[str]:
    """Those of the package's that were learned on other skills than there are now."""
    files = {
        "brake-residual": (BRAKE_RESIDUAL, load_brake_residual),
        "landing-residual": (LANDING_RESIDUAL, load_landing_residual),
    }
    return [
        name for name, (file, load) in files.items() if file.exists() and load().corrects != corrected(name)
    ]


def corrected(name: str) -> dict[str, str]:
    """Digests of the package's skills that a residual is learned on, as they are now."""
    skills = ("brake",) if name == "brake-residual" else [kind.skill for kind in skill_kinds()]
    return {each: skill_digest(each) for each in (*_GAITS, *skills) if package_skill(each).exists()}


def _people(training: Training) -> int:
    return max(round(_PEOPLE * min(training.effort, 1.0)), 2)


def _train(
    training: Training,
    out: str | os.PathLike[str],
    name: str,
    stages: Sequence[BrakingStage] | Sequence[LandingStage],
    make: Callable[[int], Group],
    holds: Callable[[ResidualSkill, int], int],
) -> ResidualSkill:
    """``make``: makes a group of people who learn. ``holds``: in how many of `_TRIALS`, drawn from a seed, a
    skill works."""
    asked = [replace(stage, samples=max(round(stage.samples * training.effort), 1)) for stage in stages]
    check_target(out)
    if training.checkpoint is not None:
        conditions = {"skill": name, "seed": training.seed, "effort": training.effort}
        conditions |= {f"{each} skill": digest for each, digest in corrected(name).items()}
        digest = hashlib.sha256(repr(asked).encode()).hexdigest()[:16]
        claim(training.checkpoint, {**conditions, "person": person_digest(), "stages": digest})
    groups = max(round(_GROUPS[name] * min(training.effort, 1.0)), 1)
    processes = training.workers if isinstance(training.workers, int) else 1
    learning = Learning(
        lambda seed: Groups(make, groups, processes, asked[0], seed), asked, training.seed,
        training.file(name), tells(training.on_progress),
    )  # fmt: skip
    people = learning.environment
    assert isinstance(people, Groups)
    try:
        agent = learning.run()
    finally:
        people.end()
    skill = ResidualSkill(agent.network, corrected(name), training.made_by(name))
    held = holds(skill, training.seed)
    if held < _HOLD * _TRIALS:
        raise NotLearnedError(
            f"{name} does not work: {held} of {_TRIALS} hold; train with another --seed or more --effort"
        )
    skill.save(out)
    return skill


def _stand(skill: ResidualSkill, seed: int) -> int:
    """How many of `_TRIALS` who brake come to rest, from starts that were not learned from."""
    human = Human(None, clearing=(), rehearsals=0, between=BetweenGaits(residual=skill))
    starts = draw_starts(np.random.default_rng([seed, 2]), _TRIALS, SPEEDS)
    return sum(_comes_to_rest(human, start) for start in starts)


def _comes_to_rest(human: Human, start: HumanState) -> bool:
    human.restore_state(start)
    human.stop()
    human.brake(_HARDER)
    while not human.held:
        human.tick()
    return human.status != "fallen" and human.on_feet.at_rest(human.control)


def _land(skill: ResidualSkill, seed: int) -> int:
    """After how many of `_TRIALS` landings people stay up, on courses that were not learned from."""
    rng, held, tried = np.random.default_rng([seed, 2]), 0, 0
    while tried < _TRIALS:
        human, starts = on_course(rng, skill)
        for start in starts[: _TRIALS - tried]:
            human.restore_state(start)
            while human.on_feet.landing.decides and human.status in MOVING:
                human.tick()
            held, tried = held + (human.status != "fallen"), tried + 1
    return held
