"""Bodies as data: what ships, and what is refused with which words."""

import numpy as np
import pytest

import navmesh
from benchmarks.shared_data import level_path, shared_folder, why_absent
from locomotion import Ground, LocomotionError, smooth_route
from locomotion.data import BODIES
from locomotion.quadruped import BODY_NAMES, load_body
from locomotion.quadruped import layout as at


@pytest.mark.parametrize("name", BODY_NAMES)
def test_what_ships_is_complete(name):
    body = load_body(name)
    assert body.name == name and {"walk", "trot", "gallop"} <= set(body.gaits)
    assert np.isfinite(body.params()).all() and body.gait_rows().shape == (len(body.gaits), at.GAIT)
    assert body.radius == body.shoulder_width / 2


def test_dog_cat_and_horse_differ():
    dog, cat, horse = (load_body(name) for name in BODY_NAMES)
    assert cat.length < dog.length < horse.length
    assert horse.spine.flex < dog.spine.flex < cat.spine.flex


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("length: 0.44, bones: 4", "length: 0.50, bones: 4", "4 bones of 0.11 m make 0.44 m, the spine 0.5"),
        ("upper: 0.18, lower: 0.20", "upper: 0.08, lower: 0.10", "too short for a height of 0.41"),
        ("shoulder_width: 0.24", "shoulder_width: 0.10", "wider than the shoulders"),
        ("rear_left: 0.0, front_left: 0.25,", "rear_left: 0.0,", "touchdown lacks front_left"),
        ("up_to: 1.35", "up_to: 3.5", "from slow to fast"),
        ("frequency: [0.97, 0.62]", "frequency: [0.97, -0.98]", "frequency at 1.35 m/s"),
        ("flex: 1.0", "flex: .nan", "finite"),
        ("spine:", "spin:", "did you mean"),
        ("max_bend_deg: 15", "max_bend_deg: 55", "close to a ring"),
    ],
)
def test_a_body_that_does_not_add_up_is_refused(tmp_path, old, new, says):
    text = (BODIES / "dog.yaml").read_text()
    assert old in text
    path = tmp_path / "mutt.yaml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(LocomotionError, match=r"mutt\.yaml:[0-9]+:[0-9]+: ") as caught:
        load_body(path)
    assert says in str(caught.value)


def test_an_unknown_body_and_gait_name_the_valid_ones():
    with pytest.raises(LocomotionError, match="valid: dog, cat, horse"):
        load_body("unicorn")
    with pytest.raises(LocomotionError, match="valid: walk, trot, gallop, pace"):
        load_body("dog").gait_index("moonwalk")


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
