"""The scene of trials with an obstacle: the person, a plane, and movable boxes."""

import mujoco

from locomotion.body.person import person_spec

__all__ = ["BOX_LENGTH", "BOX_TOP", "trial_scene"]

BOX_LENGTH = 60.0
"""[m] of a box along x."""
BOX_TOP = 2.0
"""[m] from a box's middle up to its top; as far below it, it is out of the way under the plane."""
_FRICTION = (0.9, 0.005, 0.0001)


def trial_scene(*boxes: str) -> mujoco.MjModel:
    """The person, the plane z = 0 (geom ``ground``) and geoms called ``boxes``, level with the plane and far
    apart, all of which may be moved by their `geom_pos`."""
    spec = person_spec()
    spec.worldbody.add_geom(
        name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=1, conaffinity=0,
        friction=_FRICTION, rgba=[0.82, 0.84, 0.86, 1],
    )  # fmt: skip
    for number, name in enumerate(boxes, 1):
        spec.worldbody.add_geom(
            name=name, type=mujoco.mjtGeom.mjGEOM_BOX, size=[BOX_LENGTH / 2, 4.0, BOX_TOP], contype=1,
            conaffinity=0, friction=_FRICTION, rgba=[0.62, 0.55, 0.46, 1],
            pos=[1000.0 * number, 0.0, -BOX_TOP],
        )  # fmt: skip
    model = spec.compile()
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE  # the boxes move in the world body
    # so that moving the plane counts
    model.geom_sameframe[model.geom("ground").id] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE
    return model
