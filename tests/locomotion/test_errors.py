"""Wrong input to this package: caught by the package's own class, or with the others by the common one."""

import numpy as np
import pytest

from locomotion import Human, load_run_skill, unregister_skill
from locomotion.clips.clip import load_clip
from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground
from locomotion.quadruped import load_body
from navmesh import NavmeshError
from surefoot.errors import SurefootError

WRONG = {
    "a missing clip": lambda: load_clip("none.yaml"),
    "a missing skill": lambda: load_run_skill("none.npz"),
    "a missing body": lambda: load_body("none.yaml"),
    "a ground without faces": lambda: Ground.from_arrays(np.zeros((3, 3)), np.zeros((0, 3), int)),
    "a speed": lambda: Human().follow([[0, 0, 0], [5, 0, 0]], -1.0),
    "an unknown skill kind": lambda: unregister_skill("climb"),
}


@pytest.mark.parametrize("what", WRONG)
def test_wrong_input_is_told_from_that_to_other_packages(what):
    with pytest.raises(SurefootError) as told:
        WRONG[what]()
    assert isinstance(told.value, LocomotionError) and not isinstance(told.value, NavmeshError)
    assert "\n" not in str(told.value)
