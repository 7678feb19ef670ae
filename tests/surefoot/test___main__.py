"""``python -m surefoot`` is the command, where its script is not on the path."""

import subprocess
import sys
from pathlib import Path

import pytest

import surefoot

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    "command", [["-m", "surefoot"], ["-c", "import runtime.cli.app; runtime.cli.app.main()"]]
)
def test_the_command_tells_its_version_without_loading_anything(command):
    script = [sys.executable, "-X", "importtime", *command, "--version"]
    told = subprocess.run(script, cwd=ROOT, capture_output=True, text=True, check=True)
    assert told.stdout == f"surefoot {surefoot.__version__}\n"
    assert not any(heavy in told.stderr for heavy in ("numba", "mujoco", "scipy", "numpy"))
