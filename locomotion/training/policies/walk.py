"""Training of the walk that a network controls."""

import hashlib
import os
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from locomotion.body.person import person_digest
from locomotion.gaits.policy.skill import WALK_POLICY, PolicySkill
from locomotion.training.policies.agent import Agent
from locomotion.training.policies.curriculum import CATCHING, RUNNING, STANDING, WALKING, Stage
from locomotion.training.policies.endings import where_it_ended
from locomotion.training.policies.environment import Environment, motion_of
from locomotion.training.policies.learning import Learning, tells
from locomotion.training.policies.reference import make_reference
from locomotion.training.policies.running_reference import with_run
from locomotion.training.policies.starts import Starts, together
from locomotion.training.policies.takeovers import out_of_runs, takeovers
from locomotion.training.policies.trial import PolicyTrial
from locomotion.training.search.checkpoint import claim
from locomotion.training.training import NotLearnedError, Training
from surefoot.files.archive import check_target

__all__ = ["train_walk_policy"]

_TESTED = (0.8, 1.25, 1.8, 3.5)
"""Speeds [m/s] that a policy must walk at to be of use."""
_STANDS, _WALKS = 6.0, 12.0  # [s]
_PEOPLE = 256  # who learn at once
_JUDGES, _FAR_SIGHTED = 40, 0.985  # of the run: `Learning.judges`, and its discount
_TAKEOVERS, _OUT_OF_RUNS = 6000, 3000  # states of planned walks, and runs, from which some begin
_STANDERS, _PUSHED_FOR = 512, 1500  # people who are pushed off their stand, and decisions for which they are


def train_walk_policy(training: Training, out: str | os.PathLike[str] = WALK_POLICY) -> PolicySkill:
    """Train the walk, then the run from there, the stand from how walks end, and the walk once more from how
    stands end; write all to ``out``."""
    walking, running, standing, catching = (
        _scaled(stages, training.effort) for stages in (WALKING, RUNNING, STANDING, CATCHING)
    )
    check_target(out)
    if training.checkpoint is not None:
        asked = {"skill": "walk-policy", "seed": training.seed, "effort": training.effort}
        stages = hashlib.sha256(repr((walking, running, standing, catching)).encode()).hexdigest()[:16]
        claim(training.checkpoint, {**asked, "person": person_digest(), "stages": stages})
    reference = with_run(make_reference())

    def learn(
        name: str,
        stages: Sequence[Stage],
        seed: int,
        starts: Starts | None = None,
        first: Agent | None = None,
    ) -> Agent:
        checkpoint = training.file(name)
        people = partial(Environment, reference, stages[0], _PEOPLE, starts=starts)
        learning = Learning(people, stages, seed, checkpoint, tells(training.on_progress))
        if first is not None:
            learning.judges, learning.discount = _JUDGES, _FAR_SIGHTED
            learning.agent.begin_as(first.network)
        return learning.run()

    seed = training.seed
    walker = learn("walk", walking, 2 * seed, takeovers(_TAKEOVERS, seed))
    runner = learn("run", running, seed, out_of_runs(_OUT_OF_RUNS, seed), walker)
    stops = replace(walking[-1], stand=0.8, push=100.0, steadies=True)
    environment = Environment(reference, stops, _PEOPLE, seed)
    ends = where_it_ended(environment, lambda seen: walker.decide(walker.scaled(seen)))
    stander = learn("stand", standing, 2 * seed + 1, ends)
    pushes = replace(standing[-1], push=300.0, from_starts=0.0)
    stands = Environment(reference, pushes, _STANDERS, seed)
    thrown = where_it_ended(stands, lambda seen: stander.decide(stander.scaled(seen)), _PUSHED_FOR)
    walker = learn("catch", catching, 2 * seed, together(takeovers(_TAKEOVERS, seed), thrown), walker)
    motion, meta = motion_of(reference), training.made_by("walk-policy")
    skill = PolicySkill(motion, walker.network, stander.network, runner.network, meta)
    _demand_success(skill)
    skill.save(out)
    return skill


def _scaled(stages: Sequence[Stage], effort: float) -> list[Stage]:
    return [replace(stage, samples=max(round(stage.samples * effort), 1)) for stage in stages]


def _demand_success(skill: PolicySkill) -> None:
    """Raises `NotLearnedError` if it falls where it stands, or walks straight on."""
    for speed in _TESTED:
        trial = PolicyTrial(skill)
        held = trial.go(_STANDS)
        trial.asked[0] = speed
        if not (held and trial.go(_WALKS)):
            raise NotLearnedError(
                f"walk-policy does not work: at {speed} m/s it falls within {_STANDS + _WALKS:.0f} s; "
                "train with another --seed or more --effort"
            )
