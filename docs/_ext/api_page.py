"""The page of a package's public names, in the order of its ``__all__``."""

import ast
import inspect
from importlib.util import resolve_name
from pathlib import Path
from types import ModuleType
from typing import Any

from docstrings import as_rst
from sphinx.pycode import ModuleAnalyzer


def page(package: ModuleType) -> str:
    """reStructuredText: the package's docstring, and each name under a heading of its own."""
    name = package.__name__
    parts = [
        _heading(name, "="),
        f".. py:module:: {name}",
        "\n".join(as_rst((inspect.getdoc(package) or "").splitlines())),
    ]
    public = [word for word in package.__all__ if not word.startswith("__")]
    for word in sorted(public, key=lambda word: (_rank(getattr(package, word)), word.lower())):
        parts += [_heading(word, "-"), _directive(package, word)]
    return "\n\n".join(parts) + "\n"


def _rank(value: Any) -> int:
    """Classes, functions, constants, errors."""
    if inspect.isclass(value):
        return 3 if issubclass(value, Exception) else 0
    return 1 if callable(value) else 2


def _directive(package: ModuleType, word: str) -> str:
    value = getattr(package, word)
    full = f"{package.__name__}.{word}"
    if inspect.isclass(value):
        kind = "autoexception" if issubclass(value, Exception) else "autoclass"
        known = [base for base in value.__bases__ if base is not object and _is_known(package, base)]
        bases = "\n   :show-inheritance:" if known else ""
        return f".. {kind}:: {full}\n   :members:{bases}"
    if callable(value):
        return f".. autofunction:: {full}"
    home = _home(package, word)
    about = ModuleAnalyzer.for_module(home).find_attr_docs().get(("", word), [])
    shown = f"\n   :value: {value!r}" if len(repr(value)) < 80 else ""
    return f".. py:data:: {full}{shown}\n\n" + "\n".join(f"   {line}" for line in about)


def _is_known(package: ModuleType, base: type) -> bool:
    """Whether a reader can look up ``base``: it is Python's own or public."""
    return base.__module__ == "builtins" or base.__name__ in package.__all__


def _home(package: ModuleType, word: str) -> str:
    """The module that the package imports ``word`` from: a constant does not say where it was defined."""
    for node in ast.walk(ast.parse(Path(str(package.__file__)).read_text())):
        if isinstance(node, ast.ImportFrom) and any(
            word == (name.asname or name.name) for name in node.names
        ):
            return resolve_name("." * node.level + (node.module or ""), package.__name__)
    return package.__name__


def _heading(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}"
