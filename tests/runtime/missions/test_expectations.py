"""What was expected and whether it held: judged from events, places and finished scripts."""

from types import SimpleNamespace

import numpy as np
import pytest

from runtime.events import Arrived, Fell, SkillFinished
from runtime.missions.expectations import Watch, checks
from runtime.missions.model import AgentSpec, Mission, Region
from tests.runtime.missions.scripts import REX, run, verdicts


def test_stays_out_of_a_region(graph, tmp_path):
    out = "goto: [[3, 1, 0]], expect: {stays_out_of: [east_side, north_side]}}\n"
    assert run(graph, tmp_path, REX + out).held
    through = run(graph, tmp_path, REX + out.replace("[3, 1, 0]", "[8, 1, 0]"))
    held = {expected: held for (_, expected), held in verdicts(through).items()}
    assert held == {"arrives": True, "stays out of east_side": False, "stays out of north_side": True}


AT = (0.0, 0.0, 0.0)
REGIONS = {"pond": Region(min=[2.0, -1.0, -1.0], max=[3.0, 1.0, 1.0])}


class Walk:
    """A world in which ada goes along x, 1 m in each second, and tom stands at x = 10."""

    def __init__(self):
        self.time = 0.0
        self.agents = {name: SimpleNamespace(position=np.zeros(3)) for name in ("ada", "tom")}
        self.agents["tom"].position = np.array([10.0, 0.0, 0.0])

    def watched(self, seconds):
        watch = Watch(self)
        for second in range(seconds + 1):
            self.time = float(second)
            self.agents["ada"].position = np.array([second, 0.0, 0.0])
            watch.sample()
        return watch


def judged(expect, events=(), finished=6.0, seconds=6, state="done", endless=False):
    """[(expected, held, found)] of ada, who walked for ``seconds``."""
    spec = AgentSpec.model_validate({"name": "ada", "start": [0.0, 0.0, 0.0], "expect": expect})
    mission = Mission.model_construct(agents=[spec], regions=REGIONS)
    performer = SimpleNamespace(finished=finished, endless=endless, state=state)
    director, loaded = SimpleNamespace(performers={"ada": performer}), SimpleNamespace(mission=mission)
    found = checks(loaded, director, Walk().watched(seconds), list(events))
    assert {check.agent for check in found} <= {"ada"}
    return [(check.expected, check.held, check.found) for check in found]


def test_places_are_kept_over_time():
    watch = Walk().watched(2)
    assert watch.times.tolist() == [0.0, 1.0, 2.0]
    assert watch.places("ada")[:, 0].tolist() == [0.0, 1.0, 2.0]


def test_a_script_that_ends_has_to_be_done():
    assert judged({}) == [("arrives", True, "arrives after 6.0 s")]
    assert judged({}, finished=None) == [("arrives", False, "does not arrive")]
    assert judged({}, finished=None, state="idle") == []
    assert judged({}, finished=None, endless=True) == []


@pytest.mark.parametrize(("finished", "held"), [(5.0, True), (5.01, False), (None, False)])
def test_by_when_it_is_done(finished, held):
    ((expected, found, _),) = judged({"arrives_within": 5.0}, finished=finished)
    assert (expected, found) == ("arrives within 5 s", held)


@pytest.mark.parametrize("never", [True, False])
def test_a_fall_is_told_with_its_time(never):
    expected = "never falls" if never else "falls"
    for events, fell in (([Fell(2.0, "ada", AT)], True), ([Fell(2.0, "tom", AT)], False)):
        found = "falls after 2.0 s" if fell else "never falls"
        assert (expected, never != fell, found) in judged({"never_falls": never}, events)


def test_skills_count_when_they_are_finished():
    events = [Arrived(1.0, "ada", AT, AT), *(SkillFinished(k, "ada", AT, "vault", 0.5) for k in (2.0, 3.0))]
    found = judged({"uses_skills": ["vault", "jump"]}, events)[1:]
    assert found == [
        ("uses skill vault", True, "uses it 2 times"),
        ("uses skill jump", False, "does not use it"),
    ]


def test_regions_are_told_with_when_they_were_entered():
    expect = {"stays_out_of": ["pond"]}
    assert judged(expect)[1] == ("stays out of pond", False, "enters after 2.0 s")
    assert judged(expect, seconds=1)[1] == ("stays out of pond", True, "stays out")


@pytest.mark.parametrize(
    ("distance", "expected", "held", "found"),
    [
        ({"at_least": 4.0}, "keeps at least 4 m to tom", True, "4.00 to 10.00 m"),
        ({"at_least": 4.5}, "keeps at least 4.5 m to tom", False, "4.00 to 10.00 m"),
        ({"at_most": 8.0}, "keeps at most 8 m to tom", False, "4.00 to 10.00 m"),
        ({"at_most": 8.0, "after": 2.0}, "keeps at most 8 m to tom", True, "4.00 to 8.00 m"),
        ({"at_most": 8.0, "after": 9.0}, "keeps at most 8 m to tom", False, "the mission was over before"),
    ],
)
def test_distances_count_from_when_they_are_asked_for(distance, expected, held, found):
    assert judged({"keeps_distance": [{"to": "tom", **distance}]})[1] == (expected, held, found)
