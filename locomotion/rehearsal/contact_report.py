"""How an obstacle is cleared, tick by tick: contacts, hands and ground reactions."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT, MASS, PersonIndex
from locomotion.body.physics import restore_physics, save_physics
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.registry import skill_kind

__all__ = ["ContactReport", "Watcher"]

_STAIR = 1.0  # [m] behind the edge of what is jumped onto that only feet may touch
_SOLES = 0.02  # [m] above the floor before it from which a contact is one with the obstacle
_LEVEL = 0.7  # upward share of the normal of a contact with the top
_BEHIND = 0.05  # [m] behind a wall's far edge to which a contact is one with the wall


@dataclass
class ContactReport:
    """How one obstacle was cleared.

    takeoff_error [m], speed_error [m/s]: as in `locomotion.body_events.TookOff`; NaN where there was none.
    cleared: whether the skill came to its end. touched: whether anything touched it that must not
    (`SkillKind.may_touch`): anything but feet what is jumped onto, anything but hands and forearms what is
    vaulted. held: time that a hand bore on the top [s]. planted: where it came to it, as share of the
    thickness from the near edge. head: time that the head touched the ground
    [s]. peak: highest reaction of the ground, after a physics step [body weights].
    """

    takeoff_error: float = np.nan
    speed_error: float = np.nan
    cleared: bool = False
    touched: bool = False
    held: float = 0.0
    planted: float = np.nan
    head: float = 0.0
    peak: float = 0.0

    def clean(self, affordance: str) -> bool:
        """Whether it touched nothing that it should not have, and held on where it should have: a hand in
        the middle half of a wall."""
        holds_on = skill_kind(affordance).holds_on
        held = not holds_on or (self.held > 0.0 and abs(self.planted - 0.5) <= 0.25)
        return held and not self.touched and self.head == 0.0


class Watcher:
    """Finds a person's contacts after a tick. MuJoCo's own are those before the last physics step, and a tick
    copied from a rehearsal has none."""

    def __init__(self, index: PersonIndex, model: mujoco.MjModel) -> None:
        self._index, self._model, self._moment = index, model, mujoco.MjData(model)
        self._parts: dict[tuple[str, ...], NDArray[np.bool_]] = {}

    def _is_one_of(self, parts: tuple[str, ...]) -> NDArray[np.bool_]:
        """(nbody,) whether a body is one of these ``parts``, on the left or the right."""
        if parts not in self._parts:
            found = np.zeros(self._model.nbody, np.bool_)
            found[[self._index.bodies[f"{side}_{part}"] for side in ("left", "right") for part in parts]] = (
                True
            )
            self._parts[parts] = found
        return self._parts[parts]

    def look(self, data: mujoco.MjData, obstacle: ObstacleAhead, report: ContactReport) -> None:
        """Record the contacts of ``data`` in ``passage``."""
        model, moment, index = self._model, self._moment, self._index
        restore_physics(model, moment, save_physics(model, data))
        mujoco.mj_forward(model, moment)
        contact = moment.contact
        pushes = contact.efc_address >= 0
        force = moment.efc_force[contact.efc_address[pushes][:, None] + np.arange(4)].sum()
        report.peak = max(report.peak, float(force) / (MASS * 9.81))
        bodies = model.geom_bodyid[contact.geom].max(axis=1)  # the level's geoms belong to body 0
        kind = skill_kind(obstacle.affordance)
        report.head += CONTROL_DT * bool((bodies[pushes] == index.head).any())
        behind = -(contact.pos[:, :2] - obstacle.position[:2]) @ obstacle.normal[:2]
        if kind.holds_on:
            on_top = self._is_one_of(("hand",))[bodies] & (np.abs(contact.frame[:, 2]) > _LEVEL)
            on_top &= pushes & (behind > 0.0) & (behind < obstacle.depth)
            if on_top.any():
                if report.held == 0.0:
                    report.planted = float(behind[on_top][0]) / obstacle.depth
                report.held += CONTROL_DT
        if kind.may_touch is not None:
            allowed = self._is_one_of(tuple(kind.may_touch))
            deep = obstacle.depth + _BEHIND if kind.obstacle.has_depth else _STAIR
            floor = obstacle.position[2] - obstacle.height + _SOLES
            with_it = (behind > -0.1) & (behind < deep) & (contact.pos[:, 2] > floor)
            report.touched |= bool((with_it & ~allowed[bodies]).any())
