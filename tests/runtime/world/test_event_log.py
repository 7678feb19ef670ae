"""Events are kept until they are read, and told to those who listen."""

import pytest

from runtime import Blocked, Departed, Event, RuntimeInputError, World
from runtime.events import Arrived
from runtime.world import event_log
from runtime.world.event_log import EventLog


def test_callbacks_hear_what_polling_tells(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    heard: list[Event] = []
    departures: list[Departed] = []
    stop = world.listen(heard.append)
    world.listen(departures.append, Departed)
    agent.go_to((4.0, 3.0, 0.0), speed=1.2)
    assert heard == []  # told by step, at the end of a tick
    while agent.moving:
        world.step(0.1)
    polled = world.events
    assert [event.kind for event in polled] == ["Departed", "Arrived"]
    assert heard == polled and departures == polled[:1]
    stop()
    agent.go_to((6.0, 3.0, 0.0), speed=1.2)
    world.step(0.1)
    assert len(heard) == 2 and len(departures) == 2


def test_a_callback_can_send_the_agent_on(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    blocked: list[Blocked] = []

    def again(event):
        blocked.append(event)
        agent.go_to((50.0, 3.0, 0.0))  # is blocked again, which is told in the next tick

    world.listen(again, Blocked)
    agent.go_to((50.0, 3.0, 0.0))
    assert world.step(0.05) == 5
    assert len(blocked) == 5


def test_an_error_in_a_callback_comes_out_and_the_world_goes_on(graph):
    world, quiet = World(graph), World(graph)
    for each in (world, quiet):
        agent = each.spawn("human", (2.0, 3.0, 0.0))
        agent.go_to((9.0, 3.0, 0.0), speed=3.0)

    def fail(event):
        raise ZeroDivisionError

    def misuse(event):
        world.step(0.01)

    heard: list[Event] = []
    stop = world.listen(fail)
    world.listen(heard.append)
    agent = world.agents["human1"]
    agent.go_to((8.0, 3.0, 0.0), speed=3.0)
    quiet.agents["human1"].go_to((8.0, 3.0, 0.0), speed=3.0)
    with pytest.raises(ZeroDivisionError):
        world.step(0.1)
    assert world.time == pytest.approx(0.01)
    stop()
    world.step(0.1)
    quiet.step(0.2)
    assert world.time == pytest.approx(0.2) and world.state_hash() == quiet.state_hash()
    world.listen(misuse)
    agent.go_to((7.0, 3.0, 0.0), speed=3.0)
    with pytest.raises(RuntimeInputError, match="may not step"):
        world.step(0.01)


AT = (0.0, 0.0, 0.0)
ONE, TWO = Arrived(1.0, "ada", AT, AT), Event(2.0, "tom", AT)


def test_who_listens_hears_what_is_reported_from_then_on():
    log, heard, arrivals = EventLog(), [], []
    log.report(ONE)
    log.listen(heard.append, Event)
    stop = log.listen(arrivals.append, Arrived)
    for event in (TWO, ONE):
        log.report(event)
    log.tell()
    assert heard == [TWO, ONE] and arrivals == [ONE]
    stop()
    stop()
    log.report(ONE)
    log.tell()
    assert len(arrivals) == 1 and log.read() == [ONE, TWO, ONE, ONE] and log.read() == []


def test_what_is_never_read_is_forgotten_from_the_oldest_on(monkeypatch):
    monkeypatch.setattr(event_log, "_UNREAD", 3)
    log = EventLog()
    for k in range(5):
        log.report(Event(float(k), "ada", AT))
    assert [event.time for event in log.read()] == [2.0, 3.0, 4.0]


def test_it_goes_on_with_other_events_and_the_same_listeners():
    log, heard = EventLog(), []
    log.listen(heard.append, Event)
    log.report(ONE)
    log.become([TWO], [TWO])
    log.tell()
    assert heard == [TWO] and log.read() == [TWO]


@pytest.mark.parametrize(("callback", "kind"), [(5, Event), (print, int), (print, "Arrived")])
def test_only_functions_listen_to_kinds_of_events(callback, kind):
    with pytest.raises(RuntimeInputError, match="listen takes a function and a class of events"):
        EventLog().listen(callback, kind)
