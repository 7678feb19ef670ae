"""A person with the learned walk: from stand to stand on level ground, where it gives back, and that it is
saved whole."""

import itertools

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.body.traits import by_hand
from locomotion.errors import LocomotionError
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.walk.layout import WALK_STEPS
from locomotion.ground.ground import Ground
from locomotion.human.human import Human
from locomotion.human.learned_tick import CALM_SPEED, CALM_TURN
from locomotion.human.saved_state_check import check_person
from locomotion.rehearsal.choices import BRAKINGS
from locomotion.rehearsal.trials import ComesToRest, at_once
from tests.locomotion.human.people import finish, flat_ground


def walker(ground=None, **options):
    human = Human(ground, clearing=(), rehearsals=0, policy=load_policy(), **options)
    human.reset((0.0, 0.0, 0.0), 0.0)
    return human


def with_kerb():
    """Level ground with a kerb of 0.1 m at x = 6."""
    kerb = np.array([[x, y, z] for x, z in ((-5, 0), (6, 0), (6.001, 0.1), (20, 0.1)) for y in (-3, 3.0)])
    faces = [f for k in range(3) for f in ([2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1])]
    return Ground.from_arrays(kerb, faces)


def learned_at(human, limit=40.0):
    """Follow the path to its end; where it walked as learned, (n,) [m] of its way."""
    places = []
    while human.status == "walking" and human.time < limit:
        human.tick()
        if human.on_feet.walks_as_learned:
            places.append(human.arc_length)
    return np.array(places)


def test_it_sets_off_walks_and_stops_as_learned_on_level_ground():
    human = walker()
    human.follow([[0, 0, 0], [9, 0, 0], [12, 3, 0]], 1.25)
    places = learned_at(human)
    assert human.status == "arrived"
    assert len(places) > 0.95 * human.ticks
    assert places[200] < 1.5
    while not human.held:
        human.tick()
    assert human.on_feet.walks_as_learned
    assert human.on_feet.at_rest(human.control)
    knees = [JOINT_NAMES.index(f"{side}_knee_flexion") for side in ("right", "left")]
    assert (human.qpos[7:][knees] < np.radians(20.0)).all(), "it stands straight"
    assert np.linalg.norm(human.com[:2] - [12, 3]) < 0.5


def test_its_style_shows_on_level_ways_only():
    """Elsewhere planned gaits take over, and they know the usual person only."""
    human = walker(with_kerb())
    human.wear(by_hand(arms=1.5, lean=0.1))
    for end, shows in (([4, 0, 0], True), ([12, 0, 0.1], False), ([4, 1, 0], True)):
        human.follow([[0, 0, 0], end], 1.25)
        assert human.on_feet.learned_memory[at.STYLE].any() == shows
    again = walker(with_kerb())
    again.restore_state(human.save_state())
    assert np.array_equal(again.on_feet.learned_memory, human.on_feet.learned_memory)


def test_it_gives_back_before_a_kerb_and_where_it_is_told_to_stop():
    human = walker(with_kerb())
    human.follow([[0, 0, 0], [12, 0, 0.1]], 1.25)
    places = learned_at(human)
    assert human.status == "arrived"
    assert not ((places > 5.3) & (places < 6.4)).any()
    assert (places < 5.0).any()
    human = walker()
    human.follow([[0, 0, 0], [50, 0, 0]], 1.25)
    while not human.on_feet.walks_as_learned:
        human.tick()
    human.stop()
    begun = human.com
    while not human.held:
        human.tick()
    assert human.status == "standing"
    assert np.linalg.norm(human.com - begun) < 3.0
    assert human.on_feet.at_rest(human.control)


@pytest.mark.parametrize("facing", [1.6, 3.1])
def test_it_turns_on_the_spot_as_learned(facing):
    human = walker()
    human.reset((0.0, 0.0, 0.0), facing)
    human.follow([[0, 0, 0], [9, 0, 0]], 1.25)
    while abs(human.yaw) > 0.4:
        human.tick()
        assert human.on_feet.walks_as_learned
        assert np.linalg.norm(human.com[:2]) < 0.7
    finish(human)
    assert human.status == "arrived"


def test_it_gets_ready_to_run_out_of_its_straight_stand():
    human = walker()
    human.follow([[0, 0, 0], [3, 0, 0]], 1.0)
    while not human.held:
        human.tick()
    assert human.on_feet.walks_as_learned
    human.follow([[3, 0, 0], [28, 0, 0]], 3.3)
    finish(human, 60.0)
    assert human.status == "arrived"


@pytest.mark.parametrize("moment", [0, 321])
def test_a_saved_walk_goes_on_bit_for_bit(moment):
    human, twin = walker(flat_ground()), walker(flat_ground())
    human.follow([[0, 0, 0], [20, 0, 0]], 1.25)
    while not human.on_feet.walks_as_learned:
        human.tick()
    for _ in range(moment):
        human.tick()
    state = human.save_state()
    check_person(state, twin)
    twin.restore_state(state)
    for _ in range(150):
        human.tick()
        twin.tick()
    assert human.state_hash() == twin.state_hash()


def test_a_state_of_one_is_no_state_of_another():
    planned = Human(flat_ground(), clearing=(), rehearsals=0)
    with pytest.raises(LocomotionError, match="another model"):
        check_person(walker(flat_ground()).save_state(), planned)


def test_a_fallen_one_is_not_moved_any_more():
    human = walker(flat_ground(), gets_up=True)
    human.follow([[0, 0, 0], [20, 0, 0]], 1.25)
    while not human.on_feet.walks_as_learned:
        human.tick()
    human.data.qvel[:2] = 0.0, 4.0
    while human.status == "walking":
        human.tick()
    assert human.status == "getting up"
    assert not human.on_feet.walks_as_learned


def test_it_runs_from_there():
    human = walker()
    human.follow([[0, 0, 0], [25, 0, 0]], 3.3)
    finish(human, 40.0)
    assert human.status == "arrived"


def test_who_is_put_on_level_ground_stands_straight_and_stays():
    human = walker(flat_ground())
    human.reset((0.0, 0.0, 0.0), 0.7)
    knees = [JOINT_NAMES.index(f"{side}_knee_flexion") for side in ("right", "left")]
    place = human.com
    for _ in range(300):
        human.tick()
    assert human.on_feet.walks_as_learned
    assert (human.qpos[7:][knees] < np.radians(20.0)).all()
    assert np.linalg.norm(human.com - place) < 0.03
    assert human.status == "standing"


@pytest.mark.parametrize("bend", [[], [[2, 0, 0], [3.5, 1, 0]]])
def test_it_is_slow_and_straight_before_planned_steps_go_on(bend):
    human = walker(with_kerb())
    human.reset((-4.0, 0.0, 0.0), 0.0)
    human.follow([[-4, 0, 0], *bend, [12, 1, 0.1]], 1.8)
    before, gave_back = human.on_feet.learned_memory.copy(), []
    while human.status == "walking" and human.time < 40.0:
        was = human.on_feet.walks_as_learned
        before[:] = human.on_feet.learned_memory
        human.tick()
        if was and not human.on_feet.walks_as_learned:
            gave_back.append(before[[at.TOLD, at.TURN_RATE]])
    assert human.status == "arrived" and gave_back
    assert max(told for told, _ in gave_back) < CALM_SPEED + 0.02
    assert max(abs(turn) for _, turn in gave_back) < CALM_TURN + 0.05


def test_who_is_put_beside_a_kerb_stands_as_planned():
    kerb = np.array([[x, y, z] for x, z in ((-5, 0), (0.3, 0), (0.301, 0.1), (9, 0.1)) for y in (-3, 3.0)])
    faces = [f for k in range(3) for f in ([2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1])]
    assert not walker(Ground.from_arrays(kerb, faces)).on_feet.walks_as_learned


def test_told_to_run_as_it_walks_it_runs_as_learned_and_slows_down_to_its_goal():
    human = walker()
    human.follow([[0, 0, 0], [60, 0, 0]], 1.4)
    while human.arc_length < 3.0:
        human.tick()
    human.follow([human.com * [1, 1, 0], [45, 0, 0]], 3.5)
    speeds = []
    while human.status in ("walking", "running") and human.time < 40.0:
        human.tick()
        speeds.append((human.arc_length, human.velocity[0]))
        assert human.on_feet.walks_as_learned
        assert (human.gait_now == "run") == (human.status == "running") == human.on_feet.runs_as_learned
    arcs, speed = np.array(speeds).T
    assert human.status == "arrived"
    assert speed[(arcs > 18.0) & (arcs < 30.0)].mean() == pytest.approx(3.5, abs=0.25)
    before = arcs[-1] - arcs
    assert speed[(before > 2.8) & (before < 3.6)].mean() > 2.2, "it runs up to its goal"
    assert speed[before < 1.0].max() < 1.6


def test_where_the_way_has_a_kerb_it_slows_down_before_and_takes_it_as_planned():
    kerb = np.array([[x, y, z] for x, z in ((-5, 0), (25, 0), (25.001, 0.1), (60, 0.1)) for y in (-3, 3.0)])
    faces = [f for k in range(3) for f in ([2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1])]
    human = walker(Ground.from_arrays(kerb, faces))
    human.follow([[0, 0, 0], [40, 0, 0.1]], 3.5)
    ran = False
    while human.status in ("walking", "running") and human.time < 60.0:
        human.tick()
        ran |= human.on_feet.runs_as_learned and human.velocity[0] > 3.0
        if abs(human.arc_length - 25.0) < 0.5:
            assert not human.on_feet.walks_as_learned
    assert ran and human.status == "arrived"


def planned_runner(speed):
    """One in a planned run, from which the learned one has not taken over."""
    human = walker()
    human.reset((0.0, 0.0, 0.0), 0.0, speed)
    human.follow([[0, 0, 0], [60, 0, 0]], speed)
    return human


@pytest.mark.parametrize("speed", [2.6, 3.4, 4.2])
def test_a_planned_run_ends_as_learned(speed):
    human = planned_runner(speed)
    while human.arc_length < 14.0:
        human.tick()
    assert not human.on_feet.walks
    human.stop()
    while not human.held and human.status != "fallen":
        human.tick()
        assert human.on_feet.slowing == 0.0
    assert human.status == "standing" and human.on_feet.walks_as_learned
    assert human.on_feet.at_rest(human.control)


def braking(harder, after=14.0):
    """One who runs, and has just begun to brake."""
    human = planned_runner(3.0)
    while human.arc_length < after:
        human.tick()
    human.brake(harder)
    return human


def stopped(onward):
    """One who has braked, in several steps, and just stands, in a crouch; with ``onward`` it is to go on."""
    for harder, after in itertools.product(BRAKINGS, (14.0, 14.4, 14.8)):
        human = braking(harder, after)
        while human.status != "fallen" and not human.on_feet.stands_still(human.control):
            human.tick()
        if human.status != "fallen" and human.on_feet.walk[WALK_STEPS] >= 4.0:
            assert not human.on_feet.at_rest(human.control), "it crouches"
            if onward:
                human.follow([human.com * [1, 1, 0], [60, 0, 0]], 1.3)
            else:
                human.stop()
            return human
    raise AssertionError("it always falls")


def test_out_of_a_crouch_it_straightens_up_as_learned():
    human = stopped(onward=False)
    while human.status != "fallen" and not human.held:
        human.tick()
    assert human.on_feet.walks_as_learned
    knees = [JOINT_NAMES.index(f"{side}_knee_flexion") for side in ("right", "left")]
    assert (human.qpos[7:][knees] < np.radians(20.0)).all()


def test_out_of_a_crouch_it_sets_off_as_planned():
    human = stopped(onward=True)
    as_planned = 0
    while not human.on_feet.walks_as_learned:
        human.tick()
        as_planned += human.gait_now == "walk"
    assert as_planned > 100 and human.status == "walking" and np.linalg.norm(human.velocity[:2]) > 0.5


def test_a_stop_counts_as_rehearsed_when_it_stands_if_only_in_a_crouch():
    """It goes on from there, and never stands straight."""
    assert any(at_once(ComesToRest()(braking(harder)))[0] > 0.0 for harder in BRAKINGS)


@pytest.mark.parametrize("angle", [0.9, 1.6, 2.2])
def test_told_elsewhere_it_turns_as_it_walks(angle):
    human = walker()
    human.follow([[0, 0, 0], [60, 0, 0]], 1.3)
    while human.arc_length < 4.0:
        human.tick()
    here, way = human.com * [1, 1, 0], np.array([np.cos(angle), np.sin(angle), 0.0])
    human.follow([here, here + 20.0 * way], 1.3)
    begun = human.ticks
    while human.velocity @ way < 1.1:
        human.tick()
        assert human.on_feet.walks_as_learned and not human.on_feet.learned.stands
        assert human.ticks - begun < 400
    off = np.cross(way, (human.com - here) * [1, 1, 0])[2]
    assert abs(off) < 1.6, "no farther than a stop would have taken it"


def test_one_that_runs_only_straight_ahead_does_not_waver_between_walk_and_run():
    """Askew to its way it turns first; a run that begins there would end at once, and begin again."""
    human = walker()
    human.follow([[0, 0, 0], [60, 0, 0]], 1.3)
    while human.arc_length < 4.0:
        human.tick()
    here, way = human.com * [1, 1, 0], np.array([np.cos(0.8), np.sin(0.8), 0.0])
    human.follow([here, here + 40.0 * way], 3.5)
    ran = []
    while human.velocity @ way < 3.0:
        human.tick()
        ran.append(human.on_feet.runs_as_learned)
        assert len(ran) < 500
    assert np.count_nonzero(np.diff(ran)) == 1


@pytest.mark.parametrize("takes_over", [True, False])
def test_saved_just_before_it_takes_over_or_gives_back_it_goes_on_the_same_elsewhere(takes_over):
    """What MuJoCo derives from a state is not saved: neither may depend on it, nor on who looks at a pose."""
    human, other = walker(with_kerb()), walker(with_kerb())
    human.follow([[0, 0, 0], [14, 0, 0.1]], 1.3)
    changed = False
    while not changed:
        saved, before = human.save_state(), human.on_feet.walks_as_learned
        human.tick()
        assert human.status == "walking"
        changed = before != human.on_feet.walks_as_learned and before != takes_over
    other.restore_state(saved)
    other.simulation.body_transforms()
    other.tick()
    assert np.array_equal(other.qpos, human.qpos)
    assert np.array_equal(other.on_feet.learned_memory, human.on_feet.learned_memory)
    assert np.array_equal(other.on_feet.walk, human.on_feet.walk)
