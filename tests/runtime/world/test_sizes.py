"""People of a world have sizes by chance, the same for the same seed and place."""

import numpy as np
import pytest

from runtime import RuntimeInputError, World
from runtime.world.sizes import Sizes


def test_sizes_fill_their_range_and_depend_on_seed_and_place_only():
    sizes = Sizes.checked([0.88, 1.08], 4)
    places = np.random.default_rng(1).uniform(0.0, 50.0, (400, 3))
    drawn = np.array([sizes.at(place) for place in places])
    assert drawn.min() == 0.88 and drawn.max() == 1.08 and np.unique(drawn).size == 21
    assert drawn.mean() == pytest.approx(0.98, abs=0.01)
    assert [sizes.at(place) for place in places] == drawn.tolist()
    other = Sizes.checked((0.88, 1.08), 5)
    assert np.mean([other.at(place) for place in places] == drawn) < 0.15
    assert sizes.vary and not Sizes.checked((1, 1), 4).vary


@pytest.mark.parametrize(
    "wrong", [(0.7, 1.0), (1.1, 0.9), (0.9, 1.3), (0.9,), 0.9, ("a", 1.0), (0.9, float("nan"))]
)
def test_what_are_no_sizes_is_refused(graph, wrong):
    with pytest.raises(RuntimeInputError, match=r"sizes must be the least and the greatest, from 0.8 to 1.2"):
        World(graph, sizes=wrong)


@pytest.mark.parametrize("detail", ["physics", "full"])
def test_who_is_spawned_has_one_and_keeps_it(graph, detail):
    world = World(graph, seed=3, sizes=(0.9, 1.06), rehearsals=0)
    people = [world.spawn("human", (1.5 + 1.5 * k, 3.0, 0.0), detail=detail) for k in range(4)]
    world.spawn("walker", (2.0, 5.0, 0.0))
    sizes = [agent.driver.traits["size"] for agent in people]
    assert len(set(sizes)) > 1 and all(0.9 <= size <= 1.06 for size in sizes)
    heights = np.array([agent.pose.transforms[:, 2].max() for agent in people])
    assert np.ptp(heights / sizes) < 0.05
    twin = World(graph, seed=3, rehearsals=0)
    twin.restore(world.save())
    assert twin.state_hash() == world.state_hash()
    assert [twin.agents[agent.name].driver.traits["size"] for agent in people] == sizes
