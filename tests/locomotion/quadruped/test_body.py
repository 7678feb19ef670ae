"""Bodies as data: what ships, and what is refused with which words."""

import numpy as np
import pytest

from locomotion import LocomotionError
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
