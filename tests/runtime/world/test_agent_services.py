"""Time that is simulated in whole ticks, and what is left of a frame."""

import pytest

from runtime import World
from runtime.world.agent_services import Clock


def test_steps_of_any_length_make_whole_ticks(graph):
    world = World(graph)
    made = sum(world.step(1 / 60) for _ in range(60))
    assert made == 100
    assert world.time == pytest.approx(1.0)
    assert world.step(0.004) == 0
    assert world.step(0.004) == 0
    assert world.step(0.004) == 1
    assert world.step(0.0) == 0
    assert sum(world.step(1e-4) for _ in range(1000)) == 10


def test_time_is_counted_in_ticks_of_ten_milliseconds():
    assert Clock(ticks=150).time == pytest.approx(1.5)


@pytest.mark.parametrize(("owed", "blend"), [(0.0, 0.0), (0.0025, 0.25), (0.01, 1.0), (0.5, 1.0)])
def test_what_is_owed_is_a_share_of_the_next_tick(owed, blend):
    assert Clock(owed=owed).blend == pytest.approx(blend)
