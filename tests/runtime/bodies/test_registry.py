"""The registry is the only place that lists bodies: nothing else in the runtime knows one by name."""

import ast
from functools import cache
from pathlib import Path

from runtime.bodies.registry import body_kinds, body_names, is_body_file, kind_of

ROOT = Path(__file__).resolve().parents[3]
BODIES = "runtime/bodies/"
NAMED = {
    "runtime/cli/declared/playtests.py",  # the default of an option; `--help` imports no registry
    "runtime/playtest/run.py",  # the same default
    "runtime/warmup/first_uses.py",  # scenes that compile what certain bodies do to each other
}
"""The modules outside `BODIES` in whose code a body's name may stand."""


@cache
def general_modules():
    files = {path.relative_to(ROOT).as_posix(): path for path in sorted((ROOT / "runtime").rglob("*.py"))}
    return [
        (name, ast.parse(path.read_text(encoding="utf-8")))
        for name, path in files.items()
        if not name.startswith(BODIES)
    ]


def test_general_modules_name_no_body():
    named = set()
    for name, tree in general_modules():
        texts = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant))
        if any(text in body_names() for text in texts if isinstance(text, str)):
            named.add(name)
    assert named == NAMED


def test_general_modules_know_no_driver_of_any_kind():
    """But for gateways, which bring figures in from elsewhere."""
    allowed = {"cast", "figure", "held_things", "pose", "populations", "protocol", "registry", "kinds.kind"}
    remote = {"remote_figures", "remote_looks", "remote_poses"}
    for name, tree in general_modules():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("runtime.bodies."):
                known = allowed | (remote if name.startswith("runtime/dis/") else set())
                assert (node.module or "").removeprefix("runtime.bodies.") in known, name
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "isinstance":
                found = ast.unparse(node.args[1])
                assert "Driver" not in found or found == "RemoteDriver", name


def test_every_body_has_a_kind_that_knows_it():
    assert len(set(body_names())) == len(body_names()) >= 5
    for kind in body_kinds():
        for body in kind.names:
            assert kind_of(body) is kind and not is_body_file(body)
            kind.check(body)
            assert 0.0 < kind.radius(body) < kind.walk_rules(body).headroom
            figure = kind.figure(body)
            assert len(figure.bodies) == len(figure.parents) and figure.owner.max() < len(figure.bodies)
            assert kind.noun(body) and kind.bot_speed > 0.0
            assert all(0.0 <= low < high for low, high in kind.bot_skills(body).values())
