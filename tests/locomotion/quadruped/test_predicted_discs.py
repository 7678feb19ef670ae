"""What others are told of an animal that goes on as it does comes true."""

import numpy as np
import pytest

from locomotion.avoidance.yielding import COUNT, STEP
from locomotion.quadruped import Herd, Place, load_body, local_motion
from locomotion.quadruped.motion import DT
from locomotion.quadruped.predicted_discs import DISCS, between_feet, disc_radius, foretell_script, nobody
from tests.locomotion.quadruped.bends import follow
from tests.locomotion.quadruped.scenes import plane

DOG = load_body("dog")
TICKS = round(STEP / DT)


def discs_of(herd, index):
    return herd.discs()[DISCS * index : DISCS * (index + 1), :2]


@pytest.mark.parametrize("stops", [False, True])
def test_on_a_trail_it_is_where_it_was_foretold(stops):
    herd, index, _ = follow(DOG, 1.2)
    for _ in range(150):
        herd.tick()
    if stops:
        herd.stop(index)
    foretold = herd.foretold(index)
    assert foretold.shape == (COUNT, DISCS, 2)
    for step in range(20):
        assert np.abs(discs_of(herd, index) - foretold[step]).max() < 0.02, step
        for _ in range(TICKS):
            herd.tick()
    assert np.ptp(foretold[-5:], axis=0).max() < (1e-6 if stops else 10.0)


def test_a_script_is_foretold_from_its_first_moment():
    herd = Herd(plane())
    index = herd.add(DOG, (0.0, 0.0, 0.0), 0.3)
    script = local_motion(DOG).script(herd.place(index), (0.4, 0.2, 0.8))
    foretold = foretell_script(script, DOG)
    herd.play(index, script)
    for step in range(COUNT):
        assert np.abs(discs_of(herd, index) - foretold[step]).max() < 0.02, step
        for _ in range(TICKS):
            herd.tick()
    end = script.end()
    assert foretold[-1, 0] == pytest.approx([end.x, end.y]) and foretold[-1, -1] == pytest.approx(
        end.front(DOG)
    )


def test_discs_lie_from_the_rear_to_the_front_feet_and_touch_each_other():
    place = Place(1.0, 2.0, 0.0, 0.5)
    rear, front = np.array([[1.0, 2.0]]), np.array([place.front(DOG)])
    discs = between_feet(rear, front)[0]
    assert discs[0] == pytest.approx(rear[0]) and discs[-1] == pytest.approx(front[0])
    apart = np.linalg.norm(np.diff(discs, axis=0), axis=1)
    for name in ("dog", "cat", "horse"):
        body = load_body(name)
        assert disc_radius(body) >= max(body.radius, 0.5 * body.spine.length / (DISCS - 1))
    assert apart == pytest.approx(0.5 * DOG.spine.length)


def test_around_one_that_is_alone_there_is_nobody():
    places, radii = nobody()
    assert places.shape == (COUNT, 0, 2) and radii.shape == (0,)


def test_discs_of_several_are_those_of_each():
    herd = Herd(plane())
    bodies = [load_body(name) for name in ("dog", "horse", "cat")]
    for number, body in enumerate(bodies):
        herd.add(body, (4.0 * number, 1.0, 0.0), 0.4 * number)
    herd.play(0, local_motion(DOG).script(herd.place(0), (0.4, 0.2, 0.8)))
    for _ in range(40):
        herd.tick()
    for index, body in enumerate(bodies):
        place, mine = herd.place(index), herd.discs()[DISCS * index : DISCS * (index + 1)]
        centres = between_feet(np.array([[place.x, place.y]]), herd.front(index)[None])[0]
        assert np.array_equal(mine[:, :2], centres) and (mine[:, 2] == place.z).all()
        assert (mine[:, 5] == disc_radius(body)).all()
        assert (mine[:, 3:5].any(axis=1) == (index == 0)).all()  # only the first moves
