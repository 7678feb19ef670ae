"""What a person on hands and feet observes of its body, against MuJoCo."""

import mujoco
import numpy as np
import pytest

from locomotion.body import observed as seen
from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.human.human import Human
from locomotion.recovery import layout as at
from locomotion.recovery.limbs import BALL
from locomotion.recovery.senses import observe_scramble, parts_of
from tests.locomotion.recovery.falling import plane


@pytest.fixture
def human():
    made = Human(plane(0.6), clearing=())
    made.reset((0, 0, 0), 0.0)
    return made


def test_places_joints_and_forces_are_those_of_the_body(human):
    model, data, parts = human.model, human.data, parts_of(human.index, human.model)
    memory, observed = at.new_scramble(), np.zeros(seen.OBSERVED_SIZE)
    observe_scramble(parts, data, memory)
    assert not memory[at.SEEN_VELOCITY].any()  # put there, at rest
    data.ctrl[:] = data.qpos[7:]
    for _ in range(8):
        before = memory[at.SEEN_COM].copy()
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        observe_scramble(parts, data, memory, observed)
    com = data.subtree_com[human.index.root]
    assert np.array_equal(memory[at.SEEN_COM], com)
    assert memory[at.SEEN_VELOCITY] == pytest.approx((com - before) / CONTROL_DT)
    assert np.array_equal(memory[at.SEEN_BASE], data.xpos[human.index.root])
    assert np.array_equal(memory[at.SEEN_TURN], data.xmat[human.index.root])
    bodies = [human.index.bodies[f"{s}_{part}"] for part in ("hand", "foot") for s in ("right", "left")]
    for k, body in enumerate(bodies):
        point = data.xpos[body] + data.xmat[body].reshape(3, 3) @ (HAND_POINT if k < 2 else BALL)
        assert memory[at.SEEN_LIMBS].reshape(4, 3)[k] == pytest.approx(point)
    assert np.array_equal(memory[at.BIAS], data.qfrc_bias[6:])
    assert np.array_equal(memory[at.ANCHORS].reshape(39, 3), data.xanchor[1:])
    assert np.array_equal(memory[at.AXES].reshape(39, 3), data.xaxis[1:])
    forces, trunk, force = np.zeros(4), 0.0, np.empty(6)
    for c in range(data.ncon):
        mujoco.mj_contactForce(model, data, c, force)
        name = model.body(model.geom_bodyid[data.contact.geom[c]].max()).name
        side, _, part = name.partition("_")
        if part in ("hand", "foot", "toes"):
            forces[2 * (part != "hand") + (side == "left")] += force[0]
        elif name in ("pelvis", "waist", "chest", "head"):
            trunk += force[0]
    assert forces.min() > 0.0 and memory[at.SEEN_FORCES] == pytest.approx(forces)
    assert memory[at.SEEN_TRUNK] == pytest.approx(trunk)
    assert np.array_equal(observed[seen.COM], com) and np.array_equal(
        observed[seen.CONTACT], memory[at.SEEN_FORCES][2:]
    )
    assert np.array_equal(observed[seen.FEET], data.xpos[bodies[2:]].ravel())
