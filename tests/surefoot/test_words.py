"""Counted things in a sentence."""

import pytest

from surefoot.words import several


@pytest.mark.parametrize(("count", "words"), [(0, "0 agents"), (1, "1 agent"), (2, "2 agents")])
def test_one_alone_is_singular(count, words):
    assert several(count, "agent") == words
