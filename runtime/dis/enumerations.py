"""The values of SISO-REF-010 that we send and understand, by their names there."""

from enum import IntEnum

__all__ = ["ENTITY_TYPES", "Force", "LifeForm", "animal_of", "is_life_form"]


class LifeForm(IntEnum):
    """Life form state: bits 16 to 19 of a life form's appearance."""

    NONE = 0
    STANDING = 1
    WALKING = 2
    RUNNING = 3
    KNEELING = 4
    PRONE = 5
    CRAWLING = 6
    SWIMMING = 7
    PARACHUTING = 8
    JUMPING = 9
    SITTING = 10
    SQUATTING = 11
    CROUCHING = 12
    WADING = 13
    SURRENDER = 14
    DETAINED = 15


class Force(IntEnum):
    """Force ID."""

    OTHER = 0
    FRIENDLY = 1
    OPPOSING = 2
    NEUTRAL = 3


class Health(IntEnum):
    """Bits 3 and 4 of a life form's appearance."""

    NO_INJURY = 0
    SLIGHT = 1
    MODERATE = 2
    FATAL = 3


class Weapon(IntEnum):
    """Bits 24 and 25 (primary), 26 and 27 (secondary) of a life form's appearance."""

    NONE = 0
    STOWED = 1
    DEPLOYED = 2
    FIRING = 3


KIND_LIFE_FORM, DOMAIN_LAND = 3, 1
CATEGORY_CIVILIAN, CATEGORY_MAMMAL = 130, 200
_ANIMALS = ("dog", "cat", "horse")

ENTITY_TYPES: dict[str, tuple[int, int, int, int, int, int, int]] = {
    "human": (KIND_LIFE_FORM, DOMAIN_LAND, 0, CATEGORY_CIVILIAN, 0, 0, 0),
    "walker": (KIND_LIFE_FORM, DOMAIN_LAND, 0, CATEGORY_CIVILIAN, 0, 0, 0),
    **{
        name: (KIND_LIFE_FORM, DOMAIN_LAND, 0, CATEGORY_MAMMAL, 0, 0, number)
        for number, name in enumerate(_ANIMALS, start=1)
    },
}
"""What our bodies are sent as: kind, domain, country, category, subcategory, specific, extra. Animals are
told apart by ``extra``, which is ours to define; give a gateway others where an exercise has agreed on
them."""


def is_life_form(kind: int) -> bool:
    """Whether an entity type's kind is a person or an animal."""
    return kind == KIND_LIFE_FORM


def animal_of(category: int, extra: int) -> str | None:
    """Which of our animals a life form is drawn as, None for a person."""
    if category < CATEGORY_MAMMAL:
        return None
    return _ANIMALS[extra - 1] if 1 <= extra <= len(_ANIMALS) else _ANIMALS[0]
