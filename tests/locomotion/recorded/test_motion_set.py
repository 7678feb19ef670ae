"""Sets of recorded motions, in memory and on disk."""

import dataclasses

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.recorded.motion_set import ANGLE, PERSON_MOTIONS, Clip, MotionSet, load_motions

MOTIONS = load_motions()


def test_the_package_ships_a_small_set_with_the_origin_of_every_clip():
    assert PERSON_MOTIONS.stat().st_size < 1.5e6
    assert all(MOTIONS.origins)
    assert {"walk", "run"} <= set(MOTIONS.gaits)


def test_a_set_comes_back_as_it_was_saved(tmp_path):
    MOTIONS.save(tmp_path / "set.npz")
    again = load_motions(tmp_path / "set.npz")
    assert again.clips == MOTIONS.clips
    for mine, theirs in zip(MOTIONS.levels, again.levels, strict=True):
        for part in dataclasses.fields(mine):
            a, b = getattr(mine, part.name), getattr(theirs, part.name)
            assert np.abs(a.astype(float) - b.astype(float)).max() < (1e-6 if part.name == "roots" else 1e-9)


def test_angles_are_kept_to_a_ten_thousandth():
    for level in MOTIONS.levels:
        steps = level.channels / ANGLE
        assert np.abs(steps - np.round(steps)).max() < 1e-6


def test_unknown_names_are_refused_with_the_known_ones():
    with pytest.raises(LocomotionError, match="clip 'fly': valid: stand"):
        MOTIONS.clip("fly")
    with pytest.raises(LocomotionError, match=r"gait 'fly': valid: .*walk"):
        MOTIONS.gait("fly")


def test_cycles_of_a_gait_lie_by_growing_speed():
    for gait in range(len(MOTIONS.gaits)):
        cycles = MOTIONS.cycles[MOTIONS.gait_first[gait] : MOTIONS.gait_first[gait + 1]]
        assert (np.diff(MOTIONS.speeds[cycles]) > 0.0).all()
        assert {MOTIONS.clips[k].gait for k in cycles} == {MOTIONS.gaits[gait]}


def test_a_file_with_frames_that_do_not_add_up_is_refused(tmp_path):
    level = MOTIONS.levels[0]
    short = dataclasses.replace(level, count=level.count + 1)
    MotionSet(MOTIONS.clips, (short, *MOTIONS.levels[1:])).save(tmp_path / "set.npz")
    with pytest.raises(LocomotionError, match="full_count adds up to"):
        load_motions(tmp_path / "set.npz")


def test_a_clip_is_of_a_known_kind():
    with pytest.raises(ValueError, match="valid: posture, arc, cycle, skill"):
        Clip(name="x", kind="dance", origin="nowhere", seconds=1.0)
    with pytest.raises(ValueError, match="a cycle has a gait"):
        Clip(name="x", kind="cycle", origin="nowhere", seconds=1.0)
