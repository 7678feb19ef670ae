"""The values of SISO-REF-010 that we send and understand, by their names there."""

from enum import IntEnum

__all__ = ["CATEGORY_CIVILIAN", "CATEGORY_MAMMAL", "EntityType", "Force", "Health", "LifeForm", "Weapon",
           "is_life_form", "life_form_type"]  # fmt: skip


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
EntityType = tuple[int, int, int, int, int, int, int]
"""Kind, domain, country, category, subcategory, specific, extra."""


def life_form_type(category: int, extra: int = 0) -> EntityType:
    """A life form on land, of no country."""
    return KIND_LIFE_FORM, DOMAIN_LAND, 0, category, 0, 0, extra


def is_life_form(kind: int) -> bool:
    """Whether an entity type's kind is a person or an animal."""
    return kind == KIND_LIFE_FORM
