"""Skill files: round trip and the errors of wrong ones."""

import dataclasses
import json
from pathlib import Path

import mujoco
import numpy as np
import pytest

from locomotion.body.person import PersonIndex, build_person
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RUN_SKILL, load_run_skill, reset_running
from surefoot.files.archive import write_archive


def test_round_trip(tmp_path: Path) -> None:
    skill = load_run_skill()
    skill.save(tmp_path / "run.npz")
    again = load_run_skill(tmp_path / "run.npz")
    for mine, other in zip(skill.tables, again.tables, strict=True):
        np.testing.assert_array_equal(mine, other)
    assert (again.speeds, again.step_length) == (skill.speeds, skill.step_length)


def test_missing(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match="no such file"):
        load_run_skill(tmp_path / "none.npz")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
def test_truncated(tmp_path: Path, share: float) -> None:
    content = RUN_SKILL.read_bytes()
    path = tmp_path / "run.npz"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(LocomotionError, match="cut off or damaged"):
        load_run_skill(path)


def raw(path):
    """Header and arrays of an archive as they are, unchecked."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


def rewritten(
    tmp_path: Path, version: int = 1, kind: str = "run skill", drop: str = "", **header: object
) -> Path:
    old, arrays = raw(RUN_SKILL)
    arrays.pop(drop, None)
    write_archive(tmp_path / "run.npz", kind, version, {**old, **header}, arrays)
    return tmp_path / "run.npz"


def test_of_another_person(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match="another person"):
        load_run_skill(rewritten(tmp_path, person="0" * 16))


def test_of_another_version(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match="version 99"):
        load_run_skill(rewritten(tmp_path, version=99))


def test_of_another_kind(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match="jump"):
        load_run_skill(rewritten(tmp_path, kind="jump skill"))


def test_without_an_array(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match="table"):
        load_run_skill(rewritten(tmp_path, drop="table"))


def test_with_numbers_that_are_not_finite(tmp_path: Path) -> None:
    skill = load_run_skill()
    table = skill.table.copy()
    table[0, 0] = np.nan
    dataclasses.replace(skill, table=table).save(tmp_path / "run.npz")
    with pytest.raises(LocomotionError, match="finite"):
        load_run_skill(tmp_path / "run.npz")


def test_starts_where_it_is_put() -> None:
    model = build_person()
    data, index, state = mujoco.MjData(model), PersonIndex.of(model), c.new_state()
    place, yaw = np.array([3.0, -2.0, 0.0]), 2.0
    reset_running(load_run_skill(), model, data, index, state, place, yaw, 3.0)
    assert np.hypot(*state[c.COM_VELOCITY][:2]) == pytest.approx(3.0)
    np.testing.assert_allclose(data.qpos[:2], place[:2])
    assert state[c.HEADING] == yaw
    data.qpos[2] -= 0.001
    mujoco.mj_forward(model, data)
    assert -0.002 < data.contact.dist.min() < 0.0
    forward = data.xmat[index.root].reshape(3, 3)[:, 0]
    assert np.arctan2(forward[1], forward[0]) == pytest.approx(yaw)
