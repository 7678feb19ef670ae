"""What a JSON schema says of a value, in words."""

import re
from typing import Any


def words_of(name: str) -> str:
    """The name of a model as words: ``NewValues`` is "new values"."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.removesuffix("Spec")).lower()


def value_words(part: dict[str, Any]) -> str:
    """What may stand there: a type with its range, or the choices."""
    if "$ref" in part:
        return words_of(part["$ref"].rsplit("/", 1)[1])
    for choice in ("anyOf", "oneOf"):
        if choice in part:
            return " or ".join(dict.fromkeys(value_words(p) for p in part[choice] if p.get("type") != "null"))
    if "allOf" in part:
        return value_words(part["allOf"][0])
    if "const" in part:
        return f"`{part['const']}`"
    if "enum" in part:
        return ", ".join(f"`{value}`" for value in part["enum"])
    kind = part.get("type", "anything")
    if kind == "array":
        if "prefixItems" in part:
            inner = [value_words(p) for p in part["prefixItems"]]
            return "`[x, y, z]`" if inner == ["number"] * 3 else f"[{', '.join(inner)}]"
        inner = value_words(part.get("items", {}))
        if part.get("minItems") == part.get("maxItems") == 3 and inner == "number":
            return "`[x, y, z]`"
        if part.get("minItems") == part.get("maxItems") == 2:
            return f"[{inner}, {inner}]"
        return f"list of ({inner})" if " or " in inner else f"list of {inner}"
    if kind == "object":
        inner = part.get("additionalProperties") or next(
            iter(part.get("patternProperties", {}).values()), None
        )
        return f"name: {value_words(inner)}, …" if isinstance(inner, dict) else "mapping"
    words = {"number": "number", "integer": "whole number", "string": "text", "boolean": "`true`, `false`"}
    return words.get(kind, kind) + _range(part)


def _range(part: dict[str, Any]) -> str:
    least, above = part.get("minimum"), part.get("exclusiveMinimum")
    most, below = part.get("maximum"), part.get("exclusiveMaximum")
    bounds = [
        f"{word} {value:g}"
        for word, value in (("≥", least), (">", above), ("≤", most), ("<", below))
        if value is not None and abs(value) < 1e6
    ]
    return f" {', '.join(bounds)}" if bounds else ""


def default_words(part: dict[str, Any]) -> str:
    """What counts when nothing stands there; empty if that is nothing."""
    value = part.get("default")
    return "" if value is None or value in ({}, []) or isinstance(value, dict) else f"`{value}`"


def cell(text: str) -> str:
    """``text`` as it may stand in a cell of a table."""
    return " ".join(text.split()).replace("|", "\\|")
