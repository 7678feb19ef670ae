"""What there is to choose from."""

import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT
from locomotion.rehearsal.choices import (
    HASTES,
    REHEARSALS,
    RUN_UPS,
    SETTING_OFF,
    STEPPINGS,
    clears_in,
)


def test_variations_begin_with_none_and_grow():
    assert RUN_UPS[0] == (0.0, 0.0) and len(set(RUN_UPS)) == len(RUN_UPS)
    assert STEPPINGS[0] == (0.0, 0.0)
    sizes = [np.hypot(farther / 0.08, faster / 0.2) for farther, faster in RUN_UPS]
    assert np.all(np.diff(sizes) >= -1e-12)


def test_all_of_them_are_tried_for_one_decision_and_none_twice():
    for choices in (SETTING_OFF, HASTES):
        assert len(set(choices)) == len(choices) <= REHEARSALS


def test_who_has_room_begins_as_fast_as_it_walks_and_who_has_little_may_begin_faster():
    assert SETTING_OFF[0] == (True, (0.0, 0.0), 0.0)  # as without rehearsals
    assert {ahead for _, _, ahead in SETTING_OFF} == {0.0}
    assert 0.0 < max(ahead for _, _, ahead in HASTES) <= 0.5
    slower = [faster for _, (_, faster), _ in HASTES]
    assert -0.8 <= min(slower) < min(faster for _, (_, faster), _ in SETTING_OFF)


def test_a_farther_obstacle_takes_longer():
    assert clears_in(6.0) - clears_in(3.0) == pytest.approx(1.0 / CONTROL_DT)
