"""Agents perform their scripts one action after the other, and triggers give them others."""

import numpy as np
import pytest

from runtime.events import Told
from runtime.missions.check import prepare_mission
from runtime.missions.director import Performer, inside
from runtime.missions.model import Region
from runtime.missions.run import run_mission
from surefoot.progress import Progress
from tests.runtime.missions.scripts import REX, load, path_of, run, verdicts


@pytest.mark.parametrize(
    ("when", "why"),
    [
        ("{after: 2}", "2 s are over"),
        ("{arrives: tom}", "tom arrives"),
        ("{enters: {agent: tom, region: north_side}}", "tom enters north_side"),
    ],
)
def test_triggers_give_new_scripts(graph, tmp_path, when, why):
    agents = (
        "  - {name: tom, body: cat, start: [6, 2, 0], speed: 1, goto: [north]}\n" + REX + "goto: [east]}\n"
    )
    triggers = f"triggers:\n  - {{when: {when}, then: [{{agent: rex, do: [{{goto: west, speed: 1.5}}]}}]}}\n"
    result = run(graph, tmp_path, agents, triggers)
    (told,) = [event for event in result.events if isinstance(event, Told)]
    assert (told.agent, told.why) == ("rex", why)
    assert result.held
    _, rex = path_of(result, "rex")
    assert rex[-1, 0] < 3.0 and rex[:, 0].max() > 3.0


def test_a_fall_is_noticed_and_the_fallen_fail(graph, tmp_path, monkeypatch):
    agents = "  - {name: ada, start: west, goto: [east]}\n" + REX + "}\n"
    agents = agents.replace("speed: 2, }", "speed: 2}")
    triggers = "triggers:\n  - {when: {falls: ada}, then: [{agent: rex, do: [{goto: north}]}]}\n"
    loaded = load(tmp_path, agents, triggers)
    prepared = prepare_mission(loaded, Progress(shown=False), graph)
    human, step = prepared.world.agents["ada"].human, prepared.world.step

    def pushed(dt):
        human.data.qvel[3:5] = 9.0
        return step(dt)

    monkeypatch.setattr(prepared.world, "step", pushed)
    result = run_mission(loaded, prepared=prepared)
    assert [event.why for event in result.events if isinstance(event, Told)] == ["ada falls"]
    assert verdicts(result) == {("ada", "arrives"): False, ("rex", "arrives"): True}


class Turns:
    """An action that takes so many steps; then it is done, or fails."""

    def __init__(self, steps, ends="done", endless=False):
        self.steps, self.ends, self.endless, self.made = steps, ends, endless, 0

    @property
    def share(self):
        return self.made / self.steps

    def begin(self, agent, now):
        return "going" if self.steps else self.ends

    def go_on(self, agent, now, events):
        self.made += 1
        return self.ends if self.made == self.steps else "going"


def performing(*actions):
    performer = Performer(None)
    performer.perform(actions, 0.0)
    return performer


def test_actions_follow_one_another():
    performer = performing(Turns(2), Turns(0), Turns(1))
    seen = []
    for now in range(1, 5):
        seen.append((performer.state, round(performer.share, 2), performer.finished))
        performer.go_on(float(now), [])
    assert seen == [("going", 0.0, None), ("going", 0.17, None), ("going", 0.67, None), ("done", 1.0, 3.0)]


def test_after_a_failure_nothing_more_is_done_until_another_order():
    never = Turns(1)
    performer = performing(Turns(1, ends="failed"), never)
    performer.go_on(1.0, [])
    performer.go_on(2.0, [])
    assert performer.state == "failed" and performer.finished is None and never.made == 0
    performer.perform([Turns(1)], 3.0)
    performer.go_on(4.0, [])
    assert performer.state == "done" and performer.finished == 4.0


def test_what_never_ends_is_endless_while_it_is_done():
    performer = performing(Turns(1), Turns(9, endless=True))
    assert not performer.endless
    performer.go_on(1.0, [])
    assert performer.endless
    assert Performer(None).state == "idle" and not Performer(None).endless


@pytest.mark.parametrize(
    ("position", "within"),
    [((0, 0, 0), True), ((1, 2, 3), True), ((1.01, 0, 0), False), ((0, 0, -0.01), False)],
)
def test_a_box_holds_its_rim(position, within):
    box = Region(min=[-1.0, -2.0, 0.0], max=[1.0, 2.0, 3.0])
    assert inside(box, np.array(position, float)) == within


@pytest.mark.parametrize(("position", "within"), [((3, 4, 0), True), ((3, 4, 0.1), False), ((0, 0, 5), True)])
def test_a_ball_holds_what_is_within_its_radius(position, within):
    ball = Region(center=[0.0, 0.0, 0.0], radius=5.0)
    assert inside(ball, np.array(position, float)) == within
