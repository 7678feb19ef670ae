"""Characters do what persons do: parts turn alike, bones keep their lengths, feet stand, knees bend ahead."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

import locomotion.characters.driven_bones as driven_bones
import locomotion.characters.feet as feet
from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.characters.contacts import contacts_with
from locomotion.characters.person_measures import person_arrays
from locomotion.characters.skinning import posed_points
from tests.locomotion.characters.persons import places_of, plane, postures, running

WHO = ("stout", "tall", "agent")


def turns(pose):
    return Rotation.from_quat(pose[..., 3:], scalar_first=True)


def body(places, name):
    return places[..., BODY_NAMES.index(name), :]


def bone(rig, pose, part):
    return pose[..., rig.names.index(rig.parts[part]), :]


def sole(rig, pose, side):
    """(k, 3) points of the mesh that hang on a foot and its toes."""
    mesh = rig.skeleton.mesh
    most = np.array(rig.names)[mesh.bones[np.arange(len(mesh.bones)), mesh.shares.argmax(axis=1)]]
    names = [rig.parts[part] for part in (f"{side}_foot", f"{side}_toes") if part in rig.parts]
    return posed_points(rig.skeleton, pose, np.flatnonzero(np.isin(most, names)))


@pytest.mark.parametrize("who", WHO)
def test_parts_turn_in_the_world_as_the_persons_do(rigs, who):
    """Against SciPy: from its orientation while the person stands neutral, a bone turns as its part."""
    rig, places = rigs[who], running()[::9]
    neutral = rig.pose_from(places_of(np.eye(1, 46, 3) + 0.9 * np.eye(1, 46, 2))[0])
    poses = rig.pose_from(places)
    for part in ("pelvis", "chest", "head", "right_upper_arm", "left_hand", "right_foot", "left_clavicle"):
        if part in rig.parts:
            wanted = turns(body(places, part)) * turns(bone(rig, neutral, part))
            assert (wanted.inv() * turns(bone(rig, poses, part))).magnitude().max() < 1e-6, part


def test_spines_and_twists_are_between_the_bodies(rigs):
    """Against SciPy's Slerp; the twist of a forearm is spread along its bones."""
    rig, places = rigs["agent"], running()
    qpos = np.zeros((1, 46))
    qpos[0, [2, 3]] = 0.9, 1.0
    neutral = rig.pose_from(places_of(qpos)[0])
    poses = rig.pose_from(places)
    for k, name in enumerate([f"spine_{k:02}" for k in range(1, 6)]):
        b, share = rig.names.index(name), 2.0 * (k + 1) / 5
        one, other = ("pelvis", "waist") if share < 1.0 else ("waist", "chest")
        for pose, place in zip(poses[::20], places[::20], strict=True):
            ends = Rotation.concatenate([turns(body(place, one)), turns(body(place, other))])
            wanted = Slerp([0.0, 1.0], ends)(share % 1.0 if share < 2.0 else 1.0) * turns(neutral[b])
            assert (wanted.inv() * turns(pose[b])).magnitude() < 2e-3
    qpos[0, 7 + 12] = 0.0
    twisted = qpos.copy()
    twisted[0, 7 + JOINT_NAMES.index("right_forearm_twist")] = 1.0
    pose = rig.pose_from(places_of(twisted)[0])
    turned = {
        name: (turns(neutral[rig.names.index(name)]).inv() * turns(pose[rig.names.index(name)])).magnitude()
        for name in ("lowerarm_r", "lowerarm_twist_01_r", "hand_r", "upperarm_r")
    }
    assert turned["upperarm_r"] == pytest.approx(0.0, abs=1e-6)
    assert turned["lowerarm_r"] == pytest.approx(0.0, abs=1e-6)
    assert turned["lowerarm_twist_01_r"] == pytest.approx(0.6, abs=0.02)
    assert turned["hand_r"] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("who", WHO)
def test_bones_keep_their_lengths_and_what_shows_nothing_its_rest(rigs, who):
    rig = rigs[who]
    poses = rig.local(rig.pose_from(np.concatenate([running(), [*postures().values()]]), ground=plane()))
    rest = rig.local(rig.rest)
    moving = {rig.names.index(rig.parts["pelvis"])}
    while moving and rig.parents[min(moving)] >= 0:  # the pelvis moves on what it hangs on, and that
        moving.add(int(rig.parents[min(moving)]))
    still = [
        b for b in range(len(rig.names)) if b not in moving and rig.parents[b] not in moving - {min(moving)}
    ]
    still = [b for b in still if rig.parents[b] >= 0 and b not in moving]
    np.testing.assert_allclose(
        poses[:, still, :3], np.broadcast_to(rest[still, :3], (len(poses), len(still), 3)), atol=1e-6
    )
    for b, name in enumerate(rig.names):
        if "fingers" in name:
            np.testing.assert_allclose(np.abs(poses[:, b, 3:] @ rest[b, 3:]), 1.0, atol=1e-9)


@pytest.mark.parametrize("who", WHO)
@pytest.mark.parametrize("side", ["right", "left"])
def test_feet_stand_where_the_persons_stand(rigs, who, side):
    """On a run that comes to rest on the plane, and in postures: over and under the ground at most 1 cm."""
    rig, places = rigs[who], np.concatenate([running(), [postures()["stand"], postures()["crouch"]]])
    ground, person = plane(), person_arrays()
    number = ("right", "left").index(side)
    stands = []
    for place, pose in zip(places, rig.pose_from(places, ground=ground), strict=True):
        lows = []
        for limb, ends in ((2, person.feet[number]), (3, person.toes[number])):
            here = place[person.limbs[limb, number]]
            lows.append((here[2] + turns(here).apply(ends[:, :3])[:, 2] - ends[:, 3]).min())
        if min(lows) < 0.001 and feet.planted(place[person.limbs[1, number], 3:]) == 1.0:
            stands.append(sole(rig, pose, side)[:, 2].min())
    assert len(stands) > 8
    assert np.abs(stands).max() < 0.01


@pytest.mark.parametrize("who", WHO)
def test_a_foot_that_rolls_off_stays_where_it_is(rigs, who):
    """The person's toes stand still while its heel rises by 40 degrees: so do the character's."""
    rig, qpos = rigs[who], np.zeros((30, 46))
    lift = np.radians(np.linspace(0.0, 40.0, 30))
    names = [f"{side}_toe_extension" for side in ("right", "left")]
    qpos[:, 3] = 1.0
    for name in names:
        qpos[:, 7 + JOINT_NAMES.index(name)] = lift
        qpos[:, 7 + JOINT_NAMES.index(name.replace("toe_extension", "ankle_flexion"))] = -lift
    places = places_of(qpos)
    places[..., :3] -= places[:, [BODY_NAMES.index("right_toes")], :3]
    places[..., :3] += [0.0, 0.0, 0.024]
    poses = rig.pose_from(places, ground=plane())
    soles = np.stack([sole(rig, pose, "right") for pose in poses])
    assert np.abs(soles[:, :, 2].min(axis=1)).max() < 0.002
    flat = np.flatnonzero(soles[0, :, 2] < soles[0, :, 2].min() + 1e-4)
    front = flat[soles[0, flat, 0].argmax()]  # the last point of the sole that leaves the ground
    stays = soles[soles[:, front, 2] < 0.003, front, :2]
    assert len(stays) > 8 and np.linalg.norm(np.ptp(stays, axis=0)) < 0.01


@pytest.mark.parametrize("who", WHO)
def test_knees_bend_ahead_and_elbows_back(rigs, who):
    rig, places = rigs[who], np.concatenate([running(), [*postures().values()]])
    poses = rig.pose_from(places, ground=plane())
    for side in ("right", "left"):
        for names, sign in ((("thigh", "shank", "foot"), 1.0), (("upper_arm", "forearm", "hand"), -1.0)):
            first, middle, last = (bone(rig, poses, f"{side}_{name}")[:, :3] for name in names)
            hinge = turns(body(places, f"{side}_{names[1]}")).apply([0.0, 1.0, 0.0])
            if sign < 0.0:
                hinge = turns(body(places, f"{side}_{names[0]}")).apply([0.0, 1.0, 0.0])
            bend = np.cross(middle - first, last - middle)
            size = np.linalg.norm(bend, axis=1)
            clear = size > 0.02 * np.linalg.norm(middle - first, axis=1) * np.linalg.norm(
                last - middle, axis=1
            )
            assert (sign * np.sum(bend * hinge, axis=1) / size)[clear].min() > 0.3


@pytest.mark.parametrize("who", WHO)
def test_hands_that_touch_the_ground_are_where_the_persons_are(rigs, who):
    rig, place = rigs[who], postures()["all-fours"]
    ground, person = plane(), person_arrays()
    held = contacts_with(ground, place[None]).hands[0]
    assert held.min() > 0.9
    for pose in (rig.pose_from(place, ground=ground), rig.pose_from(place, hands=(1.0, 1.0))):
        for k, side in enumerate(("right", "left")):
            here, own = body(place, f"{side}_hand"), bone(rig, pose, f"{side}_hand")
            wanted = here[:3] + turns(here).apply(person.hand)
            reached = own[:3] + turns(own).apply(rig.hand_points[k])
            assert np.linalg.norm(reached - wanted) < 0.02
    free = rig.pose_from(postures()["stand"], ground=ground)
    np.testing.assert_array_equal(free, rig.pose_from(postures()["stand"], ground=ground, hands=(0.0, 0.0)))


@pytest.mark.parametrize("who", WHO)
def test_hands_that_hold_one_thing_are_as_far_apart_as_the_persons(rigs, who):
    rig, qpos, person = rigs[who], np.zeros((1, 46)), person_arrays()
    qpos[0, [2, 3]] = 0.9, 1.0
    for side, rotation in (("right", 40.0), ("left", 70.0)):
        for joint, angle in (
            ("shoulder_flexion", 45.0),
            ("shoulder_rotation", rotation),
            ("elbow_flexion", 75.0),
        ):
            qpos[0, 7 + JOINT_NAMES.index(f"{side}_{joint}")] = np.radians(angle)
    place = places_of(qpos)[0]

    def apart(places, names, points):
        ends = [here[:3] + turns(here).apply(point) for here, point in zip(places, points, strict=True)]
        return ends[1] - ends[0]

    sides = ("right", "left")
    wanted = apart([body(place, f"{side}_hand") for side in sides], sides, [person.hand] * 2)
    off = []
    for grip in (1.0, 0.0):
        pose = rig.pose_from(place, grip=grip)
        found = apart([bone(rig, pose, f"{side}_hand") for side in sides], sides, rig.hand_points)
        off.append(np.linalg.norm(found - wanted))
    assert np.linalg.norm(wanted) < 0.5
    assert off[0] < 0.005 < off[1]


def test_the_pelvis_stays_over_its_point_and_nothing_jumps(rigs):
    places = running()
    for rig in rigs.values():
        poses = rig.pose_from(places, ground=plane())
        hips = 0.5 * (bone(rig, poses, "right_thigh") + bone(rig, poses, "left_thigh"))[:, :2]
        np.testing.assert_allclose(hips, body(places, "pelvis")[:, :2], atol=1e-6)
        steps = (turns(poses[:-1].reshape(-1, 7)).inv() * turns(poses[1:].reshape(-1, 7))).magnitude()
        own = (turns(places[:-1].reshape(-1, 7)).inv() * turns(places[1:].reshape(-1, 7))).magnitude()
        assert steps.max() < own.max() + np.radians(12.0)


def test_sources_name_the_persons_bodies():
    assert driven_bones.SOURCES[:20] == BODY_NAMES
