"""When our agents are told of, and as what."""

import numpy as np
import pytest

from runtime import World
from runtime.dis.appearance import Appearance
from runtime.dis.dead_reckoning import MODELS, Motion, reckoned
from runtime.dis.enumerations import LifeForm
from runtime.dis.outgoing import Identity, Outgoing, Thresholds
from tests.runtime.dis.entities import FRAME


def talking(graph, **limits):
    world = World(graph, seed=2)
    outgoing = Outgoing(world, FRAME, Identity(1, 2, 3), Thresholds(**limits), seed=4)
    return world, outgoing


def told(world, outgoing, seconds, step=0.05):
    """Time and record of all that is told."""
    found = []
    for _ in range(round(seconds / step)):
        world.step(step)
        found += [(world.time, record) for record in outgoing.due()]
    return found


def test_who_stands_is_told_of_every_five_seconds_or_so(graph):
    world, outgoing = talking(graph)
    world.spawn("walker", (2.0, 3.0, 0.0), facing=1.0, name="a long name of somebody")
    times = [time for time, _ in told(world, outgoing, 60.0)]
    gaps = np.diff(times)
    assert times[0] == 0.05 and len(set(np.round(gaps, 3))) > 3
    assert 4.49 <= gaps.min() < 4.9 and 5.1 < gaps.max() <= 5.56


def test_what_is_told(graph):
    world, outgoing = talking(graph)
    agent = world.spawn("walker", (2.0, 3.0, 0.0), facing=1.0, name="a long name")
    ((_, record),) = told(world, outgoing, 0.05)
    assert (record["site"], record["application"], record["exercise"], record["entity"]) == (1, 2, 3, 1)
    assert record["type"].item() == (3, 1, 0, 130, 0, 0, 0) and record["marking"] == b"a long name"
    assert FRAME.to_level(record["location"][None])[0] == pytest.approx(agent.position, abs=1e-6)
    ahead = FRAME.rotations(record["orientation"][None].astype(float))[0, :, 0]
    assert ahead == pytest.approx([np.cos(1.0), np.sin(1.0), 0.0], abs=1e-6)
    assert Appearance.of(int(record["appearance"])) == Appearance(LifeForm.STANDING)
    assert record["algorithm"] == MODELS.index("static")


def test_a_receiver_is_never_off_by_more_than_the_threshold(graph):
    """By what it was told, reckoned as a receiver does."""
    world, outgoing = talking(graph, position=0.5)
    agent = world.spawn("walker", (2.0, 3.0, 0.0))
    agent.go_to([(9.0, 1.0, 0.0), (3.0, 5.0, 0.0), (9.0, 5.0, 0.0)], speed=2.0)
    motion, since, worst, count = None, 0.0, 0.0, 0
    while agent.moving:
        world.step(0.01)
        for record in outgoing.due():
            rows = record[None] if record.ndim == 0 else np.array([record])
            motion = Motion(
                rows["algorithm"].astype(int), FRAME.to_level(rows["location"].astype(float)),
                FRAME.rotations(rows["orientation"].astype(float)),
                FRAME.vectors_to_level(rows["velocity"].astype(float)), np.zeros((1, 3)),
                rows["angular_velocity"].astype(float),
            )  # fmt: skip
            since, count = world.time, count + 1
        there = reckoned(motion, np.array([world.time - since]))[0][0]
        worst = max(worst, float(np.linalg.norm(there - agent.position)))
    assert 0.4 < worst <= 0.5 + 1e-6 and count < 10 * world.time


def test_changes_of_appearance_are_told_at_once_and_the_end(graph):
    world, outgoing = talking(graph)
    agent = world.spawn("walker", (2.0, 3.0, 0.0))
    told(world, outgoing, 1.0)
    agent.go_to((9.0, 3.0, 0.0), speed=1.2)
    forms = [record["appearance"] for _, record in told(world, outgoing, 1.0)]
    assert Appearance(LifeForm.WALKING).bits in forms
    agent.remove()
    ((_, last),) = told(world, outgoing, 0.5)
    assert Appearance.of(int(last["appearance"])).deactivated and (last["velocity"] == 0.0).all()
    world.spawn("dog", (4.0, 3.0, 0.0))
    ((_, first),) = told(world, outgoing, 0.05)
    assert first["entity"] == 2 and first["type"].item() == (3, 1, 0, 200, 0, 0, 1)
    assert len(outgoing.leave()) == 1 and len(outgoing.leave()) == 0


def test_equal_worlds_tell_the_same_and_a_restored_one_goes_on(graph):
    runs = []
    for _ in range(2):
        world, outgoing = talking(graph)
        world.spawn("walker", (2.0, 3.0, 0.0)).go_to((9.0, 5.0, 0.0), speed=1.4)
        runs.append([(time, record.tobytes()) for time, record in told(world, outgoing, 3.0)])
    assert runs[0] == runs[1] and len(runs[0]) > 2
    saved = world.save()
    told(world, outgoing, 1.0)
    world.restore(saved)
    assert len(outgoing.due()) == 1  # told anew


def test_types_of_ones_own():
    identity = Identity(1, 2, 3, types={"dog": (3, 1, 225, 200, 9, 0, 0)})
    assert identity.type_of("dog")[4] == 9 and identity.type_of("human")[3] == 130
    assert identity.type_of("wolf.yaml")[3:] == (200, 0, 0, 0)
