"""The tail follows the pelvis: later, and to rest."""

import math

import numpy as np

from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from locomotion.quadruped.tail import hang_tail, swing_tail

CAT = load_body("cat")


def hung() -> np.ndarray:
    st = np.zeros(at.STATE)
    hang_tail(st, CAT.params())
    return st


def test_a_tail_at_rest_hangs_still():
    st = hung()
    before = st.copy()
    swing_tail(st, CAT.params(), 0.0, 0.0)
    assert np.abs(st - before).max() < 1e-12


def test_it_comes_after_a_turn_and_its_tip_last():
    st, turned = hung(), []
    for _ in range(300):
        swing_tail(st, CAT.params(), 0.5, 0.0)
        turned.append(0.5 + st[at.TAIL_YAW : at.TAIL_YAW + 3])
    turned = np.array(turned)
    halfway = [int(np.argmax(turned[:, k] > 0.25)) for k in range(3)]
    assert 2 < halfway[0] < halfway[1] < halfway[2] < 60
    assert np.abs(turned[-1] - 0.5).max() < 0.02


def test_a_full_turn_in_the_numbers_is_none():
    st = hung()
    swing_tail(st, CAT.params(), 2.0 * math.pi, 0.0)
    assert np.abs(st[at.TAIL_YAW : at.TAIL_YAW + 6]).max() < 1e-9
