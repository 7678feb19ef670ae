"""Bodies that are drawn together: all of them, or those whose turn it is."""

import warnings

import numpy as np
import pytest

from runtime import RuntimeInputError, World
from runtime.bodies.cast import Cast


def test_whose_turn_it_is_is_drawn_as_among_all(graph):
    world = World(graph)
    levels = ("physics", "full", "medium", "low", "low", "low")
    people = [
        world.spawn("human", (2.0 + k, 3.0, 0.0), detail=level, name=f"{level}{k}")
        for k, level in enumerate(levels)
    ]
    walker = world.spawn("walker", (2.0, 4.0, 0.0))
    assert Cast([walker._driver]).transforms(np.zeros(1), 1.0)[0] == range(1)
    counts = dict.fromkeys(world.agents, 0)
    for _ in range(60):
        since = world.time
        world.step(1 / 60)
        due, everybody = world.transforms(since=since), world.transforms()
        assert list(everybody) == list(world.agents)
        for name, places in due.items():
            counts[name] += 1
            assert places.tobytes() == everybody[name].tobytes()
    assert counts[people[0].name] == counts[people[1].name] == counts[walker.name] == 60
    assert abs(counts["medium2"] - 30) <= 1 and all(abs(counts[f"low{k}"] - 15) <= 1 for k in (3, 4, 5))
    people[3].detail = "full"
    world.remove(people[4])
    assert set(world.transforms()) == set(world.agents)
    assert np.array_equal(world.transforms()["low3"], people[3].pose.transforms)
    with pytest.raises(RuntimeInputError, match="since"):
        world.transforms(since=float("nan"))


def test_who_is_new_or_changed_is_drawn_at_once(graph):
    world = World(graph)
    people = [world.spawn("human", (2.0 + k, 3.0, 0.0), detail="low", name=f"low{k}") for k in range(3)]
    assert len(world.transforms(since=0.0)) == 3  # the first time
    world.step(0.5)
    for k in range(3):
        since = world.time
        world.transforms()
        name = world.spawn("human", (2.0 + k, 4.0, 0.0), detail="low").name
        people[k].detail = "medium"
        due = world.transforms(since=since)
        assert {name, people[k].name} <= set(due) and len(due) == 2
        world.step(0.1)  # a turn of everybody's
    assert len(world.transforms(since=world.time + 1.0)) == 6
    assert world.transforms(since=world.time) == {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(world.transforms(since=-1e308)) == len(world.transforms(since=1e308)) == 6


def test_after_a_restore_everybody_is_drawn_once(graph):
    world, other = World(graph), World(graph)
    for k in range(3):
        world.spawn("human", (2.0 + k, 3.0, 0.0), detail="low")
    early = world.save()
    world.step(1.0)
    world.transforms()
    for each in (world, other):
        each.restore(early)
        each.step(0.99)
        assert len(each.transforms(since=0.98)) == 3  # asked before the restore
        assert len(each.transforms(since=0.99)) == 0
    due = []
    for each in (world, other):
        due.append([set(each.transforms(since=each.time - 0.01)) for _ in range(20) if each.step(0.01)])
    assert due[0] == due[1] and set.union(*due[0]) == set(world.agents)


def test_whose_turn_it_is_does_not_depend_on_who_leaves(graph):
    world = World(graph)
    people = [world.spawn("human", (2.0 + k, 3.0, 0.0), detail="low") for k in range(6)]
    last, waits = people[-1].name, [0]
    for k in range(40):
        since = world.time
        world.step(0.01)
        waits.append(0 if last in world.transforms(since=since) else waits[-1] + 1)
        if k % 6 == 5 and len(people) > 1:
            world.remove(people.pop(0))
    assert max(waits) <= 7
