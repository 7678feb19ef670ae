"""Shows docstrings as they are meant: our lists as lists and our code as code.

A docstring describes parameters as lines of the form ``name: what it is``; what goes on in the next line is
indented. Here each becomes an item of a list. Indented lines after an empty one are code.
"""

import re
from itertools import groupby
from typing import Any

from numpy.typing import ArrayLike
from sphinx.application import Sphinx
from sphinx.util.typing import stringify_annotation

_ITEM = re.compile(r"^([a-z_`*]\w*[`*]*(?:, [a-z_`*]\w*[`*]*)*): +(?=\S)")
_ARRAY_LIKE = stringify_annotation(ArrayLike, "smart")
_NOT_BY_HAND = re.compile(r"made by|Make one with|Made by")
_ARRAY = re.compile(
    r"(?:~?numpy\.)?ndarray\[(?:~?typing\.)?tuple\[.*?\], (?:~?numpy\.)?dtype\[(?:~?numpy\.)?(\w+)\]\]"
)


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _process(app: Sphinx, what: str, name: str, value: Any, options: Any, lines: list[str]) -> None:
    lines[:] = as_rst(lines)


def _signature(app: Sphinx, what: str, name: str, value: Any, options: Any, shown: str, returned: str) -> Any:
    """Leave out how a class is made that nobody makes by hand; show the types of arrays as the code does."""
    if what == "class" and (
        (value.__doc__ and _NOT_BY_HAND.search(value.__doc__)) or "<factory>" in (shown or "")
    ):
        return "", None
    return _short(shown), _short(returned)


def _short(text: str | None) -> str | None:
    return text and _ARRAY.sub(r"NDArray[\1]", text.replace(_ARRAY_LIKE, "ArrayLike"))


def as_rst(lines: list[str]) -> list[str]:
    """The lines of a docstring with its lists and code marked as such."""
    done: list[str] = []
    in_code = False
    for blank, group in groupby(lines, key=lambda line: not line.strip()):
        paragraph = list(group)
        if not blank and paragraph[0] == "Attributes:":
            paragraph = [line.removeprefix("    ") for line in paragraph[1:]]
        if not blank and paragraph[0].startswith("    "):
            done += [] if in_code or not done else ["::", ""]
            in_code = True
        elif not blank:
            in_code = paragraph[-1].endswith("::")
            if _is_list(paragraph):
                paragraph = ["", *map(_item, paragraph), ""]
        done += paragraph
    return done


def _is_list(paragraph: list[str]) -> bool:
    """Whether the first line begins an item, and every other one does or is indented."""
    return bool(_ITEM.match(paragraph[0])) and all(
        line.startswith("    ") or _ITEM.match(line) for line in paragraph
    )


def _item(line: str) -> str:
    return _ITEM.sub(r"- **\1**: ", line) if _ITEM.match(line) else f"  {line.strip()}"
