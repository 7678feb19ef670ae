"""What touches the level: hands near it, and feet that have sunk in."""

import numpy as np
import pytest

from locomotion.body.person import BODY_NAMES
from locomotion.characters.contacts import contacts_with, no_contacts
from tests.locomotion.characters.persons import plane, postures


def test_a_hand_counts_the_more_the_nearer_it_is():
    place = postures()["all-fours"]
    found = []
    for height in np.linspace(0.0, 0.3, 40):
        lifted = place.copy()
        lifted[:, 2] += height
        found.append(contacts_with(plane(), lifted[None]).hands[0])
    hands = np.array(found)
    assert hands[0].min() > 0.95 and hands[-1].max() == 0.0
    assert (np.diff(hands, axis=0) <= 1e-12).all() and np.abs(np.diff(hands, axis=0)).max() < 0.15


@pytest.mark.parametrize("deep", [0.0, 0.01, 0.04])
def test_feet_that_have_sunk_in(deep):
    place = postures()["stand"].copy()
    place[:, 2] -= deep
    found = contacts_with(plane(), place[None])
    np.testing.assert_allclose(found.sunk, deep, atol=2e-3)
    np.testing.assert_allclose(found.near, 1.0, atol=0.01)
    np.testing.assert_allclose(found.normals[0], [[0, 0, 1], [0, 0, 1]], atol=1e-12)


def test_nothing_is_known_off_the_level_or_without_one():
    place = postures()["stand"].copy()
    place[:, 0] += 500.0
    found = contacts_with(plane(), place[None])
    assert found.near.max() == found.sunk.max() == found.hands.max() == found.loads.max() == 0.0
    assert no_contacts(3).loads.min() == 1.0 and no_contacts(3).near.max() == 0.0
    assert len(BODY_NAMES) == 20
