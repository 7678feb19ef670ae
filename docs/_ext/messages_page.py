"""The page of the messages of ``surefoot serve``, from their schema."""

import json
from pathlib import Path
from typing import Any

from schema_words import cell, default_words, value_words, words_of

SCHEMA = Path(__file__).parents[1] / "reference" / "server.schema.json"


def page() -> str:
    """Markdown: a table for each message."""
    schema = json.loads(SCHEMA.read_text())
    parts = [
        "# Server messages",
        "What `surefoot serve` and its clients say to each other: one JSON object in each WebSocket message "
        "([in another language](../../guides/server.md)). Fields in **bold** must be there.",
        "## From clients",
        *_messages(schema["from_client"]),
        "## From the server",
        *_messages(schema["from_server"]),
    ]
    return "\n\n".join(parts) + "\n"


def _messages(schema: dict[str, Any]) -> list[str]:
    parts = []
    for name, part in schema["$defs"].items():
        kind = part["properties"].get("type", {}).get("const")
        parts += [
            f"### {kind or words_of(name)}",
            " ".join(part.get("description", "").split()),
            _table(part),
        ]
    return parts


def _table(schema: dict[str, Any]) -> str:
    rows = ["| field | value | default | meaning |", "| --- | --- | --- | --- |"]
    for key, part in schema["properties"].items():
        shown = f"**{key}**" if key in schema.get("required", ()) else key
        about = cell(part.get("description", ""))
        rows.append(f"| {shown} | {cell(value_words(part))} | {default_words(part)} | {about} |")
    return "\n".join(rows)
