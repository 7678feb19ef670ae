"""Entities of others: they come, are corrected, misbehave, and go."""

import numpy as np
import pytest

from runtime import World
from runtime.bodies.remote_figures import RemoteDriver
from runtime.dis.enumerations import Health, LifeForm
from runtime.dis.incoming import Incoming, Limits, remote_name
from tests.runtime.dis.entities import FRAME, ORIGIN, SENDER, entity

NAME = remote_name((9, 8, 1))


def listening(graph, **limits):
    world = World(graph)
    return world, Incoming(world, FRAME, 1, (1, 1), Limits(**limits))


def run(world, incoming, packets, seconds, step=0.05, sender=SENDER):
    """Deliver ``packets``, (time, bytes) from now on, as the world goes on; the places of the first
    entity."""
    places, begun = [], world.time
    left = sorted(packets, key=lambda each: each[0])
    for _ in range(round(seconds / step)):
        now = world.time - begun
        due = [each for each in left if each[0] <= now + 1e-9]
        left = left[len(due) :]
        incoming.receive([(data, sender) for _, data in due])
        incoming.time_out()
        world.step(step)
        agent = world.agents.get(NAME)
        places.append(np.full(3, np.nan) if agent is None else agent.position)
    return np.array(places)


def walking(stamp, speed=1.5, told=None, start=2.0, **fields):
    """Along x from ``start`` at the stamp 0."""
    told = speed if told is None else told
    return entity((start + speed * stamp, 3.0, 0.0), (told, 0.0, 0.0), stamp=stamp, **fields)


def test_an_entity_comes_walks_and_times_out(graph):
    world, incoming = listening(graph)
    places = run(world, incoming, [(0.0, walking(0.0, marking=b"ada"))], 2.0)
    assert places[-1] == pytest.approx([2.0 + 1.5 * 2.0, 3.0, 0.0], abs=1e-3)
    agent = world.agents[NAME]
    driver = agent.simulated(RemoteDriver)
    assert (
        agent.body == "remote" and driver.marking == "ada" and agent.status == "remote" and not agent.moving
    )
    assert np.isnan(run(world, incoming, [], 10.2)[-1]).all() and NAME not in world.agents
    assert incoming.counts["timed out"] == 1 and world.events == []


def test_one_that_is_gone_is_taken_out_at_once(graph):
    world, incoming = listening(graph)
    run(world, incoming, [(0.0, walking(0.0)), (0.5, walking(0.5, deactivated=True))], 0.5)
    run(world, incoming, [(0.0, walking(0.6, deactivated=True))], 0.1)
    assert NAME not in world.agents and not world.agents


def test_corrections_do_not_jump(graph):
    """A metre to the side: drawn there within a second or so, without a jump or a jerk."""
    world, incoming = listening(graph)
    moved = entity((4.0, 4.0, 0.0), (1.5, 0.0, 0.0), stamp=1.0)
    places = run(world, incoming, [(0.0, walking(0.0)), (1.0, moved)], 3.0, step=0.02)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert np.abs(np.diff(steps)).max() < 0.007 and steps.max() < 0.07
    assert places[-1] == pytest.approx([7.0, 4.0, 0.0], abs=0.02)


def test_a_teleport_is_not_smoothed(graph):
    world, incoming = listening(graph)
    there = entity((18.0, 3.0, 0.0), stamp=1.0)
    places = run(world, incoming, [(0.0, walking(0.0)), (1.0, there)], 1.2)
    assert places[19][0] < 4.0 and places[20] == pytest.approx([18.0, 3.0, 0.0], abs=1e-3)


def test_late_repeated_and_reordered_packets(graph):
    """In another order and twice, half a second late or not: none is taken for newer than it is."""
    chance = np.random.default_rng(3)
    packets = []
    for k in range(20):
        data, late = walking(0.25 * k), float(chance.choice([0.0, 0.1, 0.5]))
        packets += [(0.25 * k + late, data)] * (1 + k % 2)
    world, incoming = listening(graph)
    places = run(world, incoming, packets, 5.0)
    counts = incoming.counts
    assert counts["repeated"] > 3 and counts["overtaken"] > 0
    truth = 2.0 + 1.5 * 0.05 * np.arange(1, 101)
    assert np.abs(places[40:, 0] - truth[40:]).max() < 0.2
    assert np.nanmin(np.diff(places[:, 0])) > 0.0


@pytest.mark.parametrize("begins", [3599.0, -1e4, 1234.5])
def test_clocks_may_show_what_they_like(graph, begins):
    """Also past the full hour."""
    packets = [
        (k * 0.5 + 0.1 * (k % 2), entity((2.0 + 0.75 * k, 3.0, 0.0), (1.5, 0.0, 0.0), stamp=begins + 0.5 * k))
        for k in range(8)
    ]
    world, incoming = listening(graph)
    places = run(world, incoming, packets, 4.0)
    assert places[-1][0] == pytest.approx(2.0 + 1.5 * 4.0, abs=0.05) and incoming.counts["news"] == 8


def test_a_clock_that_is_set_back_and_one_that_stands(graph):
    world, incoming = listening(graph)
    run(world, incoming, [(0.0, walking(0.0)), (1.0, entity((3.5, 3.0, 0.0), stamp=-100.0))], 1.2)
    assert incoming.counts["news"] == 2
    packets = [(k * 0.5, entity((3.5 + 0.1 * k, 3.0, 0.0), stamp=-100.0)) for k in range(1, 9)]
    assert run(world, incoming, packets, 6.0)[-1][0] == pytest.approx(4.3, abs=0.02)


@pytest.mark.parametrize("told", [0.0, -4.0])
def test_velocities_that_are_not_the_entitys_are_replaced(graph, told):
    """Its places show how fast it is: it is drawn nearer to them than the velocity told would have it."""
    packets = [(0.5 * k, walking(0.5 * k, told=told)) for k in range(12)]
    world, incoming = listening(graph)
    places = run(world, incoming, packets, 6.0)
    truth = 2.0 + 1.5 * 0.05 * np.arange(1, 121)
    assert incoming.counts["wrong velocities"] > 5
    assert np.abs(places[80:, 0] - truth[80:]).max() < 0.15


def test_velocities_that_are_right_again_are_believed(graph):
    packets = [(0.5 * k, walking(0.5 * k, told=0.0 if k < 6 else 1.5)) for k in range(14)]
    world, incoming = listening(graph)
    run(world, incoming, packets, 7.0)
    assert 2 <= incoming.counts["wrong velocities"] <= 7


def test_no_life_form_flies_by(graph):
    world, incoming = listening(graph)
    places = run(world, incoming, [(0.0, walking(0.0, told=500.0))], 0.5)
    assert places[-1][0] == pytest.approx(2.0) and incoming.counts["impossible velocities"] == 1
    run(world, incoming, [(0.0, entity((5.0, 3.0, 0.0), (300.0, 0, 0), number=2, kind=1))], 0.1)
    assert world.agents[remote_name((9, 8, 2))].simulated(RemoteDriver).look.name == "thing"


def test_somebody_elses_packets_change_nothing(graph):
    world, incoming = listening(graph)
    run(world, incoming, [(0.0, walking(0.0))], 0.5)
    before = world.agents[NAME].driver.state_hash()
    stranger = ("127.0.0.1", 4000)
    incoming.receive([(entity((9.0, 1.0, 0.0), stamp=1.0), stranger)])
    incoming.receive([(entity((9.0, 1.0, 0.0), stamp=1.0, deactivated=True), stranger)])
    assert world.agents[NAME].driver.state_hash() == before and incoming.counts["another sender"] == 2


def test_what_may_come_is_limited(graph):
    world, incoming = listening(graph, entities=5, packets=20)
    incoming.receive([(entity((3.0, 3.0, 0.0), number=k), SENDER) for k in range(1, 50)])
    assert len(world.agents) == 5
    assert incoming.counts["too many entities"] == 15 and incoming.counts["too many packets"] == 29
    incoming.receive([(entity((3.0, 3.0, 0.0), site=1, application=1), SENDER)])
    assert incoming.counts["too many packets"] == 30  # time has not gone on
    world.step(0.2)
    incoming.receive([(entity((3.0, 3.0, 0.0), site=1, application=1), SENDER)])
    incoming.receive([(entity((9e4, 3.0, 0.0), number=77), SENDER)])
    assert incoming.counts["our own"] == 1 and incoming.counts["too far away"] == 1
    incoming.leave()
    assert not world.agents and not incoming._heard and not incoming._clocks
    assert len(ORIGIN) == 3


def test_postures_and_injuries_are_shown(graph):
    world, incoming = listening(graph)
    forms = (LifeForm.KNEELING, LifeForm.PRONE, LifeForm.CROUCHING, LifeForm.STANDING)
    heights = []
    for number, form in enumerate(forms, start=1):
        run(world, incoming, [(0.0, entity((2.0 * number, 3.0, 0.0), number=number, form=form))], 0.05)
    dead = entity((4.0, 1.0, 0.0), number=9, form=LifeForm.STANDING, health=Health.FATAL)
    run(world, incoming, [(0.0, dead)], 4.0)
    for number in (1, 2, 3, 4, 9):
        heights.append(world.agents[remote_name((9, 8, number))].pose.transforms[:, 2].max())
    kneeling, prone, crouching, standing, lying = heights
    assert standing > 1.4 > kneeling > 1.0 and crouching < 1.2 and prone < 0.6 and lying < 0.5


def test_a_frozen_entity_stands_still(graph):
    world, incoming = listening(graph)
    places = run(world, incoming, [(0.0, walking(0.0)), (0.5, walking(0.5, frozen=True))], 3.0)
    assert places[-1] == pytest.approx([2.75, 3.0, 0.0], abs=0.02)


def test_a_new_gateway_takes_over_what_was_saved(graph):
    """The next packet is news; who stays silent goes."""
    world, incoming = listening(graph)
    run(world, incoming, [(0.0, walking(0.0)), (0.0, entity((8.0, 1.0, 0.0), number=2))], 1.0)
    other, anew = listening(graph)
    other.restore(world.save())
    run(other, anew, [(0.0, walking(1.0)), (9.0, walking(10.0, speed=0.5))], 12.0)
    assert list(other.agents) == [NAME] and anew.counts["timed out"] == 1
    third, silent = listening(graph)
    third.restore(world.save())
    run(third, silent, [], 12.0)
    assert not third.agents
