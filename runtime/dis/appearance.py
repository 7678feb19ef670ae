"""The appearance field of life forms, and which of our statuses and postures are which of theirs."""

from dataclasses import dataclass

from locomotion.skills.registry import CLEARING
from runtime.dis.enumerations import Health, LifeForm, Weapon
from runtime.world.agent import Agent

__all__ = ["POSTURES", "Appearance", "appearance_of", "life_form_of"]

MOVING_AT = 0.2
"""[m/s] from which one that stands up is taken to walk."""
RUNNING_AT = 2.2
"""[m/s] from which one that walks is taken to run."""
_HYSTERESIS = 0.7  # share of these speeds below which it is taken back
_STATUSES = {
    "scrambling": LifeForm.CRAWLING,
    "getting up": LifeForm.KNEELING,
    "fallen": LifeForm.PRONE,
}
"""Statuses that say by themselves what one looks like."""
_DEAD = "dead"
_FORMS = {
    "crouch": LifeForm.CROUCHING,
    "kneel": LifeForm.KNEELING,
    "all-fours": LifeForm.CRAWLING,
    "prone": LifeForm.PRONE,
    "sit": LifeForm.SITTING,
    _DEAD: LifeForm.PRONE,
}
_WEAPONS = {"stowed": Weapon.STOWED, "deployed": Weapon.DEPLOYED, "in use": Weapon.FIRING}
POSTURES = {
    LifeForm.KNEELING: "kneel",
    LifeForm.PRONE: "prone",
    LifeForm.SITTING: "sit",
    LifeForm.SQUATTING: "crouch",
    LifeForm.CROUCHING: "crouch",
}
"""The posture of `locomotion/data/postures/person.yaml` in which one is drawn that does not move; upright in
all others."""


@dataclass(frozen=True)
class Appearance:
    """A life form's appearance, as bits of SISO-REF-010; what is not named here is 0."""

    life_form: LifeForm = LifeForm.STANDING
    health: Health = Health.NO_INJURY
    primary_weapon: Weapon = Weapon.NONE
    secondary_weapon: Weapon = Weapon.NONE
    frozen: bool = False
    deactivated: bool = False

    @property
    def bits(self) -> int:
        """The field, 32 bits."""
        return (
            self.health << 3
            | self.life_form << 16
            | self.frozen << 21
            | self.deactivated << 23
            | self.primary_weapon << 24
            | self.secondary_weapon << 26
        )

    @classmethod
    def of(cls, bits: int) -> "Appearance":
        """What a field says."""
        return cls(
            LifeForm(bits >> 16 & 15),
            Health(bits >> 3 & 3),
            Weapon(bits >> 24 & 3),
            Weapon(bits >> 26 & 3),
            bool(bits >> 21 & 1),
            bool(bits >> 23 & 1),
        )


def appearance_of(agent: Agent, speed: float, before: LifeForm) -> Appearance:
    """What an agent looks like that moves at ``speed`` [m/s]; ``before``: what it was, lest it change to and
    fro."""
    held, state = agent.held
    return Appearance(
        life_form_of(agent.status, agent.posture, speed, before),
        Health.FATAL if agent.posture == _DEAD else Health.NO_INJURY,
        _WEAPONS.get(state, Weapon.NONE) if held else Weapon.NONE,
    )


def life_form_of(status: str, posture: str, speed: float, before: LifeForm) -> LifeForm:
    """The life form state of `appearance_of`."""
    if posture in _FORMS:
        return _FORMS[posture]
    if status in _STATUSES:
        return _STATUSES[status]
    if status in CLEARING.values():
        return LifeForm.JUMPING
    upright = (LifeForm.WALKING, LifeForm.RUNNING)
    if speed < MOVING_AT * (_HYSTERESIS if before in upright else 1.0):
        return LifeForm.STANDING
    runs = speed >= RUNNING_AT * (_HYSTERESIS if before is LifeForm.RUNNING else 1.0)
    return LifeForm.RUNNING if runs else LifeForm.WALKING
