"""What is asked of the server is done, or refused with the reason."""

import numpy as np
import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from tests.runtime.server.serving import talk


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"type": "spawn", "world": "x", "body": "dog", "at": [0, 0, 0]}, "no world 'x'"),
        ({"type": "create", "level": "large"}, "valid: small"),
        ({"type": "create"}, "create.level"),
        ({"type": "fly"}, "tag"),
        ({"type": "step", "world": "world1", "dt": -1}, "step.dt"),
        ({"type": "step", "world": "world1", "dt": 0.1}, "runs by itself"),
        ({"type": "spawn", "world": "world1", "body": "goose", "at": [2, 3, 0]}, "'human'"),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": [2, 3]}, "spawn.at"),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": [2, 3, 0], "size": 3}, "spawn.size"),
        ({"type": "go_to", "world": "world1", "agent": "ada", "points": [[2, 3, 0]]}, "no agent 'ada'"),
        ({"type": "restore", "world": "world1"}, "has not been saved"),
        ({"type": "hello", "version": 2}, "already"),
        (
            {"type": "spawn", "world": "world1", "body": "goose.yaml", "at": [2, 3, 0]},
            "spawn.body.*'human'",
        ),
        (
            {"type": "spawn", "world": "world1", "body": "./dog", "at": [2, 3, 0]},
            "spawn.body.*'human'",
        ),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": [True, 3, 0]}, "spawn.at.0: .*number"),
        ({"type": "spawn", "world": "world1", "body": "dog", "at": ["2", 3, 0]}, "spawn.at.0: .*number"),
        (
            {"type": "spawn", "world": "world1", "body": "dog", "at": [2, 3, 0], "facing": False},
            "facing: .*number",
        ),
        ({"type": "step", "world": "world1", "dt": True}, "step.dt: .*number"),
        ({"type": "step", "world": "world1", "dt": "0.1"}, "step.dt: .*number"),
        ({"type": "create", "level": "small", "seed": "1"}, "seed: .*integer"),
        ({"type": "create", "level": "small", "seed": 1.0}, "seed: .*integer"),
        ({"type": "create", "level": "small", "seed": True}, "seed: .*integer"),
        ({"type": "go_to", "world": "world1", "agent": "ada", "points": {"0": [2, 3, 0]}}, "points: .*array"),
        ({"type": "go_to", "world": "world1", "agent": 5, "points": [[2, 3, 0]]}, "agent: .*string"),
        ({"type": "leave", "world": ["world1"]}, "world: .*string"),
    ],
)
def test_refuses_and_says_why(graph, request_, says):
    async def conversation(server, join, port):
        client = await join()
        await client.ask("create", level="small")
        with pytest.raises(ValueError, match=says):
            fields = dict(request_)
            await client.ask(fields.pop("type"), **fields)
        await client.ask("level", level="small")

    talk(graph, conversation)


def test_clients_act_only_in_worlds_that_they_joined(graph):
    async def conversation(server, join, port):
        first, second = await join(), await join()
        world = (await first.ask("create", level="small", clock="manual"))["world"]
        await first.ask("spawn", world=world, body="dog", at=[2, 3, 0], name="rex")
        for kind, fields in (
            ("step", {"dt": 0.1}), ("remove", {"agent": "rex"}), ("save", {}), ("restore", {}), ("close", {}),
            ("spawn", {"body": "dog", "at": [4, 3, 0]}), ("go_to", {"agent": "rex", "points": [[4, 3, 0]]}),
            ("stop", {"agent": "rex"}), ("way", {"agent": "rex"}),
        ):  # fmt: skip
            with pytest.raises(ValueError, match="join it first"):
                await second.ask(kind, world=world, **fields)
        await second.ask("join", world=world)
        assert (await second.ask("step", world=world, dt=0.1))["ticks"] == 10

    talk(graph, conversation)


def test_people_take_postures_hold_things_and_are_seen_from_somewhere(graph):
    async def conversation(server, join, port):
        client = await join()
        world = (await client.ask("create", level="small", clock="manual"))["world"]
        await client.ask("spawn", world=world, body="human", at=[2, 3, 0], name="ada", detail="low")
        await client.ask("hold", world=world, agent="ada", object="rifle")
        await client.ask("step", world=world, dt=1.0)
        await client.ask("posture", world=world, agent="ada", posture="kneel")
        await client.ask("viewers", world=world, viewers=[{"position": [0, 3, 1.7]}])
        await client.ask("step", world=world, dt=1.0)
        await client.ask("step", world=world, dt=0.5)
        told = [each["event"] for each in client.told if each["type"] == "event"]
        assert [(e["posture"], e["holds"]) for e in told if e["kind"] == "PostureReached"] == [
            ("stand", "rifle deployed"), ("kneel", "rifle deployed")
        ]  # fmt: skip
        state = client.states[world]["agents"][0]
        assert (state["level"], state["posture"]) == ("low", "kneel")
        await client.ask("detail", world=world, agent="ada", detail="full")
        for kind, fields, says in (
            ("posture", {"posture": "fly"}, "valid: stand"),
            ("hold", {"object": "rifle", "state": "broken"}, "valid: stowed"),
            ("detail", {"detail": "high"}, "detail.detail"),
        ):
            with pytest.raises(ValueError, match=says):
                await client.ask(kind, world=world, agent="ada", **fields)

    talk(graph, conversation)


def test_a_person_is_pushed(graph):
    async def conversation(server, join, port):
        client = await join()
        world = (await client.ask("create", level="small", clock="manual"))["world"]
        await client.ask("spawn", world=world, body="human", at=[2, 3, 0], name="ada")
        await client.ask("push", world=world, agent="ada", force=[0, 120, 0], seconds=0.2)
        human = server._worlds.hosted[world].world.agents["ada"].human
        assert human.data.xfrc_applied.max() == 120.0
        with pytest.raises(ValueError, match="seconds"):
            await client.ask("push", world=world, agent="ada", force=[0, 120, 0], seconds=99)

    talk(graph, conversation)


def test_a_style_is_worn_and_another_size_is_told(graph):
    async def conversation(server, join, port):
        client = await join()
        world = (await client.ask("create", level="small", clock="manual"))["world"]
        await client.ask("spawn", world=world, body="human", at=[2, 3, 0], name="ada", detail="low")
        await client.ask("spawn", world=world, body="human", at=[4, 3, 0], name="bob")
        await client.ask("style", world=world, agent="ada", traits={"arms": 1.5, "lean": 0.1})
        await client.ask("style", world=world, agent="ada", traits={"size": 0.9})
        traits = server._worlds.hosted[world].world.agents["ada"].driver.traits
        assert [traits[name] for name in ("arms", "lean", "size")] == [1.5, 0.1, 0.9]
        await client.ask("style", world=world, agent="bob", traits={"size": 1.05})
        ada, bob, smaller, taller = [each["agent"] for each in client.told if each["type"] == "agent"]
        assert (smaller["name"], taller["name"]) == ("ada", "bob")
        np.testing.assert_allclose(smaller["offsets"], 0.9 * np.array(ada["offsets"]), atol=2e-5)
        np.testing.assert_allclose(taller["offsets"], 1.05 * np.array(bob["offsets"]), atol=2e-5)
        for agent, wrong, says in (
            ("ada", {"self": 1.0}, "trait 'self': valid: phase"), ("ada", {"lean": 2.0}, "from -0.2 to 0.3"),
            ("ada", {"lean": "much"}, "valid number"), ("ada", {}, "at least 1"),
            ("bob", {"size": 1.3}, "from 0.8 to 1.2"),
        ):  # fmt: skip
            with pytest.raises(ValueError, match=says):
                await client.ask("style", world=world, agent=agent, traits=wrong)

    talk(graph, conversation)
