"""The page of the YAML files that people write: every key, from the models that check them."""

import inspect
import json
import re
from typing import Any

from pydantic import BaseModel
from schema_words import cell, default_words, value_words, words_of
from sphinx.pycode import ModuleAnalyzer

from locomotion.postures.schema import PostureFile
from locomotion.skills.description import SkillDescription
from navmesh.obstacles.tags import Tags
from runtime.missions.model import Mission
from runtime.playtest.plan import Plan

FILES: list[tuple[str, str, type[BaseModel]]] = [
    ("Mission", "What `surefoot run` runs: [missions](../../guides/missions.md).", Mission),
    ("Playtest plan", "`LEVEL.playtest.yaml`: [playtests](../../guides/playtests.md).", Plan),
    ("Tags", "`LEVEL.tags.yaml`: an author's corrections to the obstacles that were found.", Tags),
    (
        "Skill",
        "What `surefoot train` learns: [skills of your own](../../guides/own-skills.md).",
        SkillDescription,
    ),
    ("Posture graph", "What `surefoot postures` checks: [postures](../../guides/postures.md).", PostureFile),
]


def page() -> str:
    """Markdown: a table of keys for each kind of file, and one for each kind of value in it."""
    parts = [
        "# YAML files",
        "Every key, its values, and its default; keys in **bold** must be there. Lengths are in metres, "
        "times in seconds. A mistake is reported with its line and column.",
    ]
    for title, about, model in FILES:
        parts += [f"## {title}", about, *_tables(model)]
    return "\n\n".join(parts) + "\n"


def _tables(model: type[BaseModel]) -> list[str]:
    schema = model.model_json_schema(by_alias=True)
    found = {kind.__name__: kind for kind in _models(model)}
    parts = [_table(model, schema, found)]
    for name in _order(schema):
        about = " ".join(inspect.cleandoc(found[name].__doc__ or "").split())
        parts += [
            f"### {model.__name__.lower()}: {words_of(name)}",
            about,
            _table(found[name], schema["$defs"][name], found),
        ]
    return parts


def _order(schema: dict[str, Any]) -> list[str]:
    """The parts with keys of their own, in the order in which they are mentioned."""
    parts, found, waiting = schema.get("$defs", {}), [], [schema.get("properties", {})]
    while waiting:
        for name in re.findall(r"#/\$defs/(\w+)", json.dumps(waiting.pop(0))):
            if name not in found and "properties" in parts[name]:
                found.append(name)
                waiting.append(parts[name]["properties"])
    return found


def _table(model: type[BaseModel], schema: dict[str, Any], found: dict[str, type[BaseModel]]) -> str:
    about = _attribute_docs(model)
    rows = ["| key | value | default | meaning |", "| --- | --- | --- | --- |"]
    for key, part in schema["properties"].items():
        needed = key in schema.get("required", ())
        field = next((n for n, f in model.model_fields.items() if key in (n, f.alias)), key)
        default = "" if needed else default_words(part)
        text = part.get("description") or about.get(field, "") or _first_sentence(part, found)
        shown = f"**{key}**" if needed else key
        rows.append(f"| {shown} | {cell(value_words(part))} | {default} | {cell(text)} |")
    return "\n".join(rows)


def _first_sentence(part: dict[str, Any], found: dict[str, type[BaseModel]]) -> str:
    """What is said of the model that a key holds."""
    names = re.findall(r"#/\$defs/(\w+)", json.dumps(part))
    about = (
        " ".join(inspect.cleandoc(found[names[0]].__doc__ or "").split())
        if names and names[0] in found
        else ""
    )
    return about.split(". ")[0].split("; ")[0].rstrip(".:") + "." if about else ""


def _models(model: type[BaseModel]) -> set[type[BaseModel]]:
    """All models that the fields of ``model`` can hold, itself included."""
    found: set[type[BaseModel]] = set()
    waiting: list[Any] = [model]
    while waiting:
        kind = waiting.pop()
        if inspect.isclass(kind) and issubclass(kind, BaseModel):
            if kind not in found:
                found.add(kind)
                waiting += [field.annotation for field in kind.model_fields.values()]
        else:
            waiting += getattr(kind, "__args__", ())
    return found


def _attribute_docs(model: type[BaseModel]) -> dict[str, str]:
    """The docstrings below the attributes of ``model`` and what it inherits."""
    docs: dict[str, str] = {}
    for kind in reversed(model.__mro__):
        if issubclass(kind, BaseModel) and kind is not BaseModel:
            for (owner, name), lines in ModuleAnalyzer.for_module(kind.__module__).find_attr_docs().items():
                if owner == kind.__name__:
                    docs[name] = " ".join(lines)
    return docs
