"""What stands in the pages of the documentation: their links, headings, code and commands."""

import re
from collections import Counter
from functools import cache
from pathlib import Path
from typing import NamedTuple

from markdown_it import MarkdownIt
from markdown_it.token import Token

ROOT = Path(__file__).parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *sorted(page for page in (ROOT / "docs").rglob("*.md") if "generated" not in page.parts),
]


class Block(NamedTuple):
    """A fenced block of code: ``language`` and what else stands behind the fence, such as "fragment"."""

    page: Path
    line: int
    language: str
    note: str
    text: str

    def __str__(self) -> str:
        return f"{name(self.page)}:{self.line}"


def name(page: Path) -> str:
    """How a page is called in messages."""
    return str(page.relative_to(ROOT))


@cache
def _tokens(page: Path) -> list[Token]:
    return MarkdownIt("commonmark").enable("table").parse(page.read_text())


def _inline(page: Path) -> list[Token]:
    return [child for token in _tokens(page) for child in token.children or ()]


def links(page: Path) -> list[str]:
    """Where the links and pictures of ``page`` lead."""
    targets = [token.attrs.get("href") or token.attrs.get("src") for token in _inline(page)]
    return [str(target) for target in targets if target]


@cache
def anchors(page: Path) -> set[str]:
    """The anchors of the headings of ``page``, as code hosts and MyST make them."""
    found: Counter[str] = Counter()
    anchors: set[str] = set()
    tokens = _tokens(page)
    for k, token in enumerate(tokens):
        if token.type == "heading_open":
            text = "".join(child.content for child in tokens[k + 1].children or ())
            slug = re.sub(r"[^\w\- ]", "", text.lower().strip()).replace(" ", "-")
            anchors.add(f"{slug}-{found[slug]}" if found[slug] else slug)
            found[slug] += 1
    return anchors


def blocks(page: Path, language: str) -> list[Block]:
    """The fenced blocks of ``page`` in ``language``."""
    found = []
    for token in _tokens(page):
        if token.type == "fence":
            word, _, note = token.info.partition(" ")
            if word == language:
                found.append(
                    Block(page, token.map[0] + 1 if token.map else 0, word, note.strip(), token.content)
                )
    return found


def without_language(page: Path) -> list[str]:
    """The fenced blocks of ``page`` that do not say what they are."""
    return [token.content for token in _tokens(page) if token.type == "fence" and not token.info]


def typed(page: Path) -> list[str]:
    """The lines that a reader types: those of indented blocks, without remarks behind them."""
    lines = [
        line for token in _tokens(page) if token.type == "code_block" for line in token.content.splitlines()
    ]
    return [re.sub(r"\s+#.*", "", line) for line in lines]


def spans(page: Path) -> list[str]:
    """The code within sentences and tables."""
    return [token.content for token in _inline(page) if token.type == "code_inline"]
