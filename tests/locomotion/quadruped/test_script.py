"""Motions that are played from a table."""

import numpy as np
import pytest

from locomotion.quadruped import Place
from locomotion.quadruped import layout as at
from locomotion.quadruped.script import into_flex
from tests.locomotion.quadruped.dead_ends import DOG


def test_into_flex_moves_the_front_alone():
    place = Place(1.0, 2.0, 0.0, 0.4)
    script = into_flex(DOG, place, 0.1)
    assert np.ptp(script.rows[:, [at.SX, at.SY, at.SYAW]], axis=0).max() == 0.0
    assert script.end().bend == pytest.approx(0.1)
