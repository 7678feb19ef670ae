"""Captures in metres with Z up, whatever units and axes their files have."""

import pytest

from locomotion.clips.bvh import read_bvh
from locomotion.errors import LocomotionError
from tests.locomotion.clips.tpose import bvh_text


@pytest.fixture
def bvh(tmp_path):
    def write(frames):
        path = tmp_path / "motion.bvh"
        path.write_text(bvh_text(frames))
        return path

    return write


def test_units_and_the_axis_that_points_up_must_fit(bvh):
    path = bvh([{}])
    with pytest.raises(LocomotionError, match=r"would be 1\d\d m tall"):
        read_bvh(path, units="m")
    with pytest.raises(LocomotionError, match="units are one of m, cm"):
        read_bvh(path, units="furlong")
    with pytest.raises(LocomotionError, match="another axis"):
        read_bvh(path, up="z")


def test_what_is_no_file_is_refused(tmp_path):
    folder = tmp_path / "folder.bvh"
    folder.mkdir()
    for path in (tmp_path / "none.bvh", folder):
        with pytest.raises(LocomotionError, match="no such file"):
            read_bvh(path)
