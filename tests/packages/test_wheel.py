"""A wheel holds all that the packages need, and works where there is no repository."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_OF_PACKAGES = ("navmesh/", "pathsmooth/", "locomotion/", "runtime/", "surefoot/")
_USE = """
import importlib, pkgutil, sys
sys.path.insert(0, sys.argv[1])
import locomotion, navmesh, pathsmooth, runtime, surefoot
from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.quadruped import BODY_NAMES, load_body
from locomotion.skills.library import learned_skills
from runtime.cli.app import main

for package in (locomotion, navmesh, pathsmooth, runtime, surefoot):
    assert package.__file__.startswith(sys.argv[1]), package.__file__
    names = [each.name for each in pkgutil.walk_packages(package.__path__, package.__name__ + ".")]
    for name in names:
        if name.rpartition(".")[2] not in ("__main__", "fbx_process", "helper"):
            importlib.import_module(name)
assert len(learned_skills(load_run_skill())) == 4
load_walk_skill()
for body in BODY_NAMES:
    load_body(body)
sys.argv = ["surefoot", "--version"]
main()
"""


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not a clone: git says what belongs to the sources")
def test_a_wheel_works_outside_of_the_repository(tmp_path: Path) -> None:
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    copy = tmp_path / "copy"
    for name in filter(None, tracked.decode().split("\0")):
        folder = name.partition("/")[0]
        if (ROOT / name).is_file() and folder not in ("tests", "benchmarks", "docs", "examples"):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            (copy / name).write_bytes((ROOT / name).read_bytes())
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-q", "-w"]
    subprocess.run([*build, str(tmp_path), str(copy)], check=True, timeout=120)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        packed = set(archive.namelist())
        archive.extractall(tmp_path / "site")
    held = {name for name in tracked.decode().split("\0") if name.startswith(_OF_PACKAGES)}
    assert not {name for name in held if (ROOT / name).is_file()} - packed
    used = subprocess.run(
        [sys.executable, "-I", "-c", _USE, str(tmp_path / "site")],
        cwd=tmp_path, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert used.returncode == 0, used.stderr[-2000:]
    assert used.stdout.startswith("surefoot ")
