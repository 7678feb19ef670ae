"""Turning on the spot."""

from locomotion import Ground
from locomotion.quadruped import Place, load_body
from locomotion.quadruped.turning import turn_script
from tests.locomotion.quadruped.scenes import floor, quads


def test_a_long_body_without_room_is_not_turned():
    horse, place = load_body("horse"), Place(0.0, 0.0, 0.0, 0.0)
    lane = Ground.from_arrays(*quads(floor(x0=-1.5, x1=3.0, y0=-0.6, y1=0.6)))
    for yaw in (-3.0, -2.0, -1.2, 1.2, 2.0, 3.0):
        assert turn_script(horse, lane, place, yaw) is None
