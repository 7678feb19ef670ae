"""Gaits, and changes between them."""

import numpy as np

from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from locomotion.quadruped.gait import leg_phase
from tests.locomotion.quadruped.bends import follow


def test_gaits_change_with_speed_and_diagonals_trot():
    herd, index, _ = follow(load_body("dog"), 2.0, np.array([[0.0, 0, 0], [15.0, 0, 0]]))
    seen, together = set(), []
    while not herd.resting(index):
        herd.tick()
        seen.add(int(herd.state[index, at.GAIT_NOW]))
        if herd.state[index, at.SPEED] > 1.98:
            down = herd.standing_feet(index)
            together.append(down[0] == down[3] and down[1] == down[2])
    assert seen == {0, 1}
    assert np.mean(together) > 0.7


def test_a_paw_ends_its_swing_as_it_began_it_when_the_gait_changes():
    herd, index, _ = follow(load_body("dog"), 2.0, np.array([[0.0, 0, 0], [15.0, 0, 0]]))
    state, phases, paces, swings, seen = herd.state[index], [], [], [], []
    while not herd.resting(index):
        swings.append(~herd.standing_feet(index))
        herd.tick()
        phases.append([leg_phase(state, leg) for leg in range(4)])
        paces.append(0.01 * state[at.FREQUENCY_NOW])
        seen.append(int(state[at.GAIT_NOW]))
    turned = np.diff(phases, axis=0) % 1.0 / np.array(paces)[1:, None]
    # of two ticks of one swing, against the clock
    within = np.array(swings)[1:-1] & np.array(swings)[2:]
    assert np.abs(np.diff(turned, axis=0))[within].max() < 1e-9
    assert turned.min() < 0.9  # some take longer
    # no foot stands longer for it, and they are in order within a second
    assert turned[~np.array(swings)[1:]].min() > 1.0 - 1e-9
    touchdown = np.array([herd.bodies[index].gaits["trot"].touchdown[leg] for leg in at.LEGS])
    settled = np.array(phases)[seen.index(1) + 100]
    apart = (settled - settled[0] + touchdown - touchdown[0] + 0.5) % 1.0 - 0.5
    assert np.abs(apart).max() < 0.01
    assert seen[-1] == 0
