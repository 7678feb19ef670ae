"""Short moves, footprints, dead ends, many at once, and going on from a saved state."""

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import Animal, Herd, Place, check_places, check_script, lay_trail, local_motion
from locomotion.quadruped import layout as at
from locomotion.quadruped.footprint import at_place
from locomotion.quadruped.manoeuvres import find_manoeuvre, joined
from tests.locomotion.quadruped.dead_ends import DOG, GraphPlanner, dead_end
from tests.locomotion.quadruped.scenes import run


def test_without_crumbs_it_finds_its_way_out_by_short_moves():
    vertices, faces = dead_end(0.5)
    herd = Herd(Ground.from_arrays(vertices, faces))
    animal = Animal(herd, herd.add(DOG, (0.9, 0.0, 0.0), 0.0), GraphPlanner(vertices, faces))
    animal.go_to((-3.0, 0.5, 0.0), 1.0)
    free = []

    def look():
        place = herd.place(animal.index)
        free.append(check_places(at_place(place), DOG, herd.ground).free)

    run(animal, each=look)
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(-3.0, abs=0.02)
    assert all(free)


def test_a_manoeuvre_ends_where_the_way_leads_on_and_touches_nothing():
    vertices, faces = dead_end(0.5)
    ground, place = Ground.from_arrays(vertices, faces), Place(0.9, 0.0, 0.0, 0.0)
    trail = lay_trail([[0.9, 0.0, 0.0], [-3.0, 0.0, 0.0]], DOG, ground)
    asked = []

    def leads_on(there):
        asked.append(there)
        return there.x < -0.5

    script = find_manoeuvre(DOG, ground, place, trail, leads_on)
    assert check_script(script, DOG, ground).free
    assert script.end() == asked[-1] and script.end().x < -0.5
    assert np.allclose(script.rows[0, :4], [place.x, place.y, place.z, place.yaw])
    assert find_manoeuvre(DOG, ground, place, trail, lambda there: False) is None


def test_joined_scripts_play_one_after_the_other():
    first = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.4, 0.0, 0.0))
    second = local_motion(DOG).script(first.end(), (0.0, 0.2, 0.5))
    both = joined([first, second])
    assert both.seconds == pytest.approx(first.seconds + second.seconds, abs=0.03)
    assert both.end() == second.end()
    half = round(first.seconds / both.seconds * (len(both.rows) - 1))
    assert both.rows[half, [at.SX, at.SY]] == pytest.approx([first.end().x, first.end().y], abs=0.01)
    assert np.linalg.norm(np.diff(both.rows[:, [at.SX, at.SY]], axis=0), axis=1).max() < 0.03
