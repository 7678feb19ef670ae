"""Gaits as data: what is taken for a back that nothing is said of, and what is refused."""

import math

import pytest

from locomotion import LocomotionError
from locomotion.data import BODIES
from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body


def without_backs(tmp_path):
    lines = (BODIES / "dog.yaml").read_text().splitlines()
    path = tmp_path / "plain.yaml"
    path.write_text("\n".join(line for line in lines if not line.strip().startswith("back:")))
    return path


def test_a_back_that_nothing_is_said_of_flexes_in_the_gallop(tmp_path):
    plain = load_body(without_backs(tmp_path))
    supple = plain.spine.bones * plain.spine.max_bend_deg
    flexion = {name: gait.flexion(supple)[0] for name, gait in plain.gaits.items()}
    assert flexion["walk"] == flexion["trot"] == pytest.approx(5.0)
    assert 0.8 * 0.5 * supple < flexion["gallop"] < 0.5 * supple
    stiff = plain.gaits["gallop"].flexion(4.0)
    assert stiff == pytest.approx((5.0, 0.0))


def test_ranges_come_to_the_kernels_in_radians():
    row = load_body("dog").gaits["walk"].row(60.0)
    back = load_body("dog").gaits["walk"].back
    assert row[at.HIP_ROLL] == pytest.approx(math.radians(back.hip_roll_deg))
    assert row[at.FLEXION] == pytest.approx(math.radians(back.flexion_deg[0]))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("flexion_deg: [19, 3.2]", "flexion_deg: [19, 12.5]", "back.flexion_deg at 8 m/s is outside 0 to 90"),
        ("flexion_deg: [19, 3.2]", "flexion_deg: [19, -3.2]", "back.flexion_deg at 8 m/s is outside 0 to 90"),
        ("hip_roll_deg: 12.6", "hip_roll_deg: 99", "45"),
        ("nod_deg", "nods_deg", "did you mean"),
        ("sacral: 0.25", "sacral: 1.25", "1"),
        ("look_deg: 50", "look_deg: -5", "0"),
    ],
)
def test_a_back_that_cannot_be_is_refused(tmp_path, old, new, says):
    text = (BODIES / "dog.yaml").read_text()
    assert old in text
    path = tmp_path / "mutt.yaml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(LocomotionError, match=r"mutt\.yaml:[0-9]+:[0-9]+: ") as caught:
        load_body(path)
    assert says in str(caught.value)
