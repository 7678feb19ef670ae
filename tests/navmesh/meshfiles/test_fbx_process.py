"""The process that reads an FBX file leaves its parts, or a sentence."""

import subprocess
import sys

import numpy as np
import pytest

from tests.navmesh.meshfiles.fbx_files import fbx

pytest.importorskip("ufbx", reason="needs the extra 'meshes'")


def read(tmp_path, text):
    """(status, what it says, arrays) of the process."""
    from importlib.util import find_spec

    script = find_spec("navmesh.meshfiles.fbx_process").origin
    level, result = tmp_path / "level.fbx", tmp_path / "result.npz"
    level.write_text(text)
    done = subprocess.run([sys.executable, "-I", script, level, result], capture_output=True, text=True)
    arrays = dict(np.load(result, allow_pickle=False)) if result.exists() else {}
    return done.returncode, done.stdout, arrays


def test_parts_of_all_meshes_come_one_after_the_other(tmp_path):
    """Also where this package is not installed (-I)."""
    status, said, arrays = read(tmp_path, fbx())
    assert (status, said) == (0, "")
    assert len(arrays["points"]) == arrays["points_counts"].sum()
    assert len(arrays["corners"]) == arrays["corners_counts"].sum() == arrays["sizes"].sum()
    assert arrays["corners"].max() < len(arrays["points"])
    assert arrays["names"].tolist() == ["floor"] and arrays["mirrored"].tolist() == [False]


def test_a_file_that_is_none_is_a_sentence(tmp_path):
    status, said, arrays = read(tmp_path, "Kaydara FBX Binary  \0")
    assert status == 1 and said.startswith("ufbx: ") and said.count("\n") == 1 and not arrays
