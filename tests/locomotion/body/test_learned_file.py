"""Files of what a person has learned hold for one model of the person."""

import numpy as np
import pytest

from locomotion.body.learned_file import RELEARN, SkillHeader, learned_numbers, read_skill, speeds
from locomotion.body.person import person_digest
from locomotion.errors import LocomotionError
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

HOP = Schema(
    kind="hop",
    version=2,
    header=SkillHeader,
    arrays={"knots": speeds("speeds"), "gains": learned_numbers("speeds", 2)},
    remedy=RELEARN,
)
KNOTS, GAINS = np.array([1.0, 2.0]), np.array([[0.5, -0.5], [3.0, 4.0]])


@pytest.fixture
def written(tmp_path):
    def write(knots=KNOTS, gains=GAINS, kind="hop", version=2, **header):
        path = tmp_path / "hop.npz"
        told = {"person": person_digest(), "meta": {"seed": 3}, **header}
        write_archive(path, kind, version, told, {"knots": knots, "gains": gains})
        return path

    return write


def test_what_was_learned_comes_back(written):
    header, arrays = read_skill(written(), HOP)
    assert header.meta == {"seed": 3}
    assert np.array_equal(arrays["knots"], KNOTS) and np.array_equal(arrays["gains"], GAINS)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"person": "0" * 16}, "learned for another person's model; learn it anew"),
        ({"kind": "skip"}, "skip"),
        ({"version": 1}, "version"),
        ({"knots": KNOTS[:1], "gains": GAINS[:1]}, "knots has 1 rows, expected at least 2"),
        ({"knots": KNOTS[::-1]}, "knots does not increase"),
        ({"knots": np.array([1.0, 25.0])}, "knots"),
        ({"gains": GAINS * 1e6}, "gains"),
        ({"gains": GAINS[:, :1]}, r"gains has shape \(2, 1\), expected 2 on axis 1"),
        ({"shoes": "red"}, "shoes"),
    ],
)
def test_a_file_that_does_not_fit_is_refused_with_its_path(written, wrong, says):
    path = written(**wrong)
    with pytest.raises(LocomotionError, match=says) as told:
        read_skill(path, HOP)
    assert str(told.value).startswith(f"{path}: ")


def test_a_file_that_is_missing_or_cut_off_is_refused(written, tmp_path):
    with pytest.raises(LocomotionError, match="no such file; expected a hop archive"):
        read_skill(tmp_path / "none.npz", HOP)
    path = written()
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(LocomotionError, match=r"cut off or damaged.*learn it anew \(surefoot train\)"):
        read_skill(path, HOP)
