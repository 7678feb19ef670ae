"""Making the trials of a skill, here, in several processes or on a cluster."""

from collections.abc import Callable, Mapping
from functools import partial

from locomotion.skills.registry import skill_kinds
from runtime.evaluation import evaluation
from runtime.evaluation.braking import brake_residual_trials
from runtime.evaluation.evaluation import Attempt, Trial
from runtime.evaluation.landing import landing_residual_trials
from runtime.evaluation.policies import walk_policy_trials
from runtime.evaluation.slippery import slippery_roll_trials
from surefoot.progress import Progress
from surefoot.workers.pool import Place, worker_pool

__all__ = ["evaluate"]


def evaluate(
    skill: str, trials: int, seed: int, place: Place = 1, progress: Progress | None = None
) -> list[Attempt]:
    """Try ``skill``, a built-in one or the description of one of one's own (.yaml), in ``trials`` of each of
    its tests. The attempts are the same wherever they are made: at ``place``, see
    `surefoot.workers.pool.worker_pool`."""
    progress = progress or Progress(shown=False)
    drawn = _trials_of(skill, trials, seed)
    attempts: list[Attempt] = []
    with (
        progress.stage(f"evaluating: {skill}") as stage,
        worker_pool(place, _begin, (skill, trials, seed)) as workers,
    ):
        for attempt in workers.imap(_make, range(len(drawn))):
            attempts.append(attempt)
            held = sum(each.held for each in attempts)
            stage.update(len(attempts) / len(drawn), f"{held} of {len(attempts)} held")
    return attempts


def _trials_of(skill: str, trials: int, seed: int) -> list[Trial]:
    own: Mapping[str, Callable[[int, int], list[Trial]]] = {
        "run": evaluation.run_trials,
        "walk": evaluation.walk_trials,
        "speed-up": evaluation.speed_up_trials,
        "slow-down": evaluation.slow_down_trials,
        "brake": evaluation.brake_trials,
        "brake-residual": brake_residual_trials,
        "landing-residual": landing_residual_trials,
        "slippery-roll": slippery_roll_trials,
        "walk-policy": walk_policy_trials,
        **{kind.skill: partial(evaluation.clearing_trials, kind) for kind in skill_kinds()},
    }
    return own.get(skill, partial(evaluation.described_trials, skill))(trials, seed)


_drawn: list[Trial] = []  # of a worker process


def _begin(skill: str, trials: int, seed: int) -> None:
    global _drawn
    _drawn = _trials_of(skill, trials, seed)


def _make(number: int) -> Attempt:
    return _drawn[number]()
