"""What a residual policy observes and decides is mirrored with the body."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.gaits.policy.layout import MIRROR_JOINT, SIGN_JOINT
from locomotion.gaits.residual import layout as at
from locomotion.gaits.residual.kernel import add_to, decide
from locomotion.gaits.residual.skill import ResidualSkill, load_brake_residual
from locomotion.training.policies.network import forward
from surefoot.files.archive import ArchiveError
from tests.locomotion.gaits.runners import running


def braking():
    human = running(310, rehearsals=0)
    human.stop()
    human.brake(2.5)
    for _ in range(4):
        human.tick()
    return human


def test_it_decides_as_the_plain_network_and_its_mirror_image():
    skill, human = load_brake_residual(), braking()
    residual = human.on_feet.residual
    left = residual.observe(human.control, human.on_feet.walk, human.data)
    mean, deviation, *layers = skill.network
    x = np.clip((residual.observed - mean) / deviation, -8.0, 8.0).astype(np.float32)
    plain = forward(layers, x[None])[-1][0]
    for mirrored in (False, True):
        memory = np.zeros(at.MEMORY_SIZE)
        decide(skill.network, residual.observed, mirrored, memory)
        expected = plain[MIRROR_JOINT] * SIGN_JOINT if mirrored else plain
        assert memory[at.DECIDED] == pytest.approx(expected, abs=1e-5)
    assert isinstance(left, bool)


def test_mirroring_twice_changes_nothing():
    seen = np.random.default_rng(0).standard_normal(at.INPUTS)
    once = seen[at.MIRROR_OBSERVED] * at.SIGN_OBSERVED
    assert np.array_equal(once[at.MIRROR_OBSERVED] * at.SIGN_OBSERVED, seen) and not np.array_equal(
        once, seen
    )


def test_it_moves_only_its_joints():
    memory, ctrl = np.zeros(at.MEMORY_SIZE), np.zeros(39)
    add_to(memory, ctrl)
    assert not ctrl.any()
    memory[at.DECIDED] = 1.0
    add_to(memory, ctrl)
    assert np.count_nonzero(ctrl) == at.ACTIONS and ctrl.max() == at.SCALE


def test_a_file_says_what_it_holds(tmp_path):
    skill = load_brake_residual()
    skill.save(tmp_path / "again.npz")
    again = load_brake_residual(tmp_path / "again.npz")
    assert all(np.array_equal(a, b) for a, b in zip(skill.network, again.network, strict=True))
    with pytest.raises((LocomotionError, ArchiveError)):
        load_brake_residual(tmp_path / "none.npz")
    assert isinstance(again, ResidualSkill)
