"""An entry of the registry that cannot work is refused when it is made."""

from dataclasses import replace

import pytest

from locomotion import LocomotionError
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.registry import register_skill


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"skill": "Jump"}, "skill 'Jump': expected up to 32 letters"),
        ({"status": " "}, "status ' ': expected a word such as 'jumping'"),
        ({"does": "jumps"}, "does 'jumps': expected a sentence"),
        ({"colour": "red"}, "colour 'red': expected '#rrggbb'"),
        ({"sizes": (0.7, 0.1)}, "expected 0 < least <= greatest"),
        ({"usual": 2.0}, "usual 2.0: expected a size from 0.1 to 0.7 m"),
        ({"may_touch": ("foot", "tail")}, "may_touch .*: expected some of .*foot, .*hand"),
        ({"obstacle": "jump"}, "must be a navmesh.ObstacleKind, not 'jump'"),
    ],
)
def test_a_kind_with_a_mistake_is_refused(change, message):
    with pytest.raises(LocomotionError, match=message):
        replace(JUMP, **change)


def test_a_name_or_a_status_that_is_taken_is_refused():
    with pytest.raises(LocomotionError, match="the name 'jump' is taken"):
        register_skill(JUMP)
