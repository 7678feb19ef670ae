"""Looks of remote figures."""

import numpy as np
import pytest

from runtime import RuntimeInputError
from runtime.bodies.remote_figures import REMOTE
from runtime.bodies.remote_looks import look_of


@pytest.mark.parametrize("name", ["human", "dog", "cat", "horse", "thing"])
def test_every_look_has_a_figure(name):
    look = look_of(name)
    assert look is look_of(name) and look.radius > 0.0 and look.is_person == (name == "human")
    if look.is_person:
        return
    row = np.zeros((), REMOTE)
    row["place"], row["heading"] = (1.0, 2.0, 3.0), np.pi / 2
    posed = look.posed(row)
    assert posed.shape == (len(look.figure.bodies), 7)
    ahead = posed[:, :3] - [1.0, 2.0, 3.0]
    assert np.allclose(ahead[:, 0], -look.stands[:, 1]) and np.allclose(ahead[:, 1], look.stands[:, 0])


@pytest.mark.parametrize("name", ["dog", "horse"])
def test_animals_set_one_foot_before_the_other(name):
    """Of a foot that bears the ankle moves at less than half of the speed."""
    look = look_of(name)
    assert look.goes is not None and 0.3 < look.stride < 3.0
    feet = [k for k, body in enumerate(look.figure.bodies) if body.endswith("_foot")]
    ways = np.arange(len(look.goes)) / len(look.goes) * look.stride
    places = look.goes[:, feet, 0] + ways[:, None]
    speeds = np.abs(np.diff(places, axis=0))
    assert np.percentile(speeds.min(axis=1), 50) < 0.5 * look.stride / len(look.goes)
    assert np.ptp(look.goes[:, feet, 2], axis=0).min() > 0.02
    row = np.zeros((), REMOTE)
    row["pace"], row["phase"] = 1.5, 0.25
    assert np.abs(look.posed(row) - look.stands).max() > 0.03


def test_others_are_refused():
    with pytest.raises(RuntimeInputError, match="'dragon': valid: human"):
        look_of("dragon")
