"""Releases that decide the last bit of a result."""

from surefoot.workers.versions import differences, own_versions


def test_equal_releases_do_not_differ():
    assert differences(own_versions(), own_versions()) == ""


def test_what_differs_is_named_with_both_releases():
    ours = {"python": "3.11.2", "numpy": "2.4.0", "mujoco": "4.0"}
    theirs = {"python": "3.12.1", "numpy": "2.4.0", "cupy": "1"}
    said = differences(ours, theirs)
    assert said == "python 3.12.1 (here 3.11.2), mujoco is missing (here 4.0), cupy 1 (here none)"
