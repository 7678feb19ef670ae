"""What happens to a body is told as an event of its world."""

import pytest

from locomotion import body_events as bodily
from locomotion.skills.vault.kind import VAULT
from runtime import events
from runtime.world.news import news_of

HERE, GOAL = (1.0, 2.0, 0.5), (4.0, 2.0, 0.0)
AFFORDANCE = VAULT.affordance


def told(event):
    return news_of(event, "ann", 10.0, GOAL)


def test_its_time_is_the_worlds_and_not_the_bodys():
    news = told(bodily.Fell(2.5, HERE, 3.0, 0.0, 7.0))
    assert isinstance(news, events.Fell)
    assert (news.time, news.agent, news.position) == (12.5, "ann", HERE)


def test_obstacles_are_named_by_the_skill_that_clears_them():
    started = told(bodily.TookOff(1.0, HERE, AFFORDANCE, 0.8, 0.1, 0.2))
    finished = told(bodily.Cleared(2.0, HERE, AFFORDANCE, 0.8))
    turned = told(bodily.TurnedAway(3.0, HERE, AFFORDANCE, 0.8, 0.3))
    assert isinstance(started, events.SkillStarted) and isinstance(finished, events.SkillFinished)
    assert isinstance(turned, events.TurnedAway) and turned.odds == 0.3
    assert started.skill == finished.skill == turned.skill == "vault"
    assert started.height == finished.height == turned.height == 0.8


def test_who_has_arrived_says_where():
    news = told(bodily.Arrived(2.5, HERE, 0.1))
    assert isinstance(news, events.Arrived) and news.goal == GOAL


@pytest.mark.parametrize(
    ("event", "reason"),
    [
        (bodily.MissedGoal(1.0, HERE, 1.25), "1.2 m"),
        (bodily.StrayedFromPath(1.0, HERE, 0.71), "0.7 m beside its path"),
        (bodily.LostGround(1.0, HERE), "no ground"),
    ],
)
def test_who_is_lost_says_why(event, reason):
    news = told(event)
    assert isinstance(news, events.Lost) and reason in news.reason


def test_what_the_world_reports_on_its_own_is_no_news():
    assert told(bodily.SetOff(1.0, HERE, GOAL, 5.0)) is None
