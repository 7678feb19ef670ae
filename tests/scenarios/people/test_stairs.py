"""Walking up and down stairs, and flights of steps whose treads slope, at the pace that a person plans for
itself."""

import math
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from locomotion import Human
from locomotion.body.person import CONTROL_DT
from locomotion.gaits.walk.footholds import moved, rise_over_steps, risen, steps_ahead, tread_shift
from locomotion.gaits.walk.layout import (
    FOOTHOLD,
    GAINS,
    LIFT,
    LONGER,
    SWING_TIME,
    WALK_SPEED,
    WALK_STEPS,
    first_gains,
    new_walk,
)
from locomotion.ground.ground import Ground, extruded
from locomotion.human.state import MOVING, same
from locomotion.rehearsal.choices import REHEARSALS, STEPPINGS
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.trials import STAYS_UP, StepsOn, at_once
from tests.enough import enough

_STEPS, _RISE, _TREAD = 9, 0.12, 0.52  # number; [m] of each along the way: its front, and behind it
_LEVEL = 4.0  # [m] before and behind


def flight(slope, riser):
    """A flight that rises by ``slope`` in all, and its profile: the fronts of its steps are ``riser`` [m]
    high."""
    x, z = [-_LEVEL, 3.0], [0.0, 0.0]
    for _ in range(_STEPS):
        x += [x[-1] + _RISE, x[-1] + _RISE + _TREAD]
        z += [z[-1] + riser, z[-1] + slope * (_RISE + _TREAD)]
    x, z = np.array([*x, x[-1] + _LEVEL]), np.array([*z, z[-1]])
    return Ground.from_arrays(*extruded(np.column_stack([x, z]), 3.0)), x, z


def arrives(slope, riser, down, seed):
    ground, x, z = flight(slope, riser)
    start, y = np.random.default_rng(seed).uniform(-0.5, 0.5, 2)
    along = np.linspace(start, x[-1] - 1.5 + start, 60)
    way = np.column_stack([along, np.full(60, y), np.interp(along, x, z)])[:: -1 if down else 1]
    human = Human(ground, clearing=(), rehearsals=0)
    human.reset(way[0], math.pi if down else 0.0)
    human.follow(way, 1.25)
    while human.status in MOVING and human.time < 60.0:
        human.tick()
    return human.status == "arrived"


@pytest.mark.parametrize(("slope", "riser", "down"), [(0.42, 0.05, False), (0.36, 0.05, True)])
def test_goes_slowly_enough_on_a_steep_flight(slope, riser, down):
    """Who goes up at the pace of level ground falls nearly always."""
    assert enough((arrives(slope, riser, down, seed) for seed in range(12)), 8)


def stairs(riser, tread):
    """Seven steps up along x."""
    fronts = np.repeat(tread * np.arange(7), 2)
    x, z = np.concatenate([[-6.0], fronts, [12.0]]), np.repeat(riser * np.arange(8), 2)
    return Ground.from_arrays(*extruded(np.column_stack([x, z]), 3.0))


def about_to_walk_over(riser, tread, down, seed, rehearsals):
    start, aside = np.random.default_rng(seed).uniform((0.8, -0.2), (1.2, 0.2))
    along = np.arange(-start, 7.0 * tread + start, 0.25)
    height = riser * np.clip(np.floor(along / tread) + 1.0, 0.0, 7.0)
    way = np.column_stack([along, aside * along, height])[:: -1 if down else 1]
    human = Human(stairs(riser, tread), clearing=(), rehearsals=rehearsals)
    human.reset(way[0], math.atan2(*(way[1] - way[0])[[1, 0]]))
    human.follow(way, 1.0)
    return human


def walks_over(riser, tread, down, seed, rehearsals=0):
    human = about_to_walk_over(riser, tread, down, seed, rehearsals)
    while human.status in MOVING and human.time < 60.0:
        human.tick()
    return human.status == "arrived"


@pytest.mark.parametrize(
    ("riser", "tread", "down", "least"),
    [
        (0.15, 0.33, False, 9), (0.20, 0.27, False, 8), (0.12, 0.39, True, 7), (0.17, 0.29, True, 3),
    ],
)  # fmt: skip
def test_walks_over_stairs_as_people_build_them(riser, tread, down, least):
    """Who went as on level ground came up 5 of 20 flights with steps of 0.15 m and 2 of those of 0.17 m; who
    planned as if feet landed in time, and did not foresee the swing leg, came down 5 of 20 with steps of
    0.15 m by 0.3 m and 2 of 0.17 m."""
    assert enough((walks_over(riser, tread, down, seed) for seed in range(10)), least)


@pytest.mark.parametrize(("riser", "tread"), [(0.15, 0.30), (0.20, 0.27)])
@pytest.mark.parametrize("down", [False, True])
def test_who_rehearses_its_steps_does_not_fall_on_stairs(riser, tread, down):
    """Without, 9 of 20 come down those of 0.17 m and 1 of 20 those of 0.2 m."""
    assert all(walks_over(riser, tread, down, seed, REHEARSALS) for seed in range(3))


def disturb(human):
    """Two pushes, a change of pace, and one who is sent back to where it was."""
    pushed = human.ticks in range(450, 460) or human.ticks in range(612, 620)
    human.data.xfrc_applied[human.index.chest, 1] = 40.0 if pushed else 0.0
    if human.ticks in (500, 530):
        human.give_way(0.9 if human.ticks == 500 else 1.0, None)
    if human.ticks == 700:
        before = human.save_state()
        human.tick()
        human.restore_state(before)


@pytest.mark.parametrize("disturb", [None, disturb])
def test_it_decides_as_if_it_rehearsed_every_step_at_the_moment(monkeypatch, disturb):
    def hashes():
        human, seen = about_to_walk_over(0.17, 0.29, True, 0, REHEARSALS), []
        while human.status in MOVING and human.time < 40.0:
            human.tick()
            if disturb is not None:
                disturb(human)
            seen.append(human.state_hash())
        return seen

    foreseeing = hashes()
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: None)
    assert foreseeing == hashes()
    monkeypatch.setattr(Predicted, "comes_true", lambda *_: False)
    assert foreseeing == hashes()


def test_no_tick_bears_the_whole_rehearsal_of_a_step(monkeypatch):
    made, most, tick = [0], 0, Human._tick
    monkeypatch.setattr(Human, "_tick", lambda each: (made.append(1), tick(each)))
    human = about_to_walk_over(0.17, 0.29, True, 1, REHEARSALS)
    while human.status in MOVING:
        made.clear()
        human.tick()
        most = max(most, len(made))
    assert human.status == "arrived" and most <= 30


def test_what_is_known_is_not_simulated_again_except_on_another_ground(monkeypatch):
    """The best of three variations of a step is gone on with at a later step; it takes as long as before."""
    human, simulated, taken = about_to_walk_over(0.15, 0.30, False, 0, 0), [], []
    feet = human.on_feet
    while feet.walk[WALK_STEPS] < 6 or not (feet.on_uneven_ground and feet.begins_step):
        human.tick()
    steps_on, made, tick = StepsOn(), [], Human._tick
    monkeypatch.setattr(Human, "_tick", lambda each: (made.append(1), tick(each)))

    def tries(longer):
        state = human.save_state()
        human.vary_step(longer)
        trial, steps = steps_on(human), 0
        made.clear()
        while True:
            try:
                next(trial)
                steps += 1
            except StopIteration as end:
                human.restore_state(state)
                simulated.append(len(made))
                taken.append(steps)
                return end.value

    begun = human.ticks
    best = max((tries(longer) for longer in STEPPINGS[:3]), key=lambda outcome: outcome[0])
    assert simulated == [300, 300, 300]
    human.restore_state(best[1][-1])
    while not (feet.on_uneven_ground and feet.begins_step):
        human.tick()
    simulated.clear()
    went, seen = tries((0.0, 0.0))
    assert 20 < simulated[0] == human.ticks - begun < 300
    state = human.save_state()
    anew = at_once(StepsOn()(human))
    human.restore_state(state)
    assert (went, len(seen)) == (anew[0], len(anew[1]))
    assert all(same(one, other) for one, other in zip(seen, anew[1], strict=True))
    human.change_ground(stairs(0.15, 0.30))
    simulated.clear()
    tries((0.0, 0.0))
    assert simulated == [300] and set(taken) == {300}


def test_a_step_takes_as_much_longer_as_it_is_told_and_the_next_one_does_not():
    def times(longer):
        """[s] from the third touchdown to the fourth, and on to the fifth."""
        human, down = Human(None, clearing=(), rehearsals=0), []
        human.reset((0, 0, 0), 0.0)
        human.follow([[0, 0, 0], [9, 0, 0]], 0.8)
        walk = human.on_feet.walk
        while len(down) < 5:
            before = walk[WALK_STEPS]
            human.tick()
            if walk[WALK_STEPS] > before:
                down.append(human.time)
                if len(down) == 3:
                    walk[LONGER] = longer
        assert not walk[LONGER].any()
        return np.diff(down[2:])

    usual = times((0.0, 0.0))
    assert times((0.05, 0.0))[0] == pytest.approx(usual[0] + 0.05, abs=0.021)
    assert times((0.0, 0.08))[0] == pytest.approx(usual[0] + 0.08, abs=0.031)
    assert times((0.0, 0.08))[1] < usual[1] + 0.04


class Stepping:
    """A body that walks at 0.5 m/s, falls after some ticks, makes some headway, or steps on where it is to
    stand."""

    events: ClassVar[list] = []
    model, held = None, False

    def __init__(self, falls=math.inf, headway=0.5, status="walking", rests=math.inf):
        self.ticks, self.falls, self.headway, self.status, self.rests = 0, falls, headway, status, rests
        self.decider = SimpleNamespace(undecided=False)
        walk = new_walk()
        walk[WALK_SPEED] = 0.5
        self.on_feet, self.follower = SimpleNamespace(walks=True, walk=walk), SimpleNamespace(remaining=5.0)

    def tick(self):
        self.ticks += 1
        self.follower.remaining -= self.headway * CONTROL_DT
        self.held = self.ticks >= self.rests
        if self.ticks >= self.falls:
            self.status = "fallen"

    def save_state(self):
        return SimpleNamespace(ticks=self.ticks, status=self.status, walk=self.on_feet.walk)


def test_how_well_steps_go():
    """Well, with little headway, back, restless, resting, and falling late and soon."""
    well, little, back, restless, rests, late, soon = (
        at_once(StepsOn()(body))[0]
        for body in (
            Stepping(), Stepping(headway=0.05), Stepping(headway=-0.5), Stepping(status="arrived"),
            Stepping(status="arrived", rests=120), Stepping(falls=250), Stepping(falls=50),
        )
    )  # fmt: skip
    assert well == rests == 1.0
    assert STAYS_UP == restless == back < little < 1.0
    assert 0.0 < soon < late < STAYS_UP


def test_what_is_seen_ends_where_something_else_is_to_be_decided_or_it_falls():
    for falls, undecided, known in ((math.inf, 120, 119), (60, math.inf, 59)):
        body = Stepping(falls=falls)

        def tick(body=body, tick=body.tick, undecided=undecided):
            tick()
            body.decider.undecided = body.ticks == undecided

        body.tick = tick
        assert [state.ticks for state in at_once(StepsOn()(body))[1]] == list(range(1, known + 1))


@pytest.mark.parametrize(("riser", "tread"), [(0.12, 0.39), (0.17, 0.29), (0.2, 0.27)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_foot_is_put_on_one_tread(riser, tread, way):
    """Its whole sole, by the ground's own heights, and one step up or down at most."""
    ground, walk = stairs(riser, tread), new_walk()
    walk[SWING_TIME] = 0.4
    for wished in np.linspace(0.1, 0.42, 17):
        stance = np.array([3.5 * tread, 0.1, 4.0 * riser])
        shift = tread_shift(first_gains(), ground.lookup, walk, stance, way, 0.0, wished, -0.2)
        along = stance[0] + way * (wished + shift)
        sole = np.column_stack(
            [along + way * np.linspace(-0.08, 0.12, 41), np.full(41, 0.1), np.full(41, 5.0)]
        )
        heights = ground.surface_below(sole)[0]
        assert np.ptp(heights) < 1e-9 and abs(heights[0] - stance[2]) < riser + 1e-9
        assert abs(shift) <= 0.22


def test_steps_are_seen_and_ramps_and_walls_are_not():
    here = np.array([-0.55, 0.0, 0.0])
    assert steps_ahead(stairs(0.15, 0.3).lookup, here, 1.0, 0.0) == pytest.approx(0.15 / 0.8)
    assert steps_ahead(stairs(0.15, 0.3).lookup, here + np.array([0.3, 0.0, 0.0]), 1.0, 0.0) == pytest.approx(
        0.3 / 0.8
    )
    assert steps_ahead(stairs(0.15, 0.3).lookup, here, -1.0, 0.0) == 0.0
    assert steps_ahead(stairs(0.5, 0.3).lookup, here, 1.0, 0.0) == 0.0
    corners = np.array([[-5, -5, -1.5], [5, -5, 1.5], [5, 5, 1.5], [-5, 5, -1.5]])
    ramp = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]])
    assert steps_ahead(ramp.lookup, np.zeros(3), 1.0, 0.0) == 0.0


@pytest.mark.parametrize(("riser", "tread"), [(0.12, 0.39), (0.17, 0.29)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_foot_swings_over_the_edges_of_steps(riser, tread, way):
    ground, walk, gains = stairs(riser, tread), new_walk(), first_gains()
    clearance = gains[list(GAINS).index("clearance")]
    at = tread * (np.array([2.5, 4.5])[:: int(way)]) - 0.02 * way
    walk[LIFT], walk[FOOTHOLD] = [[x, 0.0, riser * (math.floor(x / tread) + 1)] for x in at]
    hump = rise_over_steps(gains, ground.lookup, walk, way, 0.0)
    for share in np.arange(0.3, 0.81, 0.1):
        x = at[0] + moved(share) * (at[1] - at[0])
        z = walk[LIFT][2] + risen(share, walk[FOOTHOLD][2] - walk[LIFT][2])
        z += (clearance + hump) * math.sin(math.pi * share)
        sole = [[x + way * u, 0.0, 5.0] for u in (-0.08, 0.0, 0.12)]
        assert z > ground.surface_below(np.array(sole))[0].max() + 0.01
