"""Changes of gait: the trunk keeps within what the gaits do at even speeds; `benchmarks.dog` tries more."""

import numpy as np
import pytest

from benchmarks.dog_gait_changes import FOAL, PLACES, Watch, compare
from locomotion.quadruped import Herd, lay_trail, load_body
from locomotion.quadruped import layout as at

PLACE = {place.name: place for place in PLACES}


@pytest.mark.parametrize(
    ("name", "place", "share", "degrees"),
    [
        ("dog", "flat", 0.005, 0.5), ("cat", "flat", 0.005, 0.5), ("horse", "flat", 0.01, 0.5),
        (str(FOAL), "curve", 0.02, 0.5), ("horse", "steep uphill", 0.04, 2.0), ("cat", "downhill", 0.04, 2.0),
    ],
)  # fmt: skip
def test_the_trunk_stays_within_its_gaits_when_they_change(name, place, share, degrees):
    found = compare(load_body(name), PLACE[place], quick=True, seed=61)
    assert found["height_off"] < share, found["worst_task"]
    assert found["pitch_off_deg"] < degrees
    assert found["lowest_bone"] > -1e-3 and found["slide"] < 1e-3
    if place == "flat":  # where it goes fastest
        assert found["joint_change"] < 1.1 * found["joint_change_steady"]
        assert found["joint_speed"] < 1.1 * found["joint_speed_steady"]


def test_a_trunk_that_sinks_is_seen():
    body = load_body("dog")
    herd = Herd(PLACE["flat"].ground(5.0))
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    watch = Watch(herd, 0.0)
    watch.look(np.array([True]))
    assert watch.low[0] == pytest.approx([0.42, 0.41, watch.low[0, 2]], abs=1e-6)
    herd.state[0, at.Z_REAR] -= 0.1
    herd.poses[:, 2] -= 0.5
    watch.look(np.array([True]))
    assert watch.low[0, 0] == pytest.approx(0.32) and watch.high[0, 0] == pytest.approx(0.42)
    assert watch.bone[0] < -0.4 and watch.slide[0] == pytest.approx(0.5)


def test_a_gait_that_is_asked_for_goes_no_faster_than_it_can():
    body, place = load_body("dog"), PLACE["flat"]
    ground = place.ground(30.0)
    herd, trail = Herd(ground), lay_trail(place.points(body, 30.0), body, ground)
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    herd.follow(0, trail, 6.0, gait="walk")
    for _ in range(300):
        herd.tick()
    assert herd.state[0, at.SPEED] == pytest.approx(body.gaits["walk"].up_to, abs=0.02)
