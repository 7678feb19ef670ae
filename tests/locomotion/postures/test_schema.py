"""The format of a posture file: what an arc is made of."""

import pytest
from pydantic import ValidationError

from locomotion.postures.schema import ArcEntry


@pytest.mark.parametrize(
    ("more", "is_right"),
    [
        ({"seconds": 0.5}, True),
        ({"motion": "bow.npz", "begin": 0.2}, True),
        ({"backwards": True}, True),
        ({}, False),
        ({"seconds": 0.5, "motion": "bow.npz"}, False),
        ({"seconds": 0.5, "backwards": True}, False),
        ({"motion": "bow.npz", "keys": [{"at": 0.5}]}, False),
        ({"seconds": 0.5, "keys": [{"at": 1.0}]}, False),
        ({"seconds": 61.0}, False),
    ],
)
def test_an_arc_is_made_in_one_of_three_ways(more, is_right):
    entry = {"from": "stand", "to": "bow", **more}
    if is_right:
        assert ArcEntry.model_validate(entry).standing_on == "left_foot"
    else:
        with pytest.raises(ValidationError):
            ArcEntry.model_validate(entry)
