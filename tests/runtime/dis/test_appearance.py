"""Appearance bits, and what our statuses look like to others."""

import numpy as np
import pytest

from locomotion.skills.registry import CLEARING
from runtime.dis.appearance import POSTURES, Appearance, life_form_of
from runtime.dis.enumerations import ENTITY_TYPES, Health, LifeForm, Weapon, animal_of, is_life_form


def test_bits_come_back():
    for bits in np.random.default_rng(1).integers(0, 2**32, 200).tolist():
        kept = bits & 0x0FAF0018
        assert Appearance.of(bits).bits == kept
    assert Appearance(LifeForm.PRONE).bits == 5 << 16
    assert Appearance(deactivated=True, frozen=True).bits == 1 << 16 | 1 << 21 | 1 << 23
    assert Appearance(health=Health.FATAL, primary_weapon=Weapon.FIRING).bits == 3 << 3 | 1 << 16 | 3 << 24


@pytest.mark.parametrize(
    ("status", "speed", "before", "form"),
    [
        ("standing", 0.0, LifeForm.WALKING, LifeForm.STANDING),
        ("walking", 1.3, LifeForm.STANDING, LifeForm.WALKING),
        ("running", 2.0, LifeForm.WALKING, LifeForm.RUNNING),
        ("walking", 0.05, LifeForm.WALKING, LifeForm.STANDING),
        ("walking", 0.15, LifeForm.WALKING, LifeForm.WALKING),
        ("walking", 0.15, LifeForm.STANDING, LifeForm.STANDING),
        ("fallen", 0.0, LifeForm.RUNNING, LifeForm.PRONE),
        ("getting up", 0.0, LifeForm.PRONE, LifeForm.KNEELING),
        ("scrambling", 0.1, LifeForm.WALKING, LifeForm.CRAWLING),
    ],
)
def test_people_look_like_what_they_do(status, speed, before, form):
    assert life_form_of(status, speed, before, by_status=True) is form


def test_whoever_clears_an_obstacle_jumps():
    for status in CLEARING.values():
        assert life_form_of(status, 3.0, LifeForm.RUNNING, by_status=True) is LifeForm.JUMPING


def test_other_bodies_run_by_their_speed():
    """And do not change to and fro about it."""
    forms, form = [], LifeForm.STANDING
    for speed in (0.5, 2.1, 2.3, 2.0, 1.6, 1.4, 0.1):
        form = life_form_of("walking", speed, form, by_status=False)
        forms.append(form.name[0])
    assert "".join(forms) == "WWRRRWS"


def test_types_say_what_a_body_is():
    assert all(is_life_form(each[0]) for each in ENTITY_TYPES.values()) and not is_life_form(1)
    told = {name: animal_of(each[3], each[6]) for name, each in ENTITY_TYPES.items()}
    assert told == {"human": None, "walker": None, "dog": "dog", "cat": "cat", "horse": "horse"}
    assert animal_of(200, 77) == "dog" and set(POSTURES.values()) == {"kneel", "prone", "sit", "crouch"}
