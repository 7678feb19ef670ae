"""The person: a figure of 1.70 m and 65 kg with 45 degrees of freedom, as a MuJoCo model.

Segment masses, centres of mass and radii of gyration are those of P. de Leva (1996), "Adjustments to
Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29(9), for men, scaled to 1.70 m; joint
heights follow the proportions of D. Winter, "Biomechanics and Motor Control of Human Movement". Joint
ranges are those of common clinical tables, torque limits those of strong adults.

Layout, relied upon by the controllers: ``qpos`` (46,) = root position (3), root quaternion wxyz (4), then
one angle per name of `JOINT_NAMES`; ``qvel`` (45,) = root linear velocity in the world (3), root angular
velocity in the root's frame (3), joint rates; ``ctrl`` (39,) = target angle [rad] per name of
`JOINT_NAMES`. A name's sign is anatomical and the same on both sides: flexion moves a thigh, an upper arm, a
forearm forward or a shank backward; abduction moves a limb away from the body; rotation turns a limb inward;
trunk pitch bends forward, trunk roll leans to the right, trunk yaw turns to the left.
"""

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import mujoco
import numpy as np

from locomotion.body.anatomy import (
    FOREARM,
    HEIGHT,
    MASS,
    SHANK,
    SIDE_JOINTS,
    SIDE_SEGMENTS,
    STANDING_HEIGHT,
    THIGH,
    TOE_JOINT,
    TRUNK_JOINTS,
    TRUNK_SEGMENTS,
    UPPER_ARM,
    Joint,
    Segment,
)
from locomotion.body.hand_hold import add_hand_holds
from locomotion.errors import LocomotionError

__all__ = [
    "BODY_NAMES",
    "CONTROL_DT",
    "HEIGHT",
    "JOINT_NAMES",
    "MASS",
    "STANDING_HEIGHT",
    "STEPS_PER_TICK",
    "TIMESTEP",
    "PersonIndex",
    "add_plane",
    "build_person",
    "person_digest",
    "person_spec",
]

TIMESTEP = 0.0025
"""Physics time step [s]. Controllers learned at it work at shorter steps and fail at 5 ms."""
STEPS_PER_TICK = 4
"""Physics steps per control tick."""
CONTROL_DT = TIMESTEP * STEPS_PER_TICK
"""Control tick [s]."""

_SKIN, _SHIRT, _TROUSERS, _SHOES, _HAIR = (
    (0.83, 0.64, 0.52, 1.0),
    (0.16, 0.42, 0.62, 1.0),
    (0.20, 0.21, 0.26, 1.0),
    (0.75, 0.22, 0.16, 1.0),
    (0.22, 0.15, 0.10, 1.0),
)
_DAMPING_RATIO = 0.1  # servo damping [Nm s/rad] per stiffness [Nm/rad]
_ARMATURE = 0.01  # reflected inertia of every joint [kg m^2]


class GroundLike(Protocol):
    """What `build_person` needs of a ground: it adds its own geoms to the model's description."""

    def add_to(self, spec: mujoco.MjSpec) -> Any: ...


@dataclass(frozen=True)
class PersonIndex:
    """Addresses in a person's model, looked up by name.

    Attributes:
      bodies: body id by name.
      geom_side: (ngeom,) int8, +1 for the geoms of the left foot and toes, -1 for the right ones, else 0.
      feet: (2,) int64, body ids of the right and the left foot.
      root, head, chest: body ids of pelvis, head and chest.
    """

    bodies: dict[str, int]
    geom_side: np.ndarray
    feet: np.ndarray
    root: int
    head: int
    chest: int

    @classmethod
    def of(cls, model: mujoco.MjModel) -> "PersonIndex":
        """Look the names up in ``model``; raises `LocomotionError` if it is not a person's model."""
        bodies = {model.body(i).name: i for i in range(model.nbody)}
        missing = [name for name in BODY_NAMES if name not in bodies]
        if missing:
            raise LocomotionError(f"the model holds no person: it has no body called {missing[0]!r}")
        side = np.zeros(model.ngeom, dtype=np.int8)
        for sign, prefix in ((-1, "right"), (1, "left")):
            for part in ("foot", "toes"):
                side[model.geom_bodyid == bodies[f"{prefix}_{part}"]] = sign
        feet = np.array([bodies["right_foot"], bodies["left_foot"]])
        return cls(bodies, side, feet, bodies["pelvis"], bodies["head"], bodies["chest"])


def _add_body(
    parent: Any, segment: Segment, name: str, pos: tuple[float, float, float], joints: tuple, mirror: bool
) -> Any:
    """Add one segment with its hinges; ``mirror`` mirrors it from the left to the right side."""
    sign = -1.0 if mirror else 1.0
    body = parent.add_body(name=name, pos=[pos[0], sign * pos[1], pos[2]])
    mass = segment.mass * MASS
    body.mass = mass
    body.ipos = [segment.com[0], sign * segment.com[1], segment.com[2]]
    body.inertia = [mass * r * r for r in segment.gyration]
    body.explicitinertial = True
    prefix = name[: -len(segment.name)]
    for joint in joints:
        x, y, z = joint.axis
        body.add_joint(
            name=prefix + joint.name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=[sign * x, y, sign * z],
            range=[np.deg2rad(joint.low), np.deg2rad(joint.high)],
            limited=True,
            armature=_ARMATURE,
        )
    return body


def _capsule(
    body: Any, start: tuple, end: tuple, radius: float, color: tuple, mirror: bool = False, **options: Any
) -> None:
    sign = -1.0 if mirror else 1.0
    fromto = [start[0], sign * start[1], start[2], end[0], sign * end[1], end[2]]
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=fromto,
        size=[radius, 0, 0],
        rgba=color,
        contype=0,
        conaffinity=1,
        mass=0.0,
        **options,
    )


def _ellipsoid(body: Any, pos: tuple, size: tuple, color: tuple, mirror: bool = False) -> None:
    """Add a shape that is only visible."""
    sign = -1.0 if mirror else 1.0
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        pos=[pos[0], sign * pos[1], pos[2]],
        size=size,
        rgba=color,
        contype=0,
        conaffinity=0,
        mass=0.0,
        group=1,
    )


def _add_trunk(world: Any) -> tuple[Any, Any]:
    pelvis = _add_body(world, TRUNK_SEGMENTS["pelvis"], "pelvis", (0.0, 0.0, STANDING_HEIGHT), (), False)
    pelvis.add_freejoint(name="root")
    _capsule(pelvis, (-0.01, -0.065, 0.03), (-0.01, 0.065, 0.03), 0.095, _TROUSERS)
    waist = _add_body(
        pelvis, TRUNK_SEGMENTS["waist"], "waist", (0.0, 0.0, 0.12), TRUNK_JOINTS["waist"], False
    )
    _capsule(waist, (0.0, -0.045, 0.05), (0.0, 0.045, 0.05), 0.095, _SHIRT)
    _ellipsoid(waist, (0.0, 0.0, 0.13), (0.10, 0.145, 0.13), _SHIRT)
    chest = _add_body(waist, TRUNK_SEGMENTS["chest"], "chest", (0.0, 0.0, 0.20), TRUNK_JOINTS["chest"], False)
    _capsule(chest, (0.0, -0.06, 0.08), (0.0, 0.06, 0.08), 0.11, _SHIRT)
    _ellipsoid(chest, (-0.005, 0.0, 0.12), (0.115, 0.175, 0.125), _SHIRT)
    head = _add_body(chest, TRUNK_SEGMENTS["head"], "head", (0.0, 0.0, 0.23), TRUNK_JOINTS["head"], False)
    _capsule(head, (0.0, 0.0, -0.02), (0.012, 0.0, 0.08), 0.05, _SKIN)
    _capsule(head, (0.02, 0.0, 0.12), (0.012, 0.0, 0.165), 0.085, _SKIN)
    _ellipsoid(head, (0.003, 0.0, 0.163), (0.093, 0.087, 0.087), _HAIR)
    _ellipsoid(head, (0.104, 0.0, 0.12), (0.016, 0.012, 0.022), _SKIN)
    return pelvis, chest


def _add_leg(pelvis: Any, prefix: str, mirror: bool) -> None:
    def add(parent: Any, part: str, pos: tuple[float, float, float]) -> Any:
        return _add_body(parent, SIDE_SEGMENTS[part], f"{prefix}_{part}", pos, SIDE_JOINTS[part], mirror)

    thigh = add(pelvis, "thigh", (0.0, 0.085, 0.0))
    _capsule(thigh, (0.0, 0.005, -0.02), (0.0, 0.0, -THIGH + 0.03), 0.058, _TROUSERS, mirror)
    _ellipsoid(thigh, (-0.002, 0.006, -0.13), (0.080, 0.078, 0.19), _TROUSERS, mirror)
    shank = add(thigh, "shank", (0.0, 0.0, -THIGH))
    _capsule(shank, (0.0, 0.0, -0.01), (0.0, 0.0, -SHANK + 0.03), 0.042, _TROUSERS, mirror)
    _ellipsoid(shank, (-0.018, 0.0, -0.13), (0.053, 0.055, 0.14), _TROUSERS, mirror)
    foot = add(shank, "foot", (0.0, 0.0, -SHANK))
    sole = TOE_JOINT[2]
    _capsule(foot, (-0.032, -0.016, sole), (0.118, -0.026, sole), 0.024, _SHOES, mirror)
    _capsule(foot, (-0.032, 0.016, sole), (0.112, 0.028, sole), 0.024, _SHOES, mirror)
    _ellipsoid(foot, (0.012, 0.0, -0.022), (0.068, 0.038, 0.036), _SHOES, mirror)
    toes = add(foot, "toes", TOE_JOINT)
    _capsule(toes, (0.045, -0.022, -0.003), (0.040, 0.026, -0.003), 0.021, _SHOES, mirror)
    _ellipsoid(toes, (0.015, 0.0, 0.0), (0.045, 0.047, 0.022), _SHOES, mirror)


def _add_arm(chest: Any, prefix: str, mirror: bool) -> None:
    def add(parent: Any, part: str, pos: tuple[float, float, float]) -> Any:
        return _add_body(parent, SIDE_SEGMENTS[part], f"{prefix}_{part}", pos, SIDE_JOINTS[part], mirror)

    clavicle = add(chest, "clavicle", (0.0, 0.035, 0.165))
    _capsule(clavicle, (0.0, 0.03, 0.01), (0.0, 0.125, 0.005), 0.045, _SHIRT, mirror)
    upper = add(clavicle, "upper_arm", (0.0, 0.150, 0.0))
    _capsule(upper, (0.0, 0.0, -0.01), (0.0, 0.0, -UPPER_ARM + 0.02), 0.040, _SHIRT, mirror)
    _ellipsoid(upper, (0.0, 0.0, -0.10), (0.052, 0.047, 0.11), _SHIRT, mirror)
    forearm = add(upper, "forearm", (0.0, 0.0, -UPPER_ARM))
    _capsule(forearm, (0.0, 0.0, -0.005), (0.0, 0.0, -FOREARM + 0.02), 0.032, _SKIN, mirror)
    _ellipsoid(forearm, (0.0, 0.0, -0.07), (0.043, 0.040, 0.095), _SKIN, mirror)
    hand = add(forearm, "hand", (0.0, 0.0, -FOREARM))
    _capsule(hand, (0.0, 0.0, -0.03), (0.012, 0.0, -0.115), 0.028, _SKIN, mirror)
    _ellipsoid(hand, (0.01, 0.0, -0.07), (0.042, 0.022, 0.060), _SKIN, mirror)


def _joint_table() -> list[tuple[str, Joint]]:
    """Every hinge in the order of the model's coordinates."""
    table = [(j.name, j) for part in ("waist", "chest", "head") for j in TRUNK_JOINTS[part]]
    for prefix in ("right", "left"):
        parts = ("clavicle", "upper_arm", "forearm", "hand")
        table += [(f"{prefix}_{j.name}", j) for part in parts for j in SIDE_JOINTS[part]]
    for prefix in ("right", "left"):
        table += [
            (f"{prefix}_{j.name}", j)
            for part in ("thigh", "shank", "foot", "toes")
            for j in SIDE_JOINTS[part]
        ]
    return table


JOINT_NAMES: tuple[str, ...] = tuple(name for name, _ in _joint_table())
"""The 39 actuated joints in the order of ``qpos[7:]``, ``qvel[6:]`` and ``ctrl``."""
BODY_NAMES: tuple[str, ...] = (
    *TRUNK_SEGMENTS,
    *(f"{side}_{part}" for side in ("right", "left") for part in SIDE_SEGMENTS),
)
"""Names of the bodies, to look up their ids; the model's own order differs."""


def person_spec() -> mujoco.MjSpec:
    """The description of the person without a ground, for the caller to extend and compile."""
    spec = mujoco.MjSpec()
    spec.modelname = "person"
    spec.compiler.degree = False
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    spec.option.iterations = 30
    spec.option.ls_iterations = 20
    # islands and trees do not pay for one body on one ground; results are equal without
    disabled = mujoco.mjtDisableBit.mjDSBL_ISLAND | mujoco.mjtDisableBit.mjDSBL_MIDPHASE
    spec.option.disableflags |= int(disabled)
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 720
    spec.worldbody.add_light(pos=[0, 0, 4], dir=[0.2, 0.3, -1], type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
    pelvis, chest = _add_trunk(spec.worldbody)
    for prefix, mirror in (("right", True), ("left", False)):
        _add_arm(chest, prefix, mirror)
    for prefix, mirror in (("right", True), ("left", False)):
        _add_leg(pelvis, prefix, mirror)
    for name, joint in _joint_table():
        actuator = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
        actuator.set_to_position(kp=joint.stiffness, kv=joint.stiffness * _DAMPING_RATIO)
        actuator.forcelimited = True
        actuator.forcerange = [-joint.torque, joint.torque]
    add_hand_holds(spec)
    return spec


def add_plane(spec: mujoco.MjSpec) -> None:
    """Add the endless plane z = 0 (geom ``ground``)."""
    spec.add_texture(
        name="floor",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.80, 0.82, 0.84],
        rgb2=[0.70, 0.73, 0.76],
        width=300,
        height=300,
    )
    material = spec.add_material(name="floor", texrepeat=[1, 1], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "floor"
    spec.worldbody.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 1],
        material="floor",
        contype=1,
        conaffinity=0,
        friction=[0.9, 0.005, 0.0001],
    )


def build_person(ground: GroundLike | None = None) -> mujoco.MjModel:
    """The person on ``ground``, compiled; without one, on an endless plane z = 0 (geom ``ground``).

    ``ground`` is anything with ``add_to(spec)``, such as `locomotion.ground.ground.Ground`. All geoms of the
    person have contype 0 and conaffinity 1: they touch whatever has contype 1, but never each other.
    """
    spec = person_spec()
    if ground is None:
        add_plane(spec)
    else:
        ground.add_to(spec)
    return spec.compile()


@lru_cache(maxsize=1)
def person_digest() -> str:
    """Hex digest of everything in the person that a learned skill depends on."""
    hasher = hashlib.sha256()
    hasher.update(repr((HEIGHT, MASS, TIMESTEP, STEPS_PER_TICK)).encode())
    model = person_spec().compile()
    own = model.body_mocapid < 0
    fields = (
        model.body_mass[own],
        model.body_inertia[own],
        model.body_ipos[own],
        model.body_pos[own],
        model.jnt_axis,
        model.jnt_range,
        model.dof_armature,
        model.actuator_gainprm,
        model.actuator_biasprm,
        model.actuator_forcerange,
        model.geom_size[model.geom_conaffinity > 0],
        model.geom_pos[model.geom_conaffinity > 0],
    )
    for field in fields:
        hasher.update(np.round(np.ascontiguousarray(field, dtype=np.float64), 9).tobytes())
    return hasher.hexdigest()[:16]
