"""One body of a crowd: where it goes, how fast, and what it tells."""

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.body_events import Arrived, GotStuck, SetOff
from locomotion.crowd import Crowd
from locomotion.crowd.walker import NoRoute
from tests.locomotion.crowd.levels import hall, run


def test_a_walker_goes_straight_to_its_goal():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 5.0, 0.0))
    walker.go_to([(12.0, 5.0, 0.0)], speed=2.0, facing=1.0)
    run(crowd, 10.0)
    assert walker.status == "arrived"
    assert walker.position == pytest.approx([12.0, 5.0, 0.0], abs=0.16)
    assert walker.time == pytest.approx(10.0 / 2.0, abs=1.0)
    kinds = [type(event) for event in walker.events]
    assert kinds == [SetOff, Arrived]
    for _ in range(100):
        crowd.tick()
    assert walker.yaw == pytest.approx(1.0, abs=0.01)
    assert np.hypot(*walker.velocity) < 0.01


def test_speed_and_acceleration_are_kept():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 5.0, 0.0), acceleration=3.0)
    walker.go_to([(12.0, 5.0, 0.0)], speed=2.0)
    last = walker.velocity
    while walker.status == "walking":
        crowd.tick()
        assert np.hypot(*walker.velocity) <= 2.0 + 1e-9
        if walker.status == "walking":
            assert np.hypot(*(walker.velocity - last)) <= 3.0 * crowd.dt + 1e-9
        last = walker.velocity


def test_it_visits_the_places_on_its_way():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 2.0, 0.0))
    walker.go_to([(10.0, 8.0, 0.0), (3.0, 2.0, 0.0)])
    nearest = np.inf
    while walker.status == "walking":
        crowd.tick()
        nearest = min(nearest, float(np.hypot(*(walker.position[:2] - [10.0, 8.0]))))
    assert walker.status == "arrived" and nearest < 0.6


def test_one_whose_way_has_gone_is_stuck():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 5.0, 0.0))
    walker.go_to([(12.0, 5.0, 0.0)])
    crowd.routes.rows[crowd.routes.region(0)[0] + 1, :2] = 30.0, 5.0  # a corner off the surface
    run(crowd, 20.0)
    assert walker.status == "stuck" and isinstance(walker.events[-1], GotStuck)


def test_wrong_input_is_refused():
    crowd = Crowd(hall())
    with pytest.raises(LocomotionError, match="radius"):
        crowd.add((2.0, 5.0, 0.0), radius=0.0)
    with pytest.raises(LocomotionError, match="no room"):
        crowd.add((50.0, 5.0, 0.0))
    with pytest.raises(LocomotionError, match="acceleration"):
        crowd.add((2.0, 5.0, 0.0), acceleration=np.nan)
    with pytest.raises(LocomotionError, match="dt"):
        Crowd(hall(), dt=0.0)
    walker = crowd.add((2.0, 5.0, 0.0))
    with pytest.raises(NoRoute, match="off_graph"):
        walker.go_to([(50.0, 5.0, 0.0)])
    for goals in ([(np.nan, 0.0, 0.0)], (1.0, 2.0, 3.0), []):
        with pytest.raises(LocomotionError, match="goals"):
            walker.go_to(goals)
    with pytest.raises(LocomotionError, match="speed"):
        walker.go_to([(3.0, 5.0, 0.0)], speed=-1.0)
    assert walker.status == "standing" and not walker.events
