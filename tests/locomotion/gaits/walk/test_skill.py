"""What a person has learned of walking, and how it begins."""

import math

import numpy as np
import pytest

from locomotion import Human, LocomotionError
from locomotion.gaits.run.controller import COM, COM_VELOCITY, FEET, OBSERVED, new_state
from locomotion.gaits.walk.layout import WALK_STANCE, first_gains, new_walk
from locomotion.gaits.walk.skill import TABLES, WALK_SKILL, WalkSkill, load_walk_skill, rise_walking
from locomotion.training.gaits.grounds import ground_height, training_ground


@pytest.mark.parametrize("kind", ["level", "rolling", "ramps", "moguls"])
def test_stand_is_on_the_ground_with_both_feet(kind):
    human = Human(training_ground(kind), clearing=())
    rng = np.random.default_rng(3)
    for _ in range(10):
        x, y = rng.uniform(-30, 30, 2)
        human.reset((x, y, ground_height(kind, np.array([x]), np.array([y]))[0]), rng.uniform(-3, 3))
        deepest = human.data.contact.dist.min() if human.data.ncon else 0.0
        assert deepest > -0.02
        assert np.linalg.norm(human.control[COM][:2] - [x, y]) < 0.08
        assert not human.control[COM_VELOCITY].any()


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_crouching_body_rises_on_the_foot_that_it_passes_nearest_to(side):
    state, walk = new_state(), new_walk()
    state[COM], state[COM_VELOCITY] = (0.0, 0.0, 0.4), (2.4, 0.0, 0.5)
    state[FEET] = 0.3, -0.09 + 0.06 * side, 0.06, 0.3, 0.09 + 0.06 * side, 0.06
    rise_walking(walk, state[OBSERVED], 0.0)
    assert walk[WALK_STANCE] == -side
    turned = 0.5 * math.pi
    for vector in (state[COM], state[COM_VELOCITY], *state[FEET].reshape(2, 3)):
        vector[:2] = -vector[1], vector[0]
    rise_walking(walk, state[OBSERVED], turned)
    assert walk[WALK_STANCE] == -side


def test_walk_file_that_is_cut_off_or_of_something_else_is_refused(tmp_path):
    whole = WALK_SKILL.read_bytes()
    file = tmp_path / "walk.npz"
    for content in (whole[: len(whole) // 2], b"nothing"):
        file.write_bytes(content)
        with pytest.raises(LocomotionError, match=r"walk\.npz"):
            load_walk_skill(file)
    wrong = np.stack([first_gains()] * TABLES)
    wrong[1, 0] = 3.0
    WalkSkill(wrong).save(tmp_path / "wrong.npz")
    with pytest.raises(LocomotionError, match=r"swing_time is outside 0\.26 to 0\.6"):
        load_walk_skill(tmp_path / "wrong.npz")
