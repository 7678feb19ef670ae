"""The kind "human": where people go, and what they can clear."""

from locomotion import PERSON_RULES
from locomotion.skills.registry import skill_kinds
from runtime.bodies.kinds.person import PersonKind, person_rules


def test_people_go_where_their_rules_say():
    rules = person_rules()
    assert {name: getattr(rules, name) for name in PERSON_RULES if name != "radius"} == {
        name: value for name, value in PERSON_RULES.items() if name != "radius"
    }
    assert PersonKind().walk_rules("human") == rules
    assert PersonKind().radius("human") == PERSON_RULES["radius"] and PersonKind().noun("human") == "person"


def test_bots_clear_what_the_package_has_learned():
    skills = PersonKind().bot_skills("human")
    kinds = {kind.affordance: kind for kind in skill_kinds()}
    assert set(skills) == set(kinds)
    for affordance, (low, high) in skills.items():
        assert kinds[affordance].sizes[0] >= low and kinds[affordance].sizes[1] <= high


def test_the_figure_is_a_whole_skeleton():
    figure = PersonKind().figure("human")
    assert figure.bodies[0] == "pelvis" and figure.parents[0] == -1
    assert set(figure.owner) == set(range(len(figure.bodies)))  # no limb is invisible
