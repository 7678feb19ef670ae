"""Trials of braking without rehearsals, with the network that corrects it and without."""

import math
from functools import partial

import numpy as np

from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import HumanState
from locomotion.training.gaits.brake import draw_starts
from runtime.evaluation.evaluation import Attempt, Trial

__all__ = ["brake_residual_trials"]

PUSH = 200.0
"""[N] at the waist for 0.1 s."""
_SPEEDS, _HARDER, _WHILE = (2.0, 3.7), 2.5, 40  # [m/s]; of the braking; ticks in which a push begins
_PUSHED, _LONGEST, _STAYS = 10, 600, 100  # ticks of a push; of a trial; at rest, without a fall


def brake_residual_trials(trials: int, seed: int) -> list[Trial]:
    """Four tests of ``trials`` each: people in steady runs of 2 to 3.7 m/s, a third of them in bends, brake
    once, without rehearsals: as planned, and corrected; both also pushed with `PUSH` from any side."""
    rng = np.random.default_rng([seed, 7])
    starts = draw_starts(rng, trials, _SPEEDS)
    pushes = [(int(rng.integers(0, _WHILE)), float(rng.uniform(0.0, 2.0 * math.pi))) for _ in starts]
    people = {
        "as planned": Human(clearing=(), rehearsals=0, between=BetweenGaits(residual=None)),
        "corrected": Human(clearing=(), rehearsals=0),
    }
    tried: list[Trial] = []
    for name, human in people.items():
        tried += [partial(_brake, human, name, start, None) for start in starts]
        pushed = f"{name}, pushed with {PUSH:.0f} N"
        tried += [partial(_brake, human, pushed, *each) for each in zip(starts, pushes, strict=True)]
    return tried


def _brake(human: Human, test: str, start: HumanState, push: tuple[int, float] | None) -> Attempt:
    human.restore_state(start)
    human.data.xfrc_applied[:] = 0.0
    begun, velocity, feet = human.com, human.velocity, human.on_feet
    speed, waist = float(np.linalg.norm(velocity)), human.model.body("waist").id
    human.stop()
    human.brake(_HARDER)
    way, rested = 0.0, 0
    for tick in range(_LONGEST):
        pushing = push is not None and 0 <= tick - push[0] < _PUSHED
        force = (PUSH * math.cos(push[1]), PUSH * math.sin(push[1])) if push and pushing else (0.0, 0.0)
        human.data.xfrc_applied[waist, :2] = force
        human.tick()
        way = max(way, float(velocity @ (human.com - begun)) / speed)
        if feet.at_rest(human.control):
            rested += 1
            feet.stir(human.control)  # simulated on, so that a fall would show
        human.ended_at = human.ticks
        if human.status == "fallen" or rested > _STAYS:
            break
    held = rested > 0 and human.status != "fallen"
    what, ends = f"{speed:.2f} m/s, {way:.2f} m", "stands" if held else "fallen"
    if not held and human.status != "fallen":
        ends = "does not come to rest"
    figures = {"way [m]": way} if held else {}
    return Attempt(test, what, ends, held, figures, compared=feet.residual.skill is None)
