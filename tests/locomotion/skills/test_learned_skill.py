"""A skill learned over a range of sizes."""

import numpy as np
import pytest

from locomotion.clips.clip import load_clip
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import load_run_skill
from locomotion.saved_arrays import Slots
from locomotion.skills.jump.skill import JUMP_CLIP
from locomotion.skills.kernel import FIRST_STEP, SHARED_MEMORY
from locomotion.skills.learned_skill import LawTables, LearnedSkill, tables_over_run


class Family:
    range = (0.2, 0.6)
    stride = (0.2, 0.1, 0.3)


class Hop(LearnedSkill):
    slots = Slots("the hop", SHARED_MEMORY, [])


@pytest.fixture
def hop():
    made = []

    def law(size):
        made.append(size)
        return LawTables(np.full(2, size), 3.0 + size, 1.0 + size, ())

    return Hop(Family(), law), made


def test_laws_are_made_once_and_of_the_nearest_learned_size(hop):
    skill, made = hop
    assert skill.heights == (0.2, 0.6) and skill.stride == (0.2, 0.1, 0.3)
    assert skill.approach(0.4) == (3.4, 1.4)
    assert skill.tables(0.4) is skill.tables(np.float64(0.4))
    assert skill.approach(0.19) == skill.approach(0.2) and skill.approach(0.62) == (3.6, 1.6)
    assert made == [0.4, 0.2, 0.6]


def test_a_memory_is_checked_against_the_run_that_it_began_on(hop):
    skill, _ = hop
    memory = np.zeros(SHARED_MEMORY)
    memory[FIRST_STEP] = 7.0
    skill.check(memory, 7.0)
    with pytest.raises(LocomotionError, match="with a step that is still to come"):
        skill.check(memory, 6.0)
    with pytest.raises(LocomotionError, match="the hop"):
        skill.check(memory[:-1], 7.0)
    skill.over_run = False
    skill.check(memory, 6.0)  # it has steps of its own


def test_the_arguments_of_a_law_over_the_run():
    run, clip = load_run_skill(), load_clip(JUMP_CLIP)
    parameters = np.array([3.3, 1.9, 0.5])
    tables = tables_over_run(
        parameters, {"entry": slice(0, 1), "marks": slice(1, 3)}, np.zeros((3, 5, 15)), clip, run
    )
    assert (tables.entry, tables.mark) == (3.3, 1.9) and tables.parameters is parameters
    knots, timing, pose, rates, *_ = tables.rest
    assert np.array_equal(knots, run.knots) and (timing > 0.2).all() and (timing < 0.5).all()
    shares = np.linspace(0.0, 1.0, len(pose))
    assert pose == pytest.approx(clip.sample(shares) - run.clip.sample(shares))
    slope = np.gradient(pose, shares, axis=0)[8:-8]  # per cycle
    assert np.median(np.abs(rates[8:-8] - slope)) < 0.1
    again = tables_over_run(parameters, {"entry": slice(0, 1), "marks": slice(1, 2)}, np.zeros(0), clip, run)
    assert again.rest[2] is pose  # made once
