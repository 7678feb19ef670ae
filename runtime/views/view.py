"""A page that plays a run in a browser: one HTML file that needs no server and no network."""

import base64
import gzip
import html
import json
import os
from pathlib import Path

from locomotion import Rig
from runtime.traces.trace import Trace
from runtime.views.camera import agent_named
from runtime.views.page_data import page_data
from surefoot.files.atomic_write import whole_file

__all__ = ["write_page"]

_PARTS = Path(__file__).with_name("page")
_SCRIPTS = (
    "reading.js",
    "geometry.js",
    "drawing.js",
    "figures.js",
    "skins.js",
    "camera.js",
    "labels.js",
    "page.js",
)


def write_page(
    trace: Trace, path: str | os.PathLike[str], follow: str | None = None, character: Rig | None = None
) -> None:
    """Write the page to ``path``, whole or not at all: level, graph, obstacles, paths, figures, events, time
    line. It opens on the agent ``follow``, by default the first, and its camera follows it. People wear
    the ``character``, if there is one. Raises `RuntimeInputError` for an unknown agent, and for a character
    that nobody can wear.
    """
    if follow is not None:
        agent_named(trace, follow)
    with whole_file(path) as temporary:
        temporary.write_text(_page(trace, follow, character), encoding="utf-8")


def _page(trace: Trace, follow: str | None, character: Rig | None) -> str:
    header, arrays = page_data(trace, follow, character)
    packed = base64.b64encode(gzip.compress(arrays, mtime=0)).decode("ascii")
    parts = {
        "title": html.escape(str(trace.report.get("mission", "a run"))),
        "style": _part("page.css"),
        "header": json.dumps(header, separators=(",", ":")).replace("<", "\\u003c"),
        "arrays": packed,
        "script": "\n".join(_part(name) for name in _SCRIPTS),
    }
    page = _part("page.html")
    for name, text in parts.items():
        page = page.replace(f"<!--{name}-->", text)
    return page


def _part(name: str) -> str:
    return (_PARTS / name).read_text(encoding="utf-8")
