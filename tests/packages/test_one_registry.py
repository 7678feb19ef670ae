"""Kinds of obstacles and their skills are named where they are made and listed, and nowhere else."""

import ast
import re
from pathlib import Path

from locomotion import skill_kinds

ROOT = Path(__file__).parents[2]
OWN = (
    "navmesh/obstacles/kinds.py",
    "navmesh/obstacles/rim_measuring.py",
    "locomotion/skills/jump/",
    "locomotion/skills/vault/",
    "locomotion/skills/drop_roll/",
    "locomotion/skills/leap/",
    "locomotion/training/skills/",
)
"""Where the four kinds are made: found in meshes, cleared, learned."""
OTHER_THINGS = {
    ("runtime/playtest/analysis.py", "gap"): "a barrier, whether anybody clears it or not",
    ("runtime/playtest/fault.py", "gap"): "a barrier",
    ("runtime/playtest/openings.py", "gap"): "a barrier",
    ("runtime/playtest/wording.py", "gap"): "a barrier",
    ("runtime/cli/commands.py", "jump"): "what the option --jump of `surefoot path` is called",
    ("locomotion/gaits/walk/controller.py", "drop"): "a parameter of the walk",
    ("locomotion/gaits/walk/layout.py", "drop"): "a parameter of the walk",
    ("locomotion/training/gaits/brake.py", "drop"): "a parameter of the brake",
}
WORDS = {word for kind in skill_kinds() for word in (kind.affordance, kind.skill, kind.status)}


def texts(path):
    """Lines and texts of a module, docstrings left out."""
    tree = ast.parse(path.read_text())
    docs = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield node.lineno, node.value


def modules():
    for package in ("surefoot", "navmesh", "pathsmooth", "locomotion", "runtime"):
        yield from sorted((ROOT / package).rglob("*.py"))


def test_no_general_module_names_a_kind_a_skill_or_its_status():
    found = {}
    for path in modules():
        name = path.relative_to(ROOT).as_posix()
        if not name.startswith(OWN):
            found |= {(name, text): line for line, text in texts(path) if text in WORDS}
    named = {place: line for place, line in found.items() if place not in OTHER_THINGS}
    assert named == {}, "ask locomotion.skills.registry instead"
    assert set(OTHER_THINGS) == set(found)


def test_no_page_names_a_kind():
    named = re.compile(rf"\b({'|'.join(sorted(WORDS - {'gap'}))})\b")
    for page in sorted((ROOT / "runtime").rglob("*.js")):
        assert not named.search(page.read_text()), page


def test_the_search_finds_a_kind_that_is_named(tmp_path):
    (tmp_path / "module.py").write_text('"""vault"""\nKINDS = {"vault": 1}\n\ndef f(kind):\n    "jump"\n')
    assert list(texts(tmp_path / "module.py")) == [(2, "vault")]
