"""A character as it is drawn: its skin where the rig says, its shadow along the bones, in a film."""

import numpy as np
import pytest

from examples.make_characters import STOUT, write_character
from locomotion import Rig
from runtime.bodies.figure import rotate
from runtime.views.film import frames
from runtime.views.worn import Wardrobe, ground_of, wearers

SIZE = (160, 90)


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    file = tmp_path_factory.mktemp("worn") / "stout.glb"
    write_character(STOUT, file)
    return Rig.load(file)


def test_skin_and_shadow_are_where_the_bones_are(trace, rig):
    agent = trace.agents[0]
    skin, held, shadow = Wardrobe(rig, trace, [agent]).worn(agent, 2)
    assert held == []
    low, high = skin.corners.min(axis=(0, 1)), skin.corners.max(axis=(0, 1))
    assert abs(low[2]) < 0.02 and 1.0 < high[2] < 1.5
    assert len(skin.corners) == len(skin.colours)
    along = np.zeros((len(shadow.size), 3))
    along[:, 2] = shadow.size[:, 1]
    ends = shadow.place[:, :3] + rotate(shadow.place[:, 3:], along)
    assert (ends > low - 0.1).all() and (ends < high + 0.1).all()
    bones = {tuple(np.round(end, 6)) for end in ends}
    pose = rig.pose_motion(agent.poses[:3], trace.times[:3], agent.figure.bodies, ground_of(trace.level))[2]
    assert all(tuple(np.round(pose[b, :3], 6)) in bones for b in range(1, len(pose)))


def test_a_film_shows_the_character(trace, rig):
    pytest.importorskip("matplotlib")
    plain = next(frames(trace, trace.agents[0], SIZE))
    worn = next(frames(trace, trace.agents[0], SIZE, rig))
    assert worn.shape == plain.shape and (worn != plain).any()
    brown = (worn[..., 0] > worn[..., 2] + 50) & (worn[..., 0] > 100)
    assert brown.sum() > 20  # its shirt
    assert wearers(trace.agents) == [trace.agents[0]]
