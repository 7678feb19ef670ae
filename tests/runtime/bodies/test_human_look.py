"""A person that physics takes over looks as before, and ever more as it is."""

import numpy as np
import pytest

from locomotion import Human
from locomotion.errors import LocomotionError
from locomotion.human.sized_human import SizedHuman
from runtime.bodies.human_look import Fading, HumanLook


@pytest.fixture
def body():
    made = SizedHuman(Human(rehearsals=0), 0.9)
    made.reset(np.zeros(3), 0.0)
    return made


def test_a_look_fades_into_the_pose(body):
    look = HumanLook(body)
    other = body.pose()
    other[10] += 0.3
    look.fade(other, np.zeros(45))
    np.testing.assert_allclose(look.pose(), other, atol=1e-6)
    off = [0.3]
    for _ in range(150):
        body.tick(since_foresees=False)
        off.append(abs(float((look.pose() - body.pose())[10])))
    assert off[10] > 0.01 and off[-1] == 0.0
    assert max(np.diff(off)) < 0.02


def test_between_ticks_it_looks_like_something_between(body):
    look = HumanLook(body)
    assert look.pose_between(0.5).tolist() == look.pose().tolist()
    body.follow(np.array([(0.0, 0.0, 0.0), (8.0, 0.0, 0.0)]), 1.2)
    for _ in range(300):
        look.remember()
        body.tick(since_foresees=False)
    begin, end, middle = look.pose_between(0.0)[0], look.pose_between(1.0)[0], look.pose_between(0.5)[0]
    assert begin < end and middle == pytest.approx(0.5 * (begin + end), abs=1e-4)
    assert end == pytest.approx(look.pose()[0])


def test_what_no_pose_does_is_refused():
    Fading(np.zeros(45), np.zeros(45), 0.3, 1.0).check()
    for wrong in (Fading(np.zeros(44), np.zeros(45), 0.3, 1.0), Fading(np.zeros(45), np.zeros(45), 0.0, 1.0)):
        with pytest.raises(LocomotionError):
            wrong.check()
