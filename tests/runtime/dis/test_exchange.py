"""Two worlds in one exercise, without a network."""

import numpy as np
import pytest

from benchmarks.dis_figures import original, seen
from runtime import RuntimeInputError, World, WorldState
from runtime.dis import Exchange, Limits, Options, Place, Thresholds
from runtime.dis.entity_state import decode
from runtime.dis.timestamps import is_absolute
from tests.runtime.dis.entities import ORIGIN, SENDER, entity


def test_two_worlds_show_each_others_figures(graph, tmp_path):
    worlds = [World(graph), World(graph)]
    exchanges = [Exchange(world, Place(1, k, 1), ORIGIN) for k, world in enumerate(worlds)]
    worlds[0].spawn("walker", (2.0, 3.0, 0.0), name="ada").go_to((9.0, 3.0, 0.0), speed=1.5)
    worlds[1].spawn("dog", (9.0, 1.0, 0.0), name="rex")
    for _ in range(60):
        for world in worlds:
            world.step(1 / 60)
        sent = [exchange.send() for exchange in exchanges]
        for k, exchange in enumerate(exchanges):
            exchange.receive([(data, SENDER) for data in sent[1 - k]])
    ada, rex = worlds[1].agents["dis:1:0:1"], worlds[0].agents["dis:1:1:1"]
    assert np.linalg.norm(ada.position - worlds[0].agents["ada"].position) < 1.0
    assert rex.figure.bodies == worlds[1].agents["rex"].figure.bodies
    assert list(worlds[0].agents) == ["ada", "dis:1:1:1"]
    saved = worlds[1].save()
    saved.write(tmp_path / "state.npz")
    worlds[1].step(1.0)
    other = World(graph)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    other.step(1.0)
    assert other.state_hash() == worlds[1].state_hash()
    assert np.array_equal(other.agents["dis:1:0:1"].pose.transforms, ada.pose.transforms)
    exchanges[1].receive([(data, SENDER) for data in exchanges[0].leave()])
    assert "dis:1:0:1" not in worlds[1].agents and list(worlds[0].agents) == ["ada"]


def test_timestamps_are_the_worlds_or_absolute(graph):
    for absolute in (False, True):
        world = World(graph)
        world.spawn("walker", (2.0, 3.0, 0.0))
        exchange = Exchange(world, Place(1, 1, 1), ORIGIN, Options(absolute=absolute, version=6))
        world.step(0.5)
        (data,) = exchange.send()
        stamp = int(decode(data).record["timestamp"])
        assert is_absolute(stamp) is absolute and decode(data).record["version"] == 6
        assert absolute or stamp >> 1 == round(0.5 / 3600 * 2**31)


def test_a_remote_figure_stays_near_its_original(graph):
    """A walker that goes to and fro, at the default thresholds; the benchmark takes people
    and a whole level. And a fifth of the packets lost."""
    run = original(graph, ("walker",), seconds=12.0, seed=2)
    whole, lossy = seen(run, 0.0, seed=1), seen(run, 0.2, seed=1, check_jumps=False)
    assert np.nanpercentile(whole.errors, 95) <= Thresholds().position + 0.05
    assert whole.root <= 0.03 and whole.joint <= np.radians(5.0)
    assert whole.packets * 20 <= run.seconds * 100
    assert lossy.packets < whole.packets and np.nanmax(lossy.errors) < 5.0


def test_a_walker_goes_round_an_entity(graph):
    world = World(graph)
    exchange = Exchange(world, Place(1, 1, 1), ORIGIN)
    exchange.receive([(entity((5.0, 3.0, 0.0)), SENDER)])
    walker = world.spawn("walker", (2.0, 3.0, 0.0))
    walker.go_to((9.0, 3.0, 0.0), speed=1.5)
    nearest = np.inf
    while walker.moving and world.time < 11.0:
        world.step(0.1)
        nearest = min(nearest, float(np.linalg.norm(walker.position[:2] - [5.0, 3.0])))
    assert walker.status == "arrived" and nearest > walker.radius + 0.25


def test_no_orders_are_taken(graph):
    world = World(graph)
    Exchange(world, Place(1, 1, 1), ORIGIN).receive([(entity((5.0, 3.0, 0.0)), SENDER)])
    (agent,) = world.agents.values()
    with pytest.raises(RuntimeInputError, match="moved by another simulator"):
        agent.go_to((2.0, 3.0, 0.0))
    agent.stop()
    with pytest.raises(RuntimeInputError, match="comes in from another simulator"):
        world.spawn("remote", (2.0, 3.0, 0.0))
    with pytest.raises(RuntimeInputError, match="is taken or empty"):
        world.admit("remote", agent.name, agent.driver.save())


@pytest.mark.parametrize(
    ("place", "says"), [((-1, 1, 1), "site"), ((1, 65535, 1), "application"), ((1, 1, 0), "exercise"),
                        ((1, True, 1), "application")],
)  # fmt: skip
def test_numbers_out_of_range_are_refused(place, says):
    with pytest.raises(RuntimeInputError, match=says):
        Place(*place)


def test_options_are_checked():
    for options, says in (
        ({"version": 4}, "version 4: valid: 5, 6, 7"),
        ({"types": {"dog": (1, 2)}}, "'dog'"),
    ):
        with pytest.raises(RuntimeInputError, match=says):
            Options(**options)
    assert Options().limits == Limits()
