"""How the packages are put together: which modules import each other, and how much functions are told."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).parents[2]
PACKAGES = ("surefoot", "navmesh", "pathsmooth", "locomotion", "runtime")
CIRCLES = {
    "navmesh.graph.node_graph": "methods of a graph give routes, which hold on to the graph they are of",
    "locomotion.skills.registry": "a kind of skill names its trainer, which trains people, who have skills",
}
"""Circles of imports that stay, by a module in each; and why."""
MOST_PARAMETERS = 8
COMPILED = {"kernel", "allocating_kernel"}
LONGER = {
    "runtime.playtest.run.playtest": "a command passes its options on to it, one by one",
    "navmesh.routes.path_queries.find_path": "a method of eight parameters, written apart from its class",
    "navmesh.routes.path_queries.find_paths": "the same",
}
"""Functions that may take more; and why."""


@cache
def trees() -> dict[str, tuple[Path, ast.Module]]:
    """Every module of the packages, by its name."""
    found = {}
    for package in PACKAGES:
        for file in sorted((ROOT / package).rglob("*.py")):
            name = ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            found[name] = file, ast.parse(file.read_text(encoding="utf-8"))
    return found


def has_its_test(module: str, file: Path) -> bool:
    """Whether the test of a module is found from its path.

    The test of `a/b.py` is `tests/a/test_b.py`, or another file there that imports the module itself.
    """
    tests = sorted((ROOT / "tests" / file.relative_to(ROOT).parent).glob("test_*.py"))
    return any(test.name == f"test_{file.name}" for test in tests) or any(
        module in names_imported(test) for test in tests
    )


@cache
def names_imported(file: Path) -> set[str]:
    """Everything that a file imports by its full name, modules as well as what is in them."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return names


def imports(module: str, file: Path, tree: ast.Module, known: set[str]) -> set[str]:
    """Which modules of ours a module imports, also for annotations alone or inside a function."""
    used = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            used |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = module.split(".")
                keep = len(parts) - node.level + (file.name == "__init__.py")
                base = ".".join([*parts[:keep], *filter(None, [node.module])])
            for name in node.names:
                full = f"{base}.{name.name}"
                used.add(full if full in known else base)
    return (used & known) - {module}


def circles(uses: dict[str, set[str]]) -> list[list[str]]:
    """Groups of modules that lead to each other."""
    names = sorted(uses)
    number = {name: k for k, name in enumerate(names)}
    edges = np.array([(number[a], number[b]) for a in names for b in uses[a]]).reshape(-1, 2)
    graph = coo_array((np.ones(len(edges)), edges.T), shape=(len(names), len(names)))
    _, group = connected_components(graph, directed=True, connection="strong")
    members = [[names[k] for k in np.flatnonzero(group == g)] for g in range(group.max() + 1)]
    return [each for each in members if len(each) > 1]


def functions(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    return (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))


def decorators(function: ast.FunctionDef | ast.AsyncFunctionDef) -> set[str]:
    bare = (each.func if isinstance(each, ast.Call) else each for each in function.decorator_list)
    return {each.attr if isinstance(each, ast.Attribute) else getattr(each, "id", "") for each in bare}


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> list[str]:
    asked = function.args.posonlyargs + function.args.args + function.args.kwonlyargs
    return [each.arg for each in asked if each.arg not in ("self", "cls")]


def test_no_two_modules_import_each_other_but_where_a_reason_is_given():
    modules = trees()
    uses = {name: imports(name, *found, set(modules)) for name, found in modules.items()}
    left = {kept for group in circles(uses) for kept in CIRCLES if kept in group}
    new = [group for group in circles(uses) if not set(group) & set(CIRCLES)]
    assert not new
    assert left == set(CIRCLES), "take what is mended off the list"


def test_circles_are_found():
    uses = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": {"d"}}
    assert circles(uses) == [["a", "b", "c"]]


def test_functions_outside_kernels_take_few_arguments():
    """Commands are left out, whose parameters are the options of a command line."""
    long = [
        f"{name}.{function.name}: {len(parameters(function))}"
        for name, (_, tree) in trees().items()
        for function in functions(tree)
        if not decorators(function) & COMPILED
        and not name.startswith("runtime.cli.declared.")
        and f"{name}.{function.name}" not in LONGER
        and len(parameters(function)) > MOST_PARAMETERS
    ]
    assert not long


def test_no_slot_of_a_memory_goes_by_its_number():
    """What is where in the arrays of kernels is said once, in their layouts."""
    numbered = re.compile(r"\b(state|memory|walk|grid|command|observed)\[[0-9]")
    found = [
        f"{file.relative_to(ROOT)}:{number}"
        for file, _ in trees().values()
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1)
        if numbered.search(line)
    ]
    assert not found


def test_the_test_of_a_module_is_found_from_its_path():
    missing = [
        name
        for name, (file, _) in trees().items()
        if file.name != "__init__.py" and not has_its_test(name, file)
    ]
    assert not missing, "write tests/<folder>/test_<module>.py"
