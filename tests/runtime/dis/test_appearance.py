"""Appearance bits, and what our statuses look like to others."""

from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.skills.registry import CLEARING
from runtime.bodies.registry import body_names, kind_of
from runtime.bodies.remote_looks import animal_of
from runtime.dis.appearance import POSTURES, Appearance, appearance_of, life_form_of
from runtime.dis.enumerations import Health, LifeForm, Weapon, is_life_form


def test_bits_come_back():
    for bits in np.random.default_rng(1).integers(0, 2**32, 200).tolist():
        kept = bits & 0x0FAF0018
        assert Appearance.of(bits).bits == kept
    assert Appearance(LifeForm.PRONE).bits == 5 << 16
    assert Appearance(deactivated=True, frozen=True).bits == 1 << 16 | 1 << 21 | 1 << 23
    assert Appearance(health=Health.FATAL, primary_weapon=Weapon.FIRING).bits == 3 << 3 | 1 << 16 | 3 << 24


@pytest.mark.parametrize(
    ("status", "posture", "speed", "before", "form"),
    [
        ("standing", "stand", 0.0, LifeForm.WALKING, LifeForm.STANDING),
        ("walking", "stand", 1.3, LifeForm.STANDING, LifeForm.WALKING),
        ("running", "stand", 3.0, LifeForm.WALKING, LifeForm.RUNNING),
        ("walking", "stand", 0.05, LifeForm.WALKING, LifeForm.STANDING),
        ("walking", "stand", 0.15, LifeForm.WALKING, LifeForm.WALKING),
        ("walking", "stand", 0.15, LifeForm.STANDING, LifeForm.STANDING),
        ("fallen", "stand", 0.0, LifeForm.RUNNING, LifeForm.PRONE),
        ("getting up", "stand", 0.0, LifeForm.PRONE, LifeForm.KNEELING),
        ("scrambling", "stand", 0.1, LifeForm.WALKING, LifeForm.CRAWLING),
        ("standing", "kneel", 0.0, LifeForm.STANDING, LifeForm.KNEELING),
        ("standing", "dead", 0.0, LifeForm.STANDING, LifeForm.PRONE),
    ],
)
def test_people_look_like_what_they_do(status, posture, speed, before, form):
    assert life_form_of(status, posture, speed, before) is form


def test_whoever_clears_an_obstacle_jumps():
    for status in CLEARING.values():
        assert life_form_of(status, "stand", 3.0, LifeForm.RUNNING) is LifeForm.JUMPING


def test_they_do_not_change_to_and_fro():
    forms, form = [], LifeForm.STANDING
    for speed in (0.5, 2.1, 2.3, 2.0, 1.6, 1.4, 0.1):
        form = life_form_of("walking", "stand", speed, form)
        forms.append(form.name[0])
    assert "".join(forms) == "WWRRRWS"


@pytest.mark.parametrize(
    ("posture", "held", "looks"),
    [
        ("prone", ("rifle", "in use"), (LifeForm.PRONE, Health.NO_INJURY, Weapon.FIRING)),
        ("kneel", ("rifle", "deployed"), (LifeForm.KNEELING, Health.NO_INJURY, Weapon.DEPLOYED)),
        ("dead", ("", "stowed"), (LifeForm.PRONE, Health.FATAL, Weapon.NONE)),
    ],
)
def test_postures_and_things_in_hands_are_told(posture, held, looks):
    agent = SimpleNamespace(status="standing", posture=posture, held=held)
    found = appearance_of(agent, 0.0, LifeForm.STANDING)
    assert (found.life_form, found.health, found.primary_weapon) == looks


def test_types_say_what_a_body_is():
    told = {name: kind_of(name).entity_type(name) for name in body_names()}
    assert all(is_life_form(each[0]) for each in told.values()) and not is_life_form(1)
    drawn = {name: animal_of(each[3], each[6]) for name, each in told.items()}
    assert drawn == {"human": None, "walker": None, "dog": "dog", "cat": "cat", "horse": "horse"}
    assert animal_of(200, 77) == "dog" and set(POSTURES.values()) == {"kneel", "prone", "sit", "crouch"}
