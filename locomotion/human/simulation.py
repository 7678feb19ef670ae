"""The simulation of a person on a ground, and where the person is."""

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import person_on
from locomotion.body.physics import physics_size
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.gaits.run.layout import LEFT_FOOT, RIGHT_FOOT
from locomotion.gaits.walk.footholds import ground_at
from locomotion.ground.ground import FRICTION, Ground, plane_lookup
from surefoot.kernels import kernel

__all__ = ["Simulation", "movements"]


class Simulation:
    """A person's physics.

    Attributes:
      ground: None is the endless plane z = 0. lookup: its triangles, for kernels.
      model, data: the MuJoCo model (shared by all persons on the same ground) and this person's own data,
      current
        after a tick; derived values (contacts, places of bodies) may be outdated.
      index: addresses of the person's parts in the model.
      physics_size: count of numbers in a saved state of ``data``.
      control: memory and observations of the running controller (fields: `locomotion.gaits.run.layout`), also
        while the person walks.
    """

    def __init__(self, ground: Ground | None) -> None:
        self.control = controller.new_state()
        self.stand_on(ground)

    def stand_on(self, ground: Ground | None) -> None:
        """Start a new simulation on another ground."""
        self.ground = ground
        self.model, self.index = person_on(ground)
        self.data = mujoco.MjData(self.model)
        self.physics_size = physics_size(self.model)
        self.lookup = plane_lookup() if ground is None else ground.lookup

    @property
    def com(self) -> NDArray[np.float64]:
        """Centre of mass, (3,) float64 [m]."""
        return self.control[controller.COM].copy()

    @property
    def ground_speed(self) -> float:
        """[m/s] of the centre of mass, seen from above."""
        return math.hypot(*self.control[controller.COM_VELOCITY][:2])

    @property
    def position(self) -> NDArray[np.float64]:
        """The point of the ground under the centre of mass, (3,) float64 [m]."""
        com, feet = self.control[controller.COM], self.control[controller.FEET]
        x, y, z = float(com[0]), float(com[1]), float(min(feet[2], feet[5]))
        if self.ground is None:
            return np.array([x, y, 0.0])
        below = float(self.ground.surface_below([[x, y, float(com[2])]])[0][0])
        return np.array([x, y, below if np.isfinite(below) else z])

    @property
    def grip(self) -> float:
        """Coefficient of friction of the ground."""
        return FRICTION if self.ground is None else self.ground.friction

    @property
    def slope_here(self) -> float:
        """Slope of the ground under the centre of mass [rise over run]; 0 where there is none."""
        if self.ground is None:
            return 0.0
        x, y, z = self.ground.surface_below(self.com[None])[1][0]
        return math.hypot(x, y) / z if z > 0.0 else 0.0

    @property
    def over_ground(self) -> bool:
        """Whether there is ground under the centre of mass."""
        return self.ground is None or bool(np.isfinite(self.ground.surface_below(self.com)[0][0]))

    @property
    def footing(self) -> NDArray[np.float64]:
        """(2,) heights of the ground under the feet [m], NaN where there is none."""
        assert self.ground is not None
        return self.ground.surface_below(self.control[controller.FEET].reshape(2, 3))[0]

    @property
    def yaw(self) -> float:
        """Direction that the pelvis faces [rad, -π to π]."""
        w, x, y, z = self.data.qpos[3:7]
        return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))

    def body_transforms(self) -> NDArray[np.float64]:
        """Position [m] and quaternion (w, x, y, z) of each body of the model, (nbody, 7) float64."""
        mujoco.mj_kinematics(self.model, self.data)
        out = np.empty((self.model.nbody, 7))
        out[:, :3], out[:, 3:] = self.data.xpos, self.data.xquat
        return out

    def on_ground(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """``place`` (3,) moved vertically onto the ground. Raises `LocomotionError` if that is more than 0.5
        m away."""
        if self.ground is None:
            return place
        z = float(self.ground.surface_below([[place[0], place[1], place[2] + 0.5]])[0][0])
        if not abs(z - place[2]) <= 0.5:
            raise LocomotionError(f"there is no ground within 0.5 m of {place.round(2)}")
        return np.array([place[0], place[1], z])


def movements(bodies: Sequence[Simulation]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3) float64 [m]: `Simulation.position` of several, who are on the same ground; and (n, 3) [m/s]: the
    velocities of their centres of mass, as if nobody were held."""
    if not bodies:
        return np.empty((0, 3)), np.empty((0, 3))
    controls = np.concatenate([each.control for each in bodies]).reshape(len(bodies), -1)
    places = controls[:, controller.COM].copy()
    if bodies[0].ground is None:
        places[:, 2] = 0.0
    else:
        _put_on_ground(bodies[0].lookup, controls, places)
    return places, controls[:, controller.COM_VELOCITY]


@kernel
def _put_on_ground(ground, controls, places):
    """Lower ``places`` (n, 3), centres of mass, to the ground below, or where there is none to the lower
    foot. ground: as in `ground_at`. controls: (n, k) as of `Simulation.control`."""
    for k in range(len(places)):
        height = ground_at(ground, places[k, 0], places[k, 1], places[k, 2])[0]
        if math.isnan(height):
            height = min(controls[k, RIGHT_FOOT + 2], controls[k, LEFT_FOOT + 2])
        places[k, 2] = height
