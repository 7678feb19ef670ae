"""SpineFlex: the closed form, and that it brings the front onto the path."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.quadruped.spine import bend_for, brute_force_bend, chord, spine_points


@settings(deadline=None)
@given(st.integers(2, 16), st.floats(-1.5, 1.5))
def test_closed_form_is_the_brute_force(bones, angle):
    assert bend_for(angle, bones) == pytest.approx(brute_force_bend(angle, bones), abs=1e-9)


@settings(deadline=None)
@given(st.integers(2, 16), st.floats(-1.5, 1.5), st.floats(0.01, 1.0))
def test_the_spine_ends_in_the_wanted_direction_at_the_chord(bones, angle, bone):
    end = spine_points(float(bend_for(angle, bones)), bones, bone)[-1]
    assert math.atan2(end[1], end[0]) == pytest.approx(angle, abs=1e-9)
    assert np.linalg.norm(end) == pytest.approx(chord(bend_for(angle, bones), bones, bone), rel=1e-6)


def test_the_pentagon_of_four_bones():
    """Its interior angles: twice V less the first bone's turn, and three of a half turn less the bend."""
    angle = 0.4
    bend = bend_for(angle, 4)
    assert 2 * (angle - bend) + 3 * (math.pi - bend) == pytest.approx(3 * math.pi)
