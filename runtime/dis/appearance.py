"""The appearance field of life forms, and which of our statuses and postures are which of theirs."""

from dataclasses import dataclass

from locomotion.skills.registry import CLEARING
from runtime.dis.enumerations import Health, LifeForm, Weapon

__all__ = ["MOVING_AT", "POSTURES", "Appearance", "life_form_of"]

MOVING_AT = 0.2
"""[m/s] from which one that stands up is taken to walk."""
RUNNING_AT = 2.2
"""[m/s] from which one that walks is taken to run, where nothing else says so."""
_HYSTERESIS = 0.7  # share of these speeds below which it is taken back
_STATUSES = {
    "scrambling": LifeForm.CRAWLING,
    "getting up": LifeForm.KNEELING,
    "fallen": LifeForm.PRONE,
    "crouch": LifeForm.CROUCHING,
    "crouching": LifeForm.CROUCHING,
    "kneel": LifeForm.KNEELING,
    "kneeling": LifeForm.KNEELING,
    "all-fours": LifeForm.CRAWLING,
    "prone": LifeForm.PRONE,
    "sit": LifeForm.SITTING,
    "sitting": LifeForm.SITTING,
    "dead": LifeForm.PRONE,
}
"""Statuses of agents and names of postures that say by themselves what one looks like."""
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


def life_form_of(status: str, speed: float, before: LifeForm, by_status: bool) -> LifeForm:
    """What an agent of this ``status`` at this ``speed`` [m/s] looks like; ``before``: what it was, lest it
    change to and fro. ``by_status``: whether "walking" and "running" are two gaits of its body, and not only
    words for being on its way."""
    if status in _STATUSES:
        return _STATUSES[status]
    if status in CLEARING.values():
        return LifeForm.JUMPING
    upright = (LifeForm.WALKING, LifeForm.RUNNING)
    if speed < MOVING_AT * (_HYSTERESIS if before in upright else 1.0):
        return LifeForm.STANDING
    if by_status and status in ("walking", "running"):
        return LifeForm.RUNNING if status == "running" else LifeForm.WALKING
    runs = speed >= RUNNING_AT * (_HYSTERESIS if before is LifeForm.RUNNING else 1.0)
    return LifeForm.RUNNING if runs else LifeForm.WALKING
