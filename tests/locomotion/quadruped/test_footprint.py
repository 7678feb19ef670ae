"""What a moving animal would touch."""

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import Place, check_script, local_motion
from locomotion.quadruped.footprint import key_balls, script_places
from tests.locomotion.quadruped.dead_ends import DOG
from tests.locomotion.quadruped.scenes import floor, plane, quads, wall


def test_a_wall_in_the_way_is_seen_and_named():
    ground = Ground.from_arrays(*quads(floor(), wall((1.2, -2.0), (1.2, 2.0))))
    move = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.6, 0.0, 0.0))
    found = check_script(move, DOG, ground)
    assert not found.free and found.part == "head" and found.place[0] == pytest.approx(1.2, abs=0.15)
    assert check_script(move, DOG, plane()).free


def test_an_edge_is_no_ground():
    ground = Ground.from_arrays(*quads(floor(x1=0.9)))
    move = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.8, 0.0, 0.0))
    assert check_script(move, DOG, ground).part == "ground"


def test_samples_are_as_close_as_they_say():
    script = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.3), (0.2, -0.5, 2.5))
    centres = key_balls(script_places(script, DOG), DOG).centres
    assert np.linalg.norm(np.diff(centres, axis=0), axis=2).max() <= 0.021


def test_what_passes_stays_clear_of_random_walls():
    rng = np.random.default_rng(4)
    passed = 0
    for _ in range(60):
        a, b = rng.uniform(-1.2, 1.2, (2, 2))
        ground = Ground.from_arrays(*quads(floor(), wall(a, b)))
        turn = float(rng.uniform(-3.0, 3.0))
        script = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (*rng.uniform(-0.4, 0.4, 2), turn))
        balls = key_balls(script_places(script, DOG), DOG)
        off = balls.centres[:, :, :2] - a
        share = np.clip(off @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        gap = (np.linalg.norm(off - share[..., None] * (b - a), axis=2) - balls.radii).min()
        found = check_script(script, DOG, ground)
        assert found.free == (gap >= 0.0)
        passed += found.free
    assert 5 < passed < 55
