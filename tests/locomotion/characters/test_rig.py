"""The public face: poses in the world and relative to the parents, batches, simpler figures, wrong input."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion import LocomotionError, Rig
from locomotion.body.person import BODY_NAMES
from locomotion.characters.character_file import UPRIGHT
from locomotion.characters.local_poses import local_poses
from locomotion.characters.whole_person import whole_person
from locomotion.recorded.skeletons import LEVELS, skeleton
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, node_places
from tests.locomotion.characters.persons import places_of, postures, running


def agent_of(places, names=BODY_NAMES, **more):
    return SimpleNamespace(pose=SimpleNamespace(transforms=places, names=names), **more)


@pytest.mark.parametrize("who", ["stout", "tall", "agent"])
def test_local_poses_are_those_of_the_files_nodes(rigs, files, who):
    """With them as the nodes' transforms, the scene of the file shows the bones where the pose says."""
    rig, place = rigs[who], running()[7]
    agent = agent_of(place)
    local = rig.local_pose(agent)
    document = Document(files[who])
    for b, node in enumerate(rig.skeleton.nodes):
        there = document.json["nodes"][int(node)]
        there["translation"] = local[b, :3].tolist()
        there["rotation"] = local[b, [4, 5, 6, 3]].tolist()
    nodes = document.json["nodes"]
    placed = node_places(document, nodes, node_order(document, nodes))[rig.skeleton.nodes]
    pose = rig.pose(agent)
    np.testing.assert_allclose(placed[:, :3, 3] @ UPRIGHT.T, pose[:, :3], atol=1e-6)
    axes = UPRIGHT @ placed[:, :3, :3] / rig.skeleton.scales[:, None, None]
    wanted = Rotation.from_quat(pose[:, 3:], scalar_first=True).as_matrix()
    np.testing.assert_allclose(axes, wanted, atol=1e-6)
    np.testing.assert_allclose(rig.local(rig.rest)[:, :3], _file_translations(files[who], rig), atol=1e-6)


def _file_translations(file, rig):
    nodes = Document(file).json["nodes"]
    return np.array([nodes[int(node)]["translation"] for node in rig.skeleton.nodes])


def test_many_at_a_time_are_as_one_by_one(rigs):
    places = running()[:12]
    for rig in rigs.values():
        every = rig.pose_from(places.reshape(3, 4, 20, 7))
        assert every.shape == (3, 4, len(rig.names), 7)
        np.testing.assert_array_equal(every[1, 2], rig.pose_from(places[6]))
        np.testing.assert_array_equal(every[1, 2], rig.pose(agent_of(places[6])))
        assert rig.local(every).shape == every.shape
        out = np.empty((1, len(rig.names), 7))
        skeleton = rig.skeleton
        local_poses(skeleton.parents, skeleton.above, skeleton.above_scales, every[1, 2][None], out)
        np.testing.assert_array_equal(out[0], rig.local(every)[1, 2])


@pytest.mark.parametrize("level", LEVELS)
def test_simpler_figures(rigs, level):
    """The bodies that medium and low figures have are enough: what they lack is held straight."""
    simpler = skeleton(level)
    rng = np.random.default_rng(3)
    channels, roots = rng.uniform(-0.4, 0.4, (5, len(simpler.channels))), np.zeros((5, 7))
    roots[:, [2, 3]] = 0.9, 1.0
    whole = places_of(simpler.as_qpos(channels, roots))
    own = whole[:, [BODY_NAMES.index(name) for name in simpler.bodies]]
    np.testing.assert_allclose(whole_person(own, simpler.bodies), whole, atol=1e-9)
    for rig in rigs.values():
        np.testing.assert_allclose(rig.pose_from(own, simpler.bodies), rig.pose_from(whole), atol=1e-9)


def test_a_missing_waist_is_halfway():
    place = postures()["sit"]
    names = [name for name in BODY_NAMES if name != "waist"]
    found = whole_person(place[None, [BODY_NAMES.index(name) for name in names]], names)[0]
    ends = Rotation.from_quat(place[[0, 2], 3:], scalar_first=True)
    middle = Rotation.from_quat(found[1, 3:], scalar_first=True)
    assert (ends[0].inv() * middle).magnitude() == pytest.approx((middle.inv() * ends[1]).magnitude())


def test_what_an_agent_holds_is_held(rigs):
    rig, place = rigs["stout"], running()[5]
    holding = agent_of(place, held=("rifle", "deployed"))
    np.testing.assert_array_equal(rig.pose(holding), rig.pose_from(place, grip=1.0))
    np.testing.assert_array_equal(rig.pose(agent_of(place, held=("rifle", "stowed"))), rig.pose_from(place))


def test_wrong_input_is_refused(rigs):
    rig, place = rigs["stout"], running()[0]
    with pytest.raises(LocomotionError, match="shows persons; this body has no right_thigh"):
        rig.pose(agent_of(np.zeros((3, 7)), ("pelvis", "spine_1", "head")))
    with pytest.raises(LocomotionError, match=r"give \(\.\.\., 20, 7\)"):
        rig.pose_from(place[:5])
    with pytest.raises(LocomotionError, match="right and the left hand"):
        rig.pose_from(place, hands=(1.0, 2.0, 3.0))
    with pytest.raises(LocomotionError, match="give 0 to 1 for each person"):
        rig.pose_from(place, grip=(1.0, 0.0))
    with pytest.raises(LocomotionError, match="the pose has the shape"):
        rig.local(place[:3])
    assert "24 bones" in repr(rig) and isinstance(rig, Rig)
