"""The kind "walker": of a person's size, and what it clears as a bot."""

import navmesh
from locomotion import PERSON_RULES
from locomotion.skills.registry import skill_kinds
from runtime.bodies.kinds.walker import WalkerKind


def test_it_is_of_a_persons_size_and_goes_where_people_go():
    kind = WalkerKind()
    assert kind.radius("walker") == PERSON_RULES["radius"]
    assert kind.walk_rules("walker").max_step == PERSON_RULES["max_step"]
    assert kind.sized and kind.avoids_all and kind.slides_as_bot


def test_bots_clear_all_that_is_looked_for():
    skills, looked_for = WalkerKind().bot_skills("walker"), navmesh.ObstacleRules()
    step = PERSON_RULES["max_step"]
    assert set(skills) == {kind.affordance for kind in skill_kinds()}
    for kind in skill_kinds():
        low, high = skills[kind.affordance]
        least, most = looked_for.range_of(kind.obstacle) or kind.sizes
        assert high == most
        assert low == (least if kind.obstacle.has_depth else step)


def test_its_figure_is_as_wide_as_it_is():
    figure = WalkerKind().figure("walker")
    assert figure.bodies == ("root",)
    trunk, nose = figure.shapes.size[:, 0]
    assert trunk == PERSON_RULES["radius"] and 0.0 < nose < trunk
