"""The trunk's movement with the stride, as it is seen from outside."""

import numpy as np
import pytest

from benchmarks.dog_back import BODIES, angles, going, strides
from locomotion.quadruped import Herd, lay_trail, load_body
from locomotion.quadruped import layout as at
from locomotion.quadruped.pose import body_names
from locomotion.quadruped.trunk import move_trunk
from tests.locomotion.quadruped.scenes import plane


@pytest.mark.parametrize(
    ("name", "speed", "least"), [("dog", 6.0, 30.0), ("cat", 5.0, 40.0), ("horse", 13.0, 15.0)]
)
def test_the_back_flexes_before_the_hind_feet_land_and_extends_once_they_have_left(name, speed, least):
    body = load_body(name)
    found = strides(body, speed, "gallop")
    assert found["flexion_deg"] >= least
    gait = body.gaits["gallop"]
    duty = gait.duty_rear[0] + gait.duty_rear[1] * speed
    # the first hind foot lands at 0; in the last third of its swing, and in the first after it has left
    assert 1.0 - (1.0 - duty) / 3.0 <= found["most_flexed"] <= 1.0
    assert duty <= found["most_extended"] <= duty + 0.2 + (1.0 - duty) / 3.0


def test_a_body_without_a_word_about_its_back_flexes_by_half_of_what_it_bends():
    foal = load_body(BODIES[-1])
    assert strides(foal, 6.0, "gallop")["flexion_deg"] == pytest.approx(0.5 * 3 * 12, abs=3.5)
    assert strides(foal, 1.2, "walk")["flexion_deg"] == pytest.approx(5.0, abs=0.5)


@pytest.mark.parametrize("name", ["dog", "cat", "horse"])
def test_in_the_walk_the_head_nods_twice_a_stride_and_the_hips_roll(name):
    body = load_body(name)
    found = strides(body, 0.8 * body.gaits["walk"].up_to, "walk")
    assert found["nods"] == pytest.approx(2.0, abs=0.1)
    back = body.gaits["walk"].back
    assert found["hip_roll_deg"] == pytest.approx(back.hip_roll_deg, rel=0.05)
    assert 0.5 * back.undulation_deg < found["undulation_deg"] < back.undulation_deg
    assert found["tail_deg"] > 2.0


@pytest.mark.parametrize("name", ["dog", "cat", "horse"])
def test_in_the_gallop_the_tail_goes_up_and_down_with_the_pelvis_and_its_tip_comes_last(name):
    body = load_body(name)
    poses, _ = going(body, 0.8 * body.top_speed, "gallop")
    names = body_names(body.spine.bones)
    pelvis, root, tip = (angles(poses[:, names.index(each)])[:, 1] for each in ("pelvis", "tail_1", "tail_3"))
    assert np.ptp(pelvis) > np.radians(12.0)
    assert 0.7 * np.ptp(pelvis) < np.ptp(tip) < 1.3 * np.ptp(pelvis)
    waves = [np.fft.rfft(each - each.mean()) for each in (-pelvis, root, tip)]  # the tail points backwards
    stride = np.abs(waves[0]).argmax()
    late = -np.diff(np.unwrap([np.angle(wave[stride]) for wave in waves]))
    assert (late > 0.2).all() and late[1] > late[0]


def test_in_the_gallop_the_head_nods_once():
    assert strides(load_body("dog"), 5.0, "gallop")["nods"] == pytest.approx(1.0, abs=0.1)


def test_a_hip_is_low_when_its_foot_lands_and_in_front_of_the_other():
    body = load_body("dog")
    poses, stands = going(body, 1.0, "walk")
    names = body_names(body.spine.bones)
    hips = poses[:, [names.index(f"rear_{side}_upper") for side in ("left", "right")], :3]
    landings = np.flatnonzero(~stands[:-1, 2] & stands[1:, 2]) + 1
    ahead, higher = (hips[:, 0] - hips[:, 1])[:, 0], (hips[:, 0] - hips[:, 1])[:, 2]
    assert (ahead[landings] > 0.6 * ahead.max()).all()
    assert (higher[landings] < 0.6 * higher.min()).all()


def test_the_trunk_is_still_where_nothing_moves_it():
    """Ranges fade with the speed: on the way to a stop there is no last jerk."""
    body, ground = load_body("dog"), plane()
    herd = Herd(ground)
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    herd.follow(0, lay_trail([[0.0, 0.0, 0.0], [12.0, 0.0, 0.0]], body, ground), 5.0)
    back = []
    while not herd.resting(0):
        herd.tick()
        back.append(herd.state[0, [at.BACK, at.ROLL_REAR, at.NECK_DIP]])
    assert (
        np.abs(np.diff(back, axis=0)).max() < 0.15
    )  # [rad] a tick: 57 degrees at 4 strides a second make 0.12
    assert np.abs(herd.state[0, at.BACK]) < np.radians(3.0)


def test_frames_keep_what_they_are_asked_for():
    """`angles` reads yaw, elevation and roll out of a frame that was made of them."""
    from locomotion.quadruped.pose import _frame, _roll_frame

    row = np.zeros(7)
    _frame(row, 1.0, 2.0, 3.0, 0.4, -0.3)
    _roll_frame(row, 0.2)
    assert angles(row) == pytest.approx([0.4, -0.3, 0.2])


def test_in_no_order_of_the_legs_does_the_trunk_rise_by_more_than_a_gait_lets_it():
    """On their way from one order to another the legs pass through many that belong to no gait."""
    body, rng = load_body("dog"), np.random.default_rng(4)
    herd = Herd(plane())
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    state, most = herd.state[0], 0.0
    trot = body.gait_rows()[body.gait_index("trot")]
    state[at.REST], state[at.SPEED], state[[at.DUTY_FRONT_NOW, at.DUTY_REAR_NOW]] = 0.0, 3.0, 0.3
    for _ in range(100):  # all run by now
        move_trunk(state, body.params(), trot)
    for _ in range(3000):
        state[at.BOB_NOW], state[at.ROCK_NOW] = -0.02, 0.02
        state[at.TOUCHDOWN_NOW : at.TOUCHDOWN_NOW + 4] = rng.random(4)
        move_trunk(state, body.params(), trot)
        bound = max(-state[at.BOB_NOW], state[at.ROCK_NOW]) + 1e-9
        lift = np.abs(state[[at.LIFT_REAR, at.LIFT_FRONT]]).max() / bound
        assert lift <= 1.0
        most = max(most, lift)
    assert most > 0.9
