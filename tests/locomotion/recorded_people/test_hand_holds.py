"""Hands that rest on what is cleared: found in a recording, and brought to the real obstacle."""

import numpy as np
import pytest

from locomotion.body.arm_reach import HAND_RADIUS, hand_place
from locomotion.body.person import JOINT_NAMES
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.sampling import sample_clips
from locomotion.recorded.skeletons import FULL, LEVELS, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.hand_holds import hand_of, with_hand_at
from locomotion.recorded_people.recorded_skills import recorded_skills
from tests.locomotion.recorded_people.test_clearing import EDGE, THICK, over


def standing():
    pose = np.zeros(46)
    pose[2:4] = 0.9, 1.0
    pose[7 + JOINT_NAMES.index("left_elbow_flexion")] = 0.6
    return pose


@pytest.mark.parametrize("size", [0.88, 1.0, 1.08])
def test_a_hand_is_brought_to_a_point_with_nothing_else_changed(size):
    pose = standing()
    point = hand_of(pose, 1.0, size) + np.array([0.1, 0.05, 0.1])
    changed = with_hand_at(pose, 1.0, point, 1.0, size)
    assert hand_of(changed, 1.0, size) == pytest.approx(
        point + np.array([0.0, 0.0, size * HAND_RADIUS]), abs=2e-3
    )
    arm = [name.startswith("left_") and ("shoulder" in name or "elbow" in name) for name in JOINT_NAMES]
    assert np.flatnonzero(changed - pose).tolist() == [7 + k for k in np.flatnonzero(arm)]
    assert (with_hand_at(pose, 1.0, point, 0.0, size) == pose).all()


def test_a_body_comes_nearer_to_what_its_arm_does_not_reach():
    pose = standing()
    point = hand_place(pose, -1.0) + np.array([0.0, -0.3, -0.1])
    changed = with_hand_at(pose, -1.0, point, 1.0)
    assert hand_place(changed, -1.0) == pytest.approx(point + np.array([0.0, 0.0, HAND_RADIUS]), abs=5e-3)
    assert 0.01 < np.linalg.norm(changed[:3] - pose[:3]) < 0.3


def test_in_the_recording_of_the_vault_a_hand_rests_on_the_wall():
    motions = load_motions()
    found = recorded_skills(motions)
    assert all(not skill.holds for name, skill in found.items() if name != "vault")
    vault = found["vault"]
    (hold,) = vault.holds
    assert vault.leaves < hold.first < hold.last < vault.lands
    sample = sample_clips(motions, FULL, [vault.clip], [0.5 * (hold.first + hold.last)])
    hand = hand_place(skeleton(LEVELS[FULL]).as_qpos(*sample)[0], hold.side)
    assert hand[2] == pytest.approx(vault.size, abs=0.05)
    assert 0.0 < hand[0] - vault.edge < vault.depth


@pytest.mark.parametrize("height", [0.6, 0.95])
@pytest.mark.parametrize("level", range(3))
def test_who_vaults_a_wall_of_another_height_has_a_hand_on_it(height, level):
    people, ada = over("vault", height, level)
    (hold,) = people.skills["vault"].holds
    off = []
    while ada.status not in ("arrived", "stuck"):
        people.tick()
        if people.rows[0, at.CROSSES] == at.CLEARS:
            if hold.first <= ada.course.moment(ada.time) <= hold.last:
                x, _, z = hand_of(ada.qpos, hold.side, 1.0)
                off.append(max(abs(z - height - HAND_RADIUS), EDGE - x, x - EDGE - THICK))
    assert len(off) > 5 and max(off) < 0.02
