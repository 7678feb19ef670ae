"""Hand-written YAML files: read safely, checked by pydantic, every error with its line and column.

Only what YAML and JSON share is accepted: mappings with text keys, sequences, text, numbers, booleans, null.
"""

import difflib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args, get_origin

import yaml
from pydantic import BaseModel, ValidationError

from surefoot.errors import SurefootError
from surefoot.files.inputs import note_input

__all__ = ["MAX_BYTES", "FileError", "Located", "dotted", "nearest", "read_yaml"]

MAX_BYTES = 1_000_000
_MOST_VALUES = 100_000  # values, counting those repeated by aliases
_MOST_LEVELS = 50
_LONGEST_NUMBER = 100  # characters; PyYAML takes minutes for a very long number to the base 60
_SCALARS = ("null", "bool", "int", "float", "str")
_PREFIX = "tag:yaml.org,2002:"
_Fast = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

Model = TypeVar("Model", bound=BaseModel)
Key = str | int


class FileError(SurefootError):
    """A hand-written file is wrong; the one-line message begins with ``file:line:column``."""

    def __init__(self, path: str | os.PathLike[str], line: int, column: int, problem: str) -> None:
        self.path, self.line, self.column = Path(path), line, column
        super().__init__(f"{path}:{line}:{column}: {' '.join(problem.split())}")


class Located:
    """Position of each value in a YAML file; an address is a path of keys and indices."""

    def __init__(self, path: Path, root: yaml.Node) -> None:
        self.path = path
        self._root = root

    def error(self, address: Sequence[Key], problem: str, at_key: bool = False) -> FileError:
        """The error ``problem`` at ``address``, or at its nearest ancestor in the file."""
        node = self._root
        mark = node.start_mark
        for step in address:
            found = _child(node, step)
            if found is None:
                break
            key, node = found
            mark = key.start_mark if at_key else node.start_mark
        return FileError(self.path, mark.line + 1, mark.column + 1, problem)


def read_yaml(path: str | os.PathLike[str], model: type[Model], what: str) -> tuple[Model, Located]:
    """Read the ``what`` (a noun for messages) at ``path`` as a ``model``.

    Returns the checked model and the position of each of its values. Raises `FileError` for a missing or
    unreadable file, invalid YAML, unknown or duplicate keys, and values of a wrong type or range.
    """
    target = Path(path)
    note_input(target)
    try:
        located = Located(target, _compose(target, what))
        value, _ = _Values(target).of(located._root)
    except RecursionError:  # of PyYAML's own parser
        raise FileError(target, 1, 1, f"nested too deeply for a {what}") from None
    try:
        return model.model_validate(value), located
    except ValidationError as error:
        raise _first_error(error, located, model) from None


def _compose(path: Path, what: str) -> yaml.Node:
    if not path.is_file():
        raise FileError(path, 1, 1, f"no such file; expected a {what} (YAML)")
    try:
        content = path.read_bytes()
    except OSError as error:
        raise FileError(path, 1, 1, f"cannot be read: {error.strerror}") from error
    if len(content) > MAX_BYTES:
        raise FileError(path, 1, 1, f"{len(content)} bytes; a {what} may have at most {MAX_BYTES}")
    try:
        root = _parse(content)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        raise FileError(path, line, column, f"not YAML: {error.problem or error.context}") from None
    except yaml.reader.ReaderError as error:
        # PyYAML counts characters once the text is decoded, and bytes if decoding fails
        read = content if error.encoding != "unicode" else content.decode(errors="replace")
        before = (
            str(read[: error.position], "utf-8", "replace")
            if isinstance(read, bytes)
            else read[: error.position]
        )
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        raise FileError(path, line, column, f"not YAML: {error.reason}") from None
    if root is None:
        raise FileError(path, 1, 1, f"empty; expected a {what}")
    return root


def _parse(content: bytes) -> yaml.Node | None:
    """The root of a YAML text. libyaml is ten times as fast, if PyYAML was built with it; what it refuses is
    read again by PyYAML's own parser, for its better messages."""
    try:
        return yaml.compose(content, Loader=_Fast)
    except yaml.YAMLError:
        return yaml.compose(content, Loader=yaml.SafeLoader)


class _Values:
    """Turns nodes into plain values. Aliases share a node but become separate values, so repeated values
    count each time."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._made: dict[int, tuple[Any, int]] = {}
        self._open: set[int] = set()

    def of(self, node: yaml.Node) -> tuple[Any, int]:
        """The value of ``node``, and how many values it contains."""
        known = self._made.get(id(node))
        if known is not None:
            return known
        if id(node) in self._open:
            raise _at(self._path, node, "refers to itself")
        if len(self._open) >= _MOST_LEVELS:
            raise _at(self._path, node, f"nested more than {_MOST_LEVELS} levels deep")
        self._open.add(id(node))
        value, count = self._made_of(node)
        self._open.discard(id(node))
        if count > _MOST_VALUES:
            raise _at(
                self._path, node, f"more than {_MOST_VALUES} values, counting those repeated by aliases"
            )
        self._made[id(node)] = value, count
        return value, count

    def _made_of(self, node: yaml.Node) -> tuple[Any, int]:
        count = 1
        if isinstance(node, yaml.ScalarNode):
            return _scalar(self._path, node), count
        if isinstance(node, yaml.SequenceNode):
            items = []
            for child in node.value:
                item, more = self.of(child)
                items.append(item)
                count += more
            return items, count
        found: dict[str, Any] = {}
        for key, child in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise _at(self._path, key, "a key must be text")
            if key.value in found:
                raise _at(self._path, key, f"{_shown(key.value)} appears twice here")
            found[key.value], more = self.of(child)
            count += more
        return found, count


def _scalar(path: Path, node: yaml.ScalarNode) -> Any:
    kind = node.tag.removeprefix(_PREFIX)
    if kind not in _SCALARS:
        raise _at(
            path, node, f"{_shown(node.value)} is read as {kind}; valid: {', '.join(_SCALARS)} (quote a text)"
        )
    if kind == "str":
        return node.value
    if len(node.value) > _LONGEST_NUMBER:
        raise _at(path, node, f"{_shown(node.value)} has {len(node.value)} characters")
    try:
        return yaml.SafeLoader("").construct_object(node)
    except (yaml.YAMLError, ValueError, KeyError, IndexError, OverflowError):
        raise _at(path, node, f"{_shown(node.value)} is not a valid {kind}") from None


def _at(path: Path, node: yaml.Node, problem: str) -> FileError:
    return FileError(path, node.start_mark.line + 1, node.start_mark.column + 1, problem)


def _child(node: yaml.Node, step: Key) -> tuple[yaml.Node, yaml.Node] | None:
    """The key node and the value node that ``step`` leads to (for an index the item twice)."""
    if isinstance(node, yaml.MappingNode):
        return next(((key, value) for key, value in node.value if key.value == step), None)
    if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
        return node.value[step], node.value[step]
    return None


def _first_error(error: ValidationError, located: Located, model: type[BaseModel]) -> FileError:
    """The first of pydantic's findings as one line: address, problem, valid choices, number of further
    ones."""
    findings = sorted(error.errors(include_url=False), key=lambda one: one["type"] != "extra_forbidden")
    first = findings[0]
    address = tuple(step for step in first["loc"] if not _is_mark(step))
    name = dotted(address) or "the file"
    of_key = first["type"] == "extra_forbidden" or first["loc"][-1:] == ("[key]",)
    if first["type"] == "extra_forbidden":
        known = _fields_at(model, address[:-1])
        problem = f"{name}: unknown key; {nearest(str(address[-1]), known)}valid: {', '.join(known)}"
    elif first["type"] == "missing":
        problem = f"{name}: missing"
        address = address[:-1]
    elif first["type"] in ("model_type", "dict_type"):
        problem = f"{name}: a mapping is needed{_given(first['input'])}"
    elif first["type"] in ("too_short", "too_long"):
        problem = f"{name}: {first['msg']}"
    elif first["type"] == "value_error" and isinstance(first["input"], dict):
        problem = f"{name}: {first['msg'].removeprefix('Value error, ')}"
    else:
        problem = f"{name}: {first['msg'].removeprefix('Value error, ')}{_given(first['input'])}"
    if len(findings) > 1:
        problem += f" (and {len(findings) - 1} more)"
    return located.error(address, problem, at_key=of_key)


def _is_mark(step: Key) -> bool:
    """Whether a step of pydantic's addresses is not in the file: "[key]", or the tag of a union, which our
    models write in brackets."""
    return isinstance(step, str) and (step == "[key]" or (step.startswith("(") and step.endswith(")")))


def _given(value: Any) -> str:
    if isinstance(value, str | int | float | bool) or value is None:
        return f", not {_shown(value)}"
    return (
        f", not a {'mapping' if isinstance(value, dict) else 'list'}"
        if isinstance(value, dict | list)
        else ""
    )


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def nearest(name: str, known: Sequence[str]) -> str:
    """Suggestion for a ``name`` that is not ``known``; empty if none is similar."""
    near = difflib.get_close_matches(name, known, n=1)
    return f"did you mean {near[0]!r}? " if near else ""


def dotted(address: Sequence[Key]) -> str:
    """An address as a user would write it: ``agents[0].start``."""
    text = ""
    for step in address:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else str(step)
    return text


def _fields_at(model: type[BaseModel], address: Sequence[Key]) -> list[str]:
    """Names of the keys that are valid in the mapping at ``address`` of ``model``."""
    current: Any = model
    for step in address:
        if isinstance(step, str):
            named = get_origin(current) is dict
            current = _mapping_in(get_args(current)[1] if named else current.model_fields[step].annotation)
    return list(current.model_fields)


def _mapping_in(annotation: Any) -> Any:
    """The model, or the dict of named values, inside ``annotation``."""
    if get_origin(annotation) is dict or (isinstance(annotation, type) and issubclass(annotation, BaseModel)):
        return annotation
    return next((found for inner in get_args(annotation) if (found := _mapping_in(inner)) is not None), None)
