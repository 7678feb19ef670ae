"""Each event is a sentence, and the same sentence again from a file."""

import pytest

from runtime import events
from runtime.events import (
    Arrived,
    BackedOut,
    Blocked,
    Departed,
    Event,
    Fell,
    GotUp,
    Hindered,
    Lost,
    PostureReached,
    SkillFinished,
    SkillStarted,
    Stuck,
    Told,
    TurnedAway,
    Waiting,
    event_text,
)  # fmt: skip

AT, GOAL = (1.0, 2.04, 0.0), (9.0, 3.0, -0.5)
SENTENCES = {
    Departed(0.5, "ada", AT, GOAL, 8.25, ()): "ada sets out for (9.0, 3.0, -0.5), 8.2 m",
    Departed(0.5, "ada", AT, GOAL, 8.0, ("jump", "vault", "jump")):
        "ada sets out for (9.0, 3.0, -0.5), 8.0 m (2 jumps, 1 vault on the way)",
    Arrived(1.0, "ada", AT, GOAL): "ada arrives at (9.0, 3.0, -0.5)",
    Blocked(1.0, "ada", AT, GOAL, "a wall"): "ada cannot reach (9.0, 3.0, -0.5): a wall",
    BackedOut(1.0, "rex", AT, 1.26): "rex has backed out 1.3 m to (1.0, 2.0, 0.0)",
    SkillStarted(1.0, "ada", AT, "leap", 1.2): "ada leaps over 1.20 m",
    SkillFinished(1.0, "ada", AT, "leap", 1.2): "ada runs on after the leap",
    Fell(1.0, "ada", AT): "ada falls at (1.0, 2.0, 0.0)",
    GotUp(1.0, "ada", AT, 2.34): "ada is up again after 2.3 s",
    Lost(1.0, "ada", AT, "no ground"): "ada loses its way at (1.0, 2.0, 0.0): no ground",
    Hindered(1.0, "ada", AT, "others"): "ada gets nowhere at (1.0, 2.0, 0.0): others",
    Stuck(1.0, "ada", AT, "others"): "ada is stuck at (1.0, 2.0, 0.0): others",
    PostureReached(1.0, "ada", AT, "kneel", "rifle deployed"): "ada is in the posture kneel, rifle deployed",
    PostureReached(1.0, "ada", AT, "prone", ""): "ada is in the posture prone",
    TurnedAway(1.0, "ada", AT, "vault", 1.0, 0.284): "ada turns away from a vault of 1.00 m: odds 28 %",
    Waiting(1.0, "ada", AT, GOAL): "ada waits for what is to be loaded on its way to (9.0, 3.0, -0.5)",
    Told(1.0, "ada", AT, "2 s are over"): "ada is told to do something else: 2 s are over",
}  # fmt: skip


@pytest.mark.parametrize(("event", "sentence"), SENTENCES.items(), ids=lambda each: getattr(each, "kind", ""))
def test_an_event_is_a_sentence_and_again_from_a_file(event, sentence):
    assert str(event) == sentence == event_text(event.to_dict())
    assert event.to_dict()["kind"] == event.kind == type(event).__name__


def test_every_kind_is_public_and_has_its_sentence():
    kinds = {kind.__name__ for kind in Event.__subclasses__() if kind.__module__ == events.__name__}
    assert kinds == {event.kind for event in SENTENCES} == set(events.__all__) - {"Event", "event_text"}


@pytest.mark.parametrize("change", [{"kind": "Flew"}, {"height": 3}, {"skill": "fly"}])
def test_of_an_event_of_a_later_version_the_name_is_told(change):
    values = {**SkillStarted(1.0, "ada", AT, "leap", 1.2).to_dict(), **change}
    if "height" in change:
        del values["time"]
    assert event_text(values) == f"ada: {values['kind']}"
