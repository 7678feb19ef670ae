"""A person takes over the future that it has rehearsed: exactly what it would have been, and less work."""

import numpy as np
import pytest

from locomotion import Human

WAY = np.array([[0.0, 0.0, 0.0], [22.0, 0.0, 0.0]])


def slowing_down(takes_over: bool) -> Human:
    """A person that has just begun to slow down to a walk; ``takes_over``: what it has rehearsed."""
    human = Human()
    if not takes_over:
        human.decider.predicted.expect = lambda *_: None  # type: ignore[method-assign]
    human.reset(WAY[0], 0.0, speed=3.0)
    human.follow(WAY, 3.0)
    while human.gait_now != "slow run":
        human.tick()
    return human


def nothing(_: Human) -> None:
    pass


def push(human: Human) -> None:
    human.data.xfrc_applied[human.index.chest, 1] = 60.0


def shove(human: Human) -> None:
    human.data.qvel[1] += 0.2


def told_to_go_on(human: Human) -> None:
    human.follow([human.position, [30.0, 2.0, 0.0]], 3.0)


def told_to_stop(human: Human) -> None:
    human.stop()


def held_up(human: Human) -> None:
    human.give_way(0.5, None)


def sent_back(human: Human) -> None:
    before = human.save_state()
    for _ in range(40):
        human.tick()
    human.restore_state(before)


DISTURBANCES = [nothing, push, shove, told_to_go_on, told_to_stop, held_up, sent_back]


@pytest.mark.parametrize("disturb", DISTURBANCES, ids=lambda each: each.__name__)
@pytest.mark.parametrize("after", [30, 260])
def test_it_goes_as_it_would_without(disturb, after):
    hashes, events = [], []
    for takes_over in (True, False):
        human, seen = slowing_down(takes_over), []
        for tick in range(after + 400):
            if tick == after:
                disturb(human)
            if tick == after + 12:
                human.data.xfrc_applied[:] = 0.0
            human.tick()
            seen.append(human.state_hash())
        hashes.append(seen)
        events.append(human.events)
    assert hashes[0] == hashes[1]
    assert events[0] == events[1]


def test_it_is_simulated_once(monkeypatch):
    human, simulated = slowing_down(True), []
    monkeypatch.setattr(human.on_feet, "tick", lambda *_: simulated.append(1))
    while human.gait_now == "slow run":
        human.tick()
    assert human.gait_now == "walk" and not simulated
    assert human.follower.memory.any()
