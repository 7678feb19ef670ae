"""What people who learn to be corrected have in common."""

import numpy as np
import pytest

from locomotion import Human
from locomotion.gaits.policy.layout import MIRROR_JOINT, SIGN_JOINT
from locomotion.gaits.residual.layout import ACTIONS, DECIDED
from locomotion.training.residual.people import CorrectedPeople, outcome


class Runners(CorrectedPeople):
    """Two people who run, and forget what was decided."""

    def __init__(self):
        people = [Human(None, clearing=(), rehearsals=0) for _ in range(2)]
        super().__init__(people, [human.on_feet.residual for human in people])

    def _begin_anew(self, i, human):
        human.reset((0.0, 0.0, 0.0), 0.0, 3.0)
        self.age[i] = self.before[i] = 0


@pytest.fixture
def runners():
    made = Runners()
    made.begin(None, 1)
    return made


def test_decisions_of_the_mirror_image_are_mirrored_back(runners):
    decided = np.random.default_rng(0).normal(size=(2, ACTIONS)).astype(np.float32)
    runners.left[:] = False, True
    action = runners._in_own_sides(decided)
    assert np.array_equal(action[0], decided[0])
    assert np.array_equal(action[1], (decided[1] * SIGN_JOINT)[np.argsort(MIRROR_JOINT)])
    runners._move(1, action[1])
    assert np.array_equal(runners.corrections[1].memory[DECIDED], action[1])


def test_who_falls_pays_for_it(runners):
    runners.people[0].data.qpos[3:7] = 0.0, 1.0, 0.0, 0.0  # head down
    action = np.full((2, ACTIONS), 0.5)
    moved = [runners._move(i, action[i]) for i in range(2)]
    terms = runners._usual_terms(action, moved)
    assert [each.fell for each in moved] == [True, False] and moved[0].tilt > moved[1].tilt
    assert terms["fall"][0] < -1.0 and terms["fall"][1] == 0.0
    assert terms["effort"] == pytest.approx([-0.001, -0.001]) and np.array_equal(runners.age, [1, 1])
    assert runners._usual_terms(action, moved)["change"] == pytest.approx([0.0, 0.0])
    fell = np.array([True, False])
    ended = outcome(terms, fell, ~fell)
    assert ended.reward == pytest.approx(np.sum(list(terms.values()), axis=0))
    assert ended.terms["falls of ends"] == 0.5 and ended.fell.tolist() == [True, False]
