"""``surefoot clip`` reads keyframes, captures and motions, and draws them."""

import json

import pytest

from locomotion.clips.clip import load_clip
from locomotion.clips.motion import load_motion
from locomotion.gaits.run.skill import RUN_CLIP
from runtime.cli.clips import read_motion
from runtime.errors import RuntimeInputError
from tests.runtime.cli.answers import one_line


def test_clip_shows_a_motion_and_its_faults(surefoot, tmp_path):
    film, saved = tmp_path / "run.png", tmp_path / "run.npz"
    code, out, _ = surefoot("clip", RUN_CLIP, "--film", film, "-o", saved)
    assert code == 0 and "within its joint ranges" in out
    assert film.read_bytes()[:4] == b"\x89PNG"
    code, out, _ = surefoot("clip", saved, "--json")
    assert code == 0 and json.loads(out)["faults"] == []
    step = tmp_path / "step.yaml"
    code, out, _ = surefoot("clip", saved, "--stretch", 0.1, 0.4, "--mirror", "-o", step)
    assert code == 0 and load_clip(step).duration == pytest.approx(0.3, abs=0.02)
    code, _, err = surefoot("clip", saved, "--film", tmp_path / "run.jpg")
    assert code == 2 and "written as .png" in err and not (tmp_path / "run.jpg").exists()
    for output, stretch in ((tmp_path / "step.txt", (0.1, 0.4)), (tmp_path / "no.yaml", (0.4, 0.1))):
        code, _, err = surefoot("clip", saved, "--stretch", *stretch, "-o", output)
        assert code == 2 and one_line(err) and not output.exists()
    motion = load_motion(saved)
    motion.qpos[:, 7:] = 3.0
    motion.save(saved)
    code, out, _ = surefoot("clip", saved)
    assert code == 1 and "beyond its range" in out
    for source, message in (
        (tmp_path / "walk.bvh", "needs a file that maps its joints"),
        (film, "is a .yaml, .bvh or .npz file"),
    ):
        code, _, err = surefoot("clip", source)
        assert code == 2 and message in err and one_line(err)


def test_keyframes_and_the_motion_made_of_them_are_the_same(tmp_path):
    motion = read_motion(RUN_CLIP, None, "m", "z")
    motion.save(tmp_path / "run.npz")
    again = read_motion(tmp_path / "run.npz", None, "m", "z")
    assert again.rate == motion.rate and (again.qpos == motion.qpos).all()


def test_what_is_no_motion_is_named(tmp_path):
    for name, says in (("a.fbx", r"a \.yaml, \.bvh or \.npz file, not \.fbx"), ("a.bvh", r"--map FILE")):
        with pytest.raises(RuntimeInputError, match=says):
            read_motion(tmp_path / name, None, "m", "z")
