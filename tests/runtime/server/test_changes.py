"""Clients that are told only what has changed have the same angles as those who are told all."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from locomotion.recorded.changes import STEPS
from runtime.server.hosted import HostedWorld, skeleton
from runtime.server.messages import Changes

LEVELS = ("full", "medium", "low")


class Watcher:
    """A client that applies changes. ``told``: of each agent how many messages told of it."""

    def __init__(self):
        self.agents, self.channels, self.told, self.names = {}, {}, {}, {}

    def hear(self, text):
        message = json.loads(text)
        Changes.model_validate_json(text)
        for change in message["agents"]:
            name = change["name"]
            self.agents.setdefault(name, {}).update(change)
            if "number" in change:
                self.names[change["number"]] = name
        for number, indices, values in message["moved"]:
            name = self.names[number]
            self.channels.setdefault(name, {}).update(zip(indices, values, strict=True))
        for name in {change["name"] for change in message["agents"]} | {
            self.names[k] for k, *_ in message["moved"]
        }:
            self.told[name] = self.told.get(name, 0) + 1
        return message

    def person(self, name):
        """Position, facing, root (7,) and joint angles of a person."""
        place, turn = self.agents[name]["steps"]
        told = np.array([self.channels[name][k] for k in range(len(self.channels[name]))])
        position = place * told[:3]
        root = np.concatenate([position + place * told[4:7], 0.5 * turn * told[7:11]])
        return position, turn * told[3], root, turn * told[11:]

    def pose(self, told):
        """(n, 7) the bodies of an agent, from its skeleton as it was ``told``."""
        _, _, root, angles = self.person(told["name"])
        places = [root]
        turn = [Rotation.from_quat(places[0][3:], scalar_first=True)]
        for body in range(1, len(told["bodies"])):
            parent = told["parents"][body]
            places.append(places[parent][:3] + turn[parent].apply(told["offsets"][body]))
            own = turn[parent]
            for k, joint in enumerate(told["joints"]):
                if joint["body"] == body:
                    own = own * Rotation.from_rotvec(angles[k] * np.array(joint["axis"]))
            turn.append(own)
        return np.array(
            [[*place[:3], *r.as_quat(scalar_first=True)] for place, r in zip(places, turn, strict=True)]
        )


@pytest.fixture(scope="module")
def hosted(graph):
    return HostedWorld("world1", "small", graph, 1, True)


@pytest.fixture
def watching(hosted):
    """Makes clients."""
    before = dict(hosted.clients)

    def join():
        client = type("Client", (), {})()
        hosted.join("changes")
        hosted.begin(client, "changes")
        return client, Watcher()

    yield join
    for agent in list(hosted.world.agents):
        hosted.remove(agent)
    hosted.clients = before


def test_a_client_that_applies_changes_has_what_a_late_one_is_told_whole(hosted, watching):
    first, early = watching()
    for k, level in enumerate(LEVELS):
        hosted.spawn("human", (2.0, 1.0 + 1.5 * k, 0.0), 0.0, level, level)
    hosted.spawn("dog", (2.0, 5.3, 0.0), 0.0, "rex")
    hosted.step(0.0)
    for name in hosted.world.agents:
        hosted.go_to(name, [(9.0, float(hosted.world.agents[name].position[1]), 0.0)], 1.2, None)
    for k in range(60):
        hosted.step(0.03)
        early.hear(hosted.state_for(first))
        if k == 20:
            hosted.world.agents["low"].detail = "medium"
        if k == 30:
            hosted.world.agents["low"].detail = "low"
    second, late = watching()
    early.hear(hosted.state_for(first))
    whole = late.hear(hosted.state_for(second))
    assert [each["name"] for each in whole["agents"]] == [*LEVELS, "rex"]
    assert late.agents == early.agents and late.channels == early.channels
    assert early.told["low"] < 0.7 * early.told["full"]  # 15 times a second, at 33 states
    hosted.step(0.2)  # everybody's moment has come
    early.hear(hosted.state_for(first))
    for level, step in zip(LEVELS, STEPS, strict=True):
        agent = hosted.world.agents[level]
        position, facing, _, angles = early.person(level)
        assert np.abs(position - agent.position).max() < (0.0051 if level == "low" else 0.0021)
        assert abs(facing - agent.facing) < 0.51 * step
        assert np.abs(angles - agent.driver.joint_pose()[7:]).max() < 0.51 * step
        there = early.pose(skeleton(agent))
        off = np.linalg.norm(there[:, :3] - agent.pose.transforms[:, :3], axis=1)
        assert off.max() < 2.0 * step + 1e-3, level
    np.testing.assert_allclose(
        np.reshape(early.agents["rex"]["transforms"], (-1, 7)),
        hosted.world.agents["rex"].pose.transforms, atol=1e-4,
    )  # fmt: skip


def test_who_stands_still_costs_nothing_and_a_new_one_of_the_same_name_is_told_whole(hosted, watching):
    client, watcher = watching()
    hosted.spawn("human", (2.0, 3.0, 0.0), 0.0, "ada", "low")
    hosted.step(1.0)
    watcher.hear(hosted.state_for(client))
    told = watcher.told["ada"]
    hosted.step(0.5)
    message = watcher.hear(hosted.state_for(client))
    assert message["time"] == pytest.approx(hosted.world.time)
    assert message["agents"] == [] and message["moved"] == []
    hosted.world.agents["ada"].hold("rifle")
    hosted.step(1.2)
    watcher.hear(hosted.state_for(client))
    assert watcher.agents["ada"]["holds"] == "rifle deployed" and watcher.told["ada"] == told + 1
    hosted.remove("ada")
    hosted.spawn("human", (4.0, 3.0, 0.0), 0.0, "ada", "low")
    hosted.step(0.1)
    (change,) = watcher.hear(hosted.state_for(client))["agents"]
    assert watcher.person("ada")[0][0] == pytest.approx(4.0, abs=0.01) and change["holds"] == ""
    assert len(watcher.channels["ada"]) == 50


def test_a_world_that_goes_back_is_told_as_it_was(hosted, watching):
    client, watcher = watching()
    hosted.spawn("human", (2.0, 3.0, 0.0), 0.0, "ada", "low")
    hosted.step(0.1)
    watcher.hear(hosted.state_for(client))
    before = dict(watcher.channels["ada"])
    hosted.save()
    hosted.go_to("ada", [(5.0, 3.0, 0.0)], 1.2, None)
    hosted.step(0.5)
    watcher.hear(hosted.state_for(client))
    assert watcher.channels["ada"] != before
    hosted.restore()
    watcher.hear(hosted.state_for(client))
    assert watcher.channels["ada"] == before


def test_states_are_told_as_before(hosted, watching):
    hosted.spawn("walker", (2.0, 3.0, 0.0), 0.0, "tom")
    hosted.join("places")
    (tom,) = json.loads(hosted.state("places"))["agents"]
    assert tom["holds"] == "" and "transforms" not in tom
    assert skeleton(hosted.world.agents["tom"])["joints"] == []
