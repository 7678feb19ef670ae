"""The README's code runs, its commands exist, and its links lead somewhere."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import typer.testing

from runtime.cli.app import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
README = PAGES[0].read_text()


@pytest.mark.parametrize("block", re.findall(r"```python\n(.*?)```", README, re.DOTALL))
def test_its_code_runs(block: str) -> None:
    ran = subprocess.run([sys.executable, "-c", block], cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_its_commands_exist() -> None:
    commands = re.findall(r"^    surefoot (.*?)(?:  +#.*)?$", README, re.MULTILINE)
    assert len(commands) >= 6
    for command in commands:
        words = shlex.split(command)
        shown = typer.testing.CliRunner().invoke(app, [words[0], "--help"])
        assert shown.exit_code == 0, command
        for option in (word for word in words if word.startswith("-")):
            assert option in shown.output, f"{option} of: surefoot {command}"
        for path in (word for word in words[1:] if word.startswith("examples/")):
            assert (ROOT / path).exists(), command
