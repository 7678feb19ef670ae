"""Training of the network that corrects braking."""

import hashlib
import os
from dataclasses import replace

import numpy as np

from locomotion.body.person import person_digest
from locomotion.gaits.brake import BrakeSkill, load_brake_skill
from locomotion.gaits.residual.skill import BRAKE_RESIDUAL, ResidualSkill, load_brake_residual
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import HumanState
from locomotion.skills.library import package_skill, skill_digest
from locomotion.training.gaits.brake import draw_starts
from locomotion.training.policies.learning import Learning, PolicyProgress
from locomotion.training.policies.walk import network_of
from locomotion.training.progress import Progress
from locomotion.training.residual.braking import BrakingPeople, BrakingStage
from locomotion.training.search.checkpoint import claim
from locomotion.training.training import NotLearnedError, Training
from surefoot.files.archive import check_target

__all__ = ["BRAKING_STAGES", "brake_residual_is_outdated", "train_brake_residual"]

BRAKING_STAGES = (
    BrakingStage("brake", 1_500_000, noise=(0.3, 0.2)),
    BrakingStage("pushed", 1_500_000, pushed=0.4, push=250.0, noise=(0.2, 0.1)),
    BrakingStage("short", 2_000_000, harder=(2.0, 2.8), pushed=0.4, push=250.0, noise=(0.15, 0.08)),
)
"""What is learned, in turn."""
_CORRECTS = ("walk", "run", "slow-down", "brake")
_PEOPLE = 64  # who learn at once
_STARTS, _SPEEDS = 1000, (2.0, 3.7)  # runs that they brake from; [m/s]
_TRIALS, _HARDER, _HOLD = 20, 2.5, 0.7  # tests of what was learned; share of them that has to hold


def train_brake_residual(training: Training, out: str | os.PathLike[str] = BRAKE_RESIDUAL) -> ResidualSkill:
    """Train what corrects the package's braking, and write it to ``out``."""
    stages = [
        replace(stage, samples=max(round(stage.samples * training.effort), 1)) for stage in BRAKING_STAGES
    ]
    check_target(out)
    if training.checkpoint is not None:
        asked = {"skill": "brake-residual", "seed": training.seed, "effort": training.effort}
        asked |= {f"{name} skill": digest for name, digest in _now().items()}
        digest = hashlib.sha256(repr(stages).encode()).hexdigest()[:16]
        claim(training.checkpoint, {**asked, "person": person_digest(), "stages": digest})
    brake, count = load_brake_skill(), max(round(_STARTS * min(training.effort, 1.0)), 2)
    starts = draw_starts(np.random.default_rng([training.seed, 1]), count, _SPEEDS)

    def tell(p: PolicyProgress) -> None:
        training.on_progress(
            Progress(p.stage, p.iteration, p.iterations, -p.reward, 1.0 - p.falls, p.elapsed, p.remaining)
        )

    def people(seed: int) -> BrakingPeople:
        return BrakingPeople(brake, starts, stages[0], _PEOPLE, seed)

    agent = Learning(people, stages, training.seed, training.file("brake"), tell).run()
    skill = ResidualSkill(network_of(agent), _now(), training.made_by("brake-residual"))
    _demand_success(skill, brake, training.seed)
    skill.save(out)
    return skill


def brake_residual_is_outdated() -> bool:
    """Whether the package's was learned on other skills than there are now."""
    return BRAKE_RESIDUAL.exists() and load_brake_residual().corrects != _now()


def _now() -> dict[str, str]:
    return {name: skill_digest(name) for name in _CORRECTS if package_skill(name).exists()}


def _demand_success(skill: ResidualSkill, brake: BrakeSkill, seed: int) -> None:
    """Raises `NotLearnedError` if too few of those who brake come to rest, from starts that were not learned
    from."""
    human = Human(None, clearing=(), rehearsals=0, between=BetweenGaits(brake=brake, residual=skill))
    starts = draw_starts(np.random.default_rng([seed, 2]), _TRIALS, _SPEEDS)
    held = sum(_comes_to_rest(human, start) for start in starts)
    if held < _HOLD * _TRIALS:
        raise NotLearnedError(
            f"brake-residual does not work: {held} of {_TRIALS} who brake come to rest; train with another "
            "--seed or more --effort"
        )


def _comes_to_rest(human: Human, start: HumanState) -> bool:
    human.restore_state(start)
    human.stop()
    human.brake(_HARDER)
    while not human.held:
        human.tick()
    return human.status != "fallen" and human.on_feet.at_rest(human.control)
