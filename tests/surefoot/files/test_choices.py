"""Words of which the valid ones are known only when a file is read."""

from typing import Annotated

import pytest
from pydantic import BaseModel, ValidationError

from surefoot.files.choices import OneOf

KNOWN = {"gaits": ["walk", "run"]}


class Order(BaseModel):
    gait: Annotated[str, OneOf(lambda: KNOWN["gaits"])]


@pytest.mark.parametrize("gait", KNOWN["gaits"])
def test_a_known_word_is_taken(gait):
    assert Order(gait=gait).gait == gait


@pytest.mark.parametrize("gait", ["", "Run", "fly", 1, None, ["run"], {}])
def test_others_are_refused_with_the_known_ones(gait):
    with pytest.raises(ValidationError, match="'walk' or 'run'"):
        Order(gait=gait)


def test_words_may_be_added_after_the_model_is_made(monkeypatch):
    """By a game that registers a body of its own."""
    monkeypatch.setitem(KNOWN, "gaits", ["walk", "run", "roll"])
    assert Order(gait="roll").gait == "roll"
    assert Order.model_json_schema()["properties"]["gait"]["enum"] == ["walk", "run", "roll"]
    with pytest.raises(ValidationError, match="'walk', 'run' or 'roll'"):
        Order(gait="fly")
