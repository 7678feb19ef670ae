"""Figures are drawn as posing has them, body by body."""

import numpy as np
import pytest

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.recorded.posing import posed_slowly, whole_figures
from locomotion.recorded.skeletons import LEVELS, skeleton
from locomotion.recorded_people.drawing import drawn


@pytest.mark.parametrize("level", LEVELS)
def test_all_bodies_are_where_posing_has_them_in_the_order_of_the_model(level):
    rng, bones = np.random.default_rng(1), skeleton(level)
    channels, roots = rng.uniform(-1.0, 1.0, (3, len(bones.channels))), rng.normal(size=(3, 7))
    roots[:, 3:] /= np.linalg.norm(roots[:, 3:], axis=1, keepdims=True)
    wanted = whole_figures(bones, posed_slowly(bones, channels, roots))
    model = figure()
    for k, place in enumerate(np.swapaxes(drawn(level, channels, roots), 0, 1)):
        there = wanted[:, BODY_NAMES.index(model.body(1 + k).name)]
        there[:, 3:] *= np.sign((there[:, 3:] * place[:, 3:]).sum(axis=1, keepdims=True))
        np.testing.assert_allclose(place, there, atol=1e-9)
