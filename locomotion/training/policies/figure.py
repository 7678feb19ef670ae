"""The person as policies learn on it: fewer joints, contacts only under the feet, and sensors of what is felt
(`layout.SOLES`, `layout.FORCES`)."""

import mujoco
import numpy as np

from locomotion.body.person import JOINT_NAMES, add_plane, person_spec
from locomotion.gaits.policy.layout import ANKLE_SOLE, JOINTS, SOLE_POINTS, TIP

__all__ = ["Figure"]

_REACH = 0.3  # [m] of the volumes in which forces are felt: the whole foot
_ITERATIONS = 10


class Figure:
    """A compiled person on a plane.

    Attributes:
      model: MuJoCo's; ``whole``: with all 45 degrees of freedom, as in the product.
      angles, rates, targets: (24,) int64, addresses of the policy's joints in qpos, qvel and ctrl.
      soles: (6,) int64, ids of the sites of `SOLE_POINTS`.
    """

    def __init__(self, whole: bool, timestep: float) -> None:
        spec = person_spec()
        add_plane(spec)
        spec.option.timestep = timestep
        if not whole:
            _reduce(spec)
        _add_sensors(spec)
        model = self.model = spec.compile()
        joints = [model.joint(name).id for name in JOINTS]
        self.angles = model.jnt_qposadr[joints].astype(np.int64)
        self.rates = model.jnt_dofadr[joints].astype(np.int64)
        self.targets = np.array([model.actuator(name).id for name in JOINTS])
        self.soles = np.array([model.site(name).id for name in SOLE_POINTS])
        self.limits = model.jnt_range[joints]


def _reduce(spec: mujoco.MjSpec) -> None:
    spec.option.iterations = spec.option.ls_iterations = _ITERATIONS
    for name in JOINT_NAMES:
        if name not in JOINTS:
            spec.delete(spec.actuator(name))
            spec.delete(spec.joint(name))
    for body in spec.bodies:
        if body.name != "world" and not body.name.endswith(("foot", "toes")):
            for geom in body.geoms:
                geom.conaffinity = 0


def _add_sensors(spec: mujoco.MjSpec) -> None:
    for side in ("right", "left"):
        foot, toes = spec.body(f"{side}_foot"), spec.body(f"{side}_toes")
        for body, name, at in (
            (foot, "heel", ANKLE_SOLE[0]),
            (foot, "ball", ANKLE_SOLE[1]),
            (toes, "tip", TIP),
        ):
            body.add_site(name=f"{side}_{name}", pos=at, group=4)
        for body in (foot, toes):
            sphere = mujoco.mjtGeom.mjGEOM_SPHERE
            body.add_site(name=f"{body.name}_volume", type=sphere, size=[_REACH, 0, 0], group=4)
    for name in SOLE_POINTS:
        _sense(spec, name, mujoco.mjtSensor.mjSENS_FRAMEPOS, name)
    for side in ("right", "left"):
        for part in ("foot", "toes"):
            _sense(spec, f"{side}_{part}_force", mujoco.mjtSensor.mjSENS_TOUCH, f"{side}_{part}_volume")


def _sense(spec: mujoco.MjSpec, name: str, kind: mujoco.mjtSensor, site: str) -> None:
    spec.add_sensor(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site)
