"""Following paths: root and front on the path, standing feet on the ground, head a time ahead, stops."""

import math

import numpy as np
import pytest
from scipy.spatial import KDTree

import navmesh
from benchmarks.shared_data import level_path, shared_folder, why_absent
from locomotion import Ground, LocomotionError, smooth_route
from locomotion.events import Arrived, MissedGoal, SetOff
from locomotion.quadruped import Herd, lay_trail, load_body, stopping_distance
from locomotion.quadruped import layout as at
from locomotion.quadruped.following import wrap
from locomotion.quadruped.gait import leg_phase
from locomotion.quadruped.motion import DT
from tests.locomotion.quadruped.scenes import animal_on, bone_toes, floor, plane, quads, run, stairs

BEND = np.column_stack([
    np.linspace(0.0, 7.0, 141), 0.6 * np.sin(1.3 * np.linspace(0.0, 7.0, 141)), np.zeros(141),
])  # fmt: skip


def follow(body, speed, points=BEND, gait=None):
    ground = plane()
    herd = Herd(ground)
    trail = lay_trail(points, body, ground)
    index = herd.add(body, points[0], trail.heading(0.0))
    herd.follow(index, trail, speed, gait=gait)
    return herd, index, trail


@pytest.mark.parametrize(("name", "speed"), [("dog", 1.0), ("dog", 2.0), ("cat", 0.6), ("horse", 1.2)])
def test_root_and_front_are_on_the_path(name, speed):
    herd, index, trail = follow(load_body(name), speed)
    line = KDTree([trail.point(arc) for arc in np.arange(-1.5, trail.length + 1.5, 0.002)])
    roots, fronts = [], []
    while not herd.resting(index):
        herd.tick()
        roots.append(herd.root(index)[:2])
        fronts.append(herd.front(index).copy())
    assert line.query(roots)[0].max() < 0.01
    # it is put down straight where the path bends: a second to bend onto it
    assert np.percentile(line.query(fronts[100:])[0], 95) < 0.03


@pytest.mark.parametrize("gait", ["walk", "trot", "gallop", "pace"])
def test_standing_feet_do_not_move(gait):
    speed = {"walk": 1.0, "trot": 2.0, "gallop": 4.0, "pace": 1.1}[gait]
    animal = animal_on(plane())
    animal.go_to((9.0, 0.5, 0.0), speed, gait=gait)
    last = {}

    def look():
        toes = bone_toes(animal)
        for leg, stands in enumerate(animal.herd.standing_feet(animal.index)):
            if stands and leg in last:
                assert np.abs(toes[leg] - last[leg]).max() < 1e-6
            last.pop(leg, None)
            if stands:
                last[leg] = toes[leg]
                assert abs(toes[leg, 2]) < 1e-6

    run(animal, each=look)
    assert animal.status == "arrived"


@pytest.mark.parametrize(
    ("ground", "begin", "end"),
    [
        (stairs(), (0.0, 0.0, 0.0), (6.0, 0.0, 0.9)),
        (stairs(), (6.0, 0.0, 0.9), (0.0, 0.0, 0.0)),
        (Ground.from_arrays(*quads(floor(slope=0.5))), (0.0, 0.0, 0.0), (6.0, 0.0, 3.0)),
        (Ground.from_arrays(*quads(floor(slope=0.5))), (6.0, 0.0, 3.0), (0.0, 0.0, 0.0)),
    ],
    ids=["upstairs", "downstairs", "uphill", "downhill"],
)
def test_joints_do_not_jump(ground, begin, end):
    yaw = math.atan2(0.0, end[0] - begin[0])
    animal = animal_on(ground, None, begin, yaw, np.array([begin, end]))
    joints = []
    animal.go_to(end, 2.0)
    run(animal, each=lambda: joints.append(animal.herd.joints[animal.index].copy()))
    assert animal.status == "arrived"
    speeds = np.diff(np.unwrap(joints, axis=0), axis=0) / DT
    assert np.abs(np.diff(speeds, axis=0)).max() < 25.0


@pytest.mark.parametrize("steepest", [1.1, 1.3, 1.6])
def test_the_trunk_comes_to_its_steepest_tilt_without_a_jump(steepest):
    x = np.concatenate([[-5.0], np.linspace(1.0, 2.0, 40), [4.0]])
    slopes = steepest * np.clip(x - 1.0, 0.0, 1.0)
    z = np.concatenate([[0.0], np.cumsum(0.5 * (slopes[1:] + slopes[:-1]) * np.diff(x))])
    pieces = zip(x[:-1], x[1:], z[:-1], z[1:], strict=True)
    ground = Ground.from_arrays(
        *quads(*([(a, -3, p), (b, -3, q), (b, 3, q), (a, 3, p)] for a, b, p, q in pieces))
    )
    line = np.column_stack([x[1:], np.zeros_like(x[1:]), z[1:]])
    line[0, 0], line[-1] = 0.0, 0.1 * line[-2] + 0.9 * line[-1]
    animal = animal_on(ground, line=line)
    animal.go_to(line[-1], 1.0)
    pitch = []

    def look():
        pitch.append(animal.herd.state[animal.index, at.PITCH])
        toes, stands = bone_toes(animal), animal.herd.standing_feet(animal.index)
        below = ground.surface_below(toes + np.array([0.0, 0.0, 0.05]))[0]
        assert np.abs(toes[:, 2] - below)[stands].max(initial=0.0) < 0.01

    run(animal, each=look)
    assert max(pitch) > 0.75  # steeper than the trunk likes
    assert np.abs(np.diff(pitch, 2)).max() / DT < 1.0  # rad/s between ticks


@pytest.mark.parametrize(
    ("ground", "top"),
    [(stairs(), 0.9), (Ground.from_arrays(*quads(floor(slope=0.45))), 0.45 * 6.0)],
    ids=["stairs", "slope"],
)
def test_feet_stand_on_the_real_ground(ground, top):
    line = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, top]])
    animal = animal_on(ground, line=line)
    animal.go_to(line[-1], 1.0)

    def look():
        toes = bone_toes(animal)
        stands = animal.herd.standing_feet(animal.index)
        below = ground.surface_below(toes + np.array([0.0, 0.0, 0.05]))[0]
        assert np.abs(toes[:, 2] - below)[stands].max(initial=0.0) < 0.01

    run(animal, each=look)
    assert animal.status == "arrived" and animal.front[2] == pytest.approx(top, abs=0.02)


def test_gaits_change_with_speed_and_diagonals_trot():
    herd, index, _ = follow(load_body("dog"), 2.0, np.array([[0.0, 0, 0], [15.0, 0, 0]]))
    seen, together = set(), []
    while not herd.resting(index):
        herd.tick()
        seen.add(int(herd.state[index, at.GAIT_NOW]))
        if herd.state[index, at.SPEED] > 1.98:
            down = herd.standing_feet(index)
            together.append(down[0] == down[3] and down[1] == down[2])
    assert seen == {0, 1}
    assert np.mean(together) > 0.7


def test_a_paw_ends_its_swing_as_it_began_it_when_the_gait_changes():
    herd, index, _ = follow(load_body("dog"), 2.0, np.array([[0.0, 0, 0], [15.0, 0, 0]]))
    state, phases, paces, swings, seen = herd.state[index], [], [], [], []
    while not herd.resting(index):
        swings.append(~herd.standing_feet(index))
        herd.tick()
        phases.append([leg_phase(state, leg) for leg in range(4)])
        paces.append(0.01 * state[at.FREQUENCY_NOW])
        seen.append(int(state[at.GAIT_NOW]))
    turned = np.diff(phases, axis=0) % 1.0 / np.array(paces)[1:, None]
    # of two ticks of one swing, against the clock
    within = np.array(swings)[1:-1] & np.array(swings)[2:]
    assert np.abs(np.diff(turned, axis=0))[within].max() < 1e-9
    assert turned.min() < 0.9  # some take longer
    # no foot stands longer for it, and they are in order within a second
    assert turned[~np.array(swings)[1:]].min() > 1.0 - 1e-9
    touchdown = np.array([herd.bodies[index].gaits["trot"].touchdown[leg] for leg in at.LEGS])
    settled = np.array(phases)[seen.index(1) + 100]
    apart = (settled - settled[0] + touchdown - touchdown[0] + 0.5) % 1.0 - 0.5
    assert np.abs(apart).max() < 0.01
    assert seen[-1] == 0


@pytest.mark.parametrize("degrees", [1.0, 3.0, 6.0, 15.0])
def test_the_front_is_on_the_path_from_the_first_step(degrees):
    turn = math.radians(degrees)
    animal = animal_on(plane())
    animal.go_to((3.0 * math.cos(turn), 3.0 * math.sin(turn), 0.0), 1.0)
    beside = []

    def look():
        if animal.speed > 0.0:
            x, y = animal.herd.front(animal.index)
            beside.append(abs(y * math.cos(turn) - x * math.sin(turn)))

    run(animal, each=look)
    assert max(beside) < 0.03


@pytest.mark.skipif(shared_folder() is None, reason=why_absent())
def test_its_own_rules_keep_its_path_on_the_ground():
    """Around this corner of a pit, cells twice as wide as the dog led over the void."""
    body = load_body("dog")
    terrain = navmesh.Terrain.load(level_path("nav_test"), up="y")
    graph = navmesh.NodeGraph.build(terrain, body.walk_rules(), obstacle_rules=None)
    route = graph.find_path((-8.9, -21.9, -2.4), (-5.6, -3.1, -2.4), radius=body.radius)
    points = smooth_route(route, body.smoothing).points
    ground = Ground.from_arrays(terrain.vertices, terrain.faces)
    assert np.abs(ground.surface_below(points + np.array([0.0, 0.0, 0.3]))[0] - points[:, 2]).max() < 0.1


@pytest.mark.parametrize("speed", [0.6, 1.2, 2.4])
def test_the_head_looks_a_time_ahead(speed):
    body = load_body("dog")
    herd, index, trail = follow(body, speed)
    fine = np.array([trail.point(arc) for arc in np.arange(0.0, trail.length + 2.0, 0.002)])
    tree = KDTree(fine)
    while not herd.state[index, at.STOPPING]:
        herd.tick()
        st = herd.state[index]
        here, seen = tree.query([herd.front(index), st[[at.LOOK_X, at.LOOK_Y]]])[1] * 0.002
        assert seen - here == pytest.approx(st[at.SPEED] * body.head.look_ahead, abs=0.006)


@pytest.mark.parametrize(
    ("speed", "far"), [(1.0, 3.0), (2.2, 6.0), (4.5, 14.0)], ids=["walk", "trot", "gallop"]
)
def test_stops_at_the_goal_facing_as_told(speed, far):
    for turn in (-0.8, 0.0, 0.6):
        animal = animal_on(plane(), yaw=0.3)
        animal.go_to((far, 1.0, 0.0), speed, facing=turn)
        run(animal)
        feet = animal.herd.toes(animal.index)
        front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
        assert np.linalg.norm(front - [far, 1.0]) < 0.02
        assert abs(wrap(math.atan2(*(front - rear)[::-1]) - turn)) < math.radians(2.0)
        assert isinstance(animal.events[-1], Arrived)


def test_a_stop_takes_the_distance_that_was_foretold():
    body = load_body("dog")
    for speed in (0.8, 2.0, 4.0):
        herd, index, _ = follow(body, speed, np.array([[-19.0, 0, 0], [19.0, 0, 0]]))
        for _ in range(300):
            herd.tick()
        begun, pace = herd.root(index)[0], herd.state[index, at.SPEED]
        assert pace == pytest.approx(speed, abs=0.1)
        herd.stop(index)
        for _ in range(500):
            herd.tick()
        assert herd.resting(index)
        assert herd.root(index)[0] - begun == pytest.approx(stopping_distance(body, pace), abs=1e-3)
    distances = [stopping_distance(body, speed) for speed in np.linspace(0.0, 5.0, 20)]
    assert np.all(np.diff(distances) > 0.0)


def test_turns_its_front_first_and_slides_its_rear_out_at_the_end():
    animal = animal_on(plane(), yaw=0.0)
    animal.go_to((2.0, 1.2, 0.0), 1.0)
    root = animal.position[:2].copy()
    for _ in range(25):
        animal.herd.tick()
        animal.tick()
    assert animal.position[:2] == pytest.approx(root) and animal.yaw > 0.2
    fronts = []
    run(animal, each=lambda: fronts.append((animal.speed, *animal.herd.front(animal.index))))
    last = np.array([row[1:] for row in fronts[-20:]])
    assert np.ptp(last, axis=0).max() < 1e-3
    assert animal.herd.place(animal.index).bend == pytest.approx(0.0, abs=1e-4)


def test_little_flex_needs_no_motion_of_its_own():
    animal = animal_on(plane())
    animal.go_to((3.0, 0.1, 0.0), 1.0)
    assert isinstance(animal.events[0], SetOff)


def test_a_flexible_body_bends_more():
    bends = {}
    for flex in (0.2, 1.3):
        dog = load_body("dog")
        body = dog.model_copy(update={"spine": dog.spine.model_copy(update={"flex": flex})})
        herd, index, _ = follow(body, 0.8)
        most = 0.0
        while not herd.resting(index):
            herd.tick()
            most = max(most, abs(herd.place(index).bend))
        bends[flex] = most
    assert bends[1.3] > 3.0 * bends[0.2]


def test_joint_speeds_do_not_jump():
    herd, index, _ = follow(load_body("dog"), 1.2)
    joints = []
    while not herd.resting(index):
        herd.tick()
        joints.append(herd.joints[index].copy())
    speeds = np.diff(np.unwrap(joints, axis=0), axis=0) / DT
    assert np.abs(np.diff(speeds, axis=0)).max() < 15.0  # rad/s between ticks, of swings at up to 25 rad/s


def test_what_cannot_be_followed_is_refused():
    body, ground = load_body("dog"), plane()
    for points, says in (
        ([[0, 0, 0]], "at least two points"), ([[0, 0, 0], [0, 0, 1]], "at least two points"),
        ([[0, 0, 0], [1, np.nan, 0]], "point 1 of the path"), ([[0, 0], [1, 0]], "shape"),
    ):  # fmt: skip
        with pytest.raises(LocomotionError, match=says):
            lay_trail(points, body, ground)
    herd = Herd(ground)
    with pytest.raises(LocomotionError, match="no ground within"):
        herd.add(body, (0.0, 0.0, 3.0), 0.0)
    index = herd.add(body, (0.0, 0.0, 0.0), 0.0)
    trail = lay_trail([[0, 0, 0], [3, 0, 0]], body, ground)
    with pytest.raises(LocomotionError, match="above 0 m/s"):
        herd.follow(index, trail, 0.0)
    with pytest.raises(LocomotionError, match="valid: walk"):
        herd.follow(index, trail, 1.0, gait="crawl")
    with pytest.raises(LocomotionError, match="in that direction"):
        herd.follow(index, trail, 1.0, start=2.0, end=1.0)


def test_stands_still_when_the_ground_goes():
    animal = animal_on(plane())
    animal.go_to((8.0, 0.0, 0.0), 1.0)
    for _ in range(250):
        animal.herd.tick()
        animal.tick()
    gone = Ground.from_arrays(*quads(floor(x1=3.5), floor(x0=6.0)))
    before = animal.position
    assert animal.herd.change_ground(gone).tolist() == [animal.index]
    steps = []
    for _ in range(300):
        animal.herd.tick()
        animal.tick()
        steps.append(animal.position[:2].copy())
    assert animal.status == "lost" and animal.speed == 0.0
    assert np.linalg.norm(np.diff(steps, axis=0), axis=1).max() < 0.02
    assert animal.front[0] < 3.5 and animal.position[0] >= before[0] - 1e-6
    assert not any(isinstance(event, MissedGoal) for event in animal.events)
