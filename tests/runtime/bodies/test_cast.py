"""Bodies that are drawn together: all of them, or those whose turn it is."""

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
    assert Cast([walker._driver]).transforms(0.0, 1.0)[0] == range(1)
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
