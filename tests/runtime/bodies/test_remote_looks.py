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


def test_others_are_refused():
    with pytest.raises(RuntimeInputError, match="'dragon': valid: human"):
        look_of("dragon")
