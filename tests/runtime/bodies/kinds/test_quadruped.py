"""The kinds of animals, of the package and of files."""

import pytest

from locomotion.quadruped import BODY_NAMES, load_body
from runtime.bodies.kinds.quadruped import QuadrupedKind
from runtime.bodies.registry import kind_of
from runtime.errors import RuntimeInputError


def test_a_file_is_of_the_kind_that_reads_it(tmp_path):
    kind = kind_of(str(tmp_path / "mutt.yaml"))
    assert kind is kind_of("dog") and kind.noun(str(tmp_path / "mutt.yaml")) == "mutt"
    with pytest.raises(RuntimeInputError, match="no such file"):
        kind.check(str(tmp_path / "mutt.yaml"))
    with pytest.raises(RuntimeInputError, match=r"valid: 'human'.*or a quadruped's \.yaml file"):
        kind_of("goose")


@pytest.mark.parametrize("name", BODY_NAMES)
def test_size_and_rules_are_those_of_the_body_file(name):
    kind, body = QuadrupedKind(), load_body(name)
    assert kind.radius(name) == body.radius and kind.walk_rules(name) == body.walk_rules()
    assert kind.noun(name) == name


def test_a_file_with_a_mistake_is_refused_with_its_line(tmp_path):
    path = tmp_path / "mutt.yaml"
    path.write_text("name: mutt\nlegs: five\n")
    with pytest.raises(RuntimeInputError, match=r"mutt\.yaml:[0-9]+:[0-9]+: "):
        QuadrupedKind().check(str(path))
