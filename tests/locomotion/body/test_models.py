"""People share their compiled model; contacts of a falling one are harder."""

import gc
import weakref

import mujoco
import numpy as np
import pytest

from locomotion.body.models import gentler, harder, person_on
from locomotion.body.person import PersonIndex
from locomotion.errors import LocomotionError
from locomotion.ground.ground import FRICTION, Ground

CORNERS = np.array([[-9.0, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]])
FACES = [[0, 1, 2], [0, 2, 3]]


def test_people_on_the_same_ground_share_a_model():
    ground, other = Ground.from_arrays(CORNERS, FACES), Ground.from_arrays(CORNERS, FACES)
    assert person_on(ground)[0] is person_on(ground)[0]
    assert person_on(None)[0] is person_on(None)[0]
    assert len({id(person_on(each)[0]) for each in (ground, other, None)}) == 3
    index = person_on(ground)[1]
    assert index.bodies == PersonIndex.of(person_on(None)[0]).bodies


def test_a_model_goes_with_its_ground():
    ground = Ground.from_arrays(CORNERS, FACES)
    model = weakref.ref(person_on(ground)[0])
    harder(model())
    assert model() is not None
    del ground
    gc.collect()
    assert model() is None


class WithCylinder(Ground):
    """A ground with a geom that the collider does not know, on the person's chest."""

    def add_to(self, spec, visual=True):
        spec.body("chest").add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.1, 0.1, 0], contype=0)
        return super().add_to(spec, visual)


def test_a_model_that_would_fall_through_is_refused():
    with pytest.raises(LocomotionError, match="no sphere or capsule"):
        person_on(WithCylinder.from_arrays(CORNERS, FACES))


def deepest(model):
    """How far [m] a person that drops onto its side sinks into the ground."""
    data = mujoco.MjData(model)
    data.qpos[2] = 0.35
    data.qpos[3:7] = np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0
    depth = 0.0
    for _ in range(80):
        mujoco.mj_step(model, data)
        depth = max(depth, -data.contact.dist.min(initial=0.0))
    return depth


def test_harder_contacts_yield_less_and_leave_the_model_as_it_was():
    model, _ = person_on(None)
    before = model.geom_solref.copy()
    hard = harder(model)
    assert hard is harder(model) is not model
    assert np.array_equal(model.geom_solref, before)
    assert deepest(hard) < 0.7 * deepest(model)
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    assert mujoco.mj_stateSize(hard, kind) == mujoco.mj_stateSize(model, kind)


def test_gentler_ground_has_no_more_than_the_usual_friction():
    steep, _ = person_on(Ground.from_arrays(CORNERS, FACES, max_slope=np.radians(40.0)))
    ground = steep.geom("ground").id
    assert steep.geom_friction[ground, 0] > FRICTION
    gentle, hard = gentler(steep), harder(steep)
    assert gentle is gentler(steep)
    assert gentle.geom_friction[ground, 0] == FRICTION
    assert hard.geom_friction[ground, 0] == steep.geom_friction[ground, 0] > FRICTION
    assert np.array_equal(gentle.geom_solref, hard.geom_solref)
    own = gentle.geom_bodyid != 0
    assert np.array_equal(gentle.geom_friction[own], steep.geom_friction[own])
