"""What is right for a kind of body that says nothing else of itself."""

import pytest

from runtime.bodies.kinds.kind import BodyKind


class Goose(BodyKind):
    names = ("goose",)

    def unasked(self, *_):
        raise AssertionError("not asked for here")

    radius = walk_rules = figure = populate = unasked


def test_it_has_no_files_no_skills_and_one_size():
    goose = Goose()
    assert not goose.takes_file("goose.yaml") and goose.files == "" and not goose.sized
    assert goose.bot_skills("goose") == {} and not goose.avoids_all and not goose.slides_as_bot
    goose.check("goose")


def test_it_is_called_by_its_name_and_a_file_without_its_folder():
    assert Goose().noun("goose") == "goose" and Goose().noun("/farm/grey.goose.yaml") == "grey.goose"


def test_it_has_to_say_how_large_it_is_and_where_it_goes():
    with pytest.raises(TypeError, match="radius"):
        type("Half", (BodyKind,), {"names": ("half",)})()  # type: ignore[abstract]
