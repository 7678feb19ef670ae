"""Writes the pages of the reference that follow from the code: `reference/generated`, anew at each build.

The public names of the packages, the commands, the keys of the YAML files and the messages of the server.
Nothing of it is committed, so nothing of it can be out of date.
"""

from importlib import import_module
from pathlib import Path

import api_page
import cli_page
import messages_page
import yaml_page
from sphinx.application import Sphinx
from sphinx.config import Config

PACKAGES = ("navmesh", "pathsmooth", "locomotion", "runtime")


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("config-inited", write_pages, priority=10)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def write_pages(app: Sphinx, config: Config) -> None:
    """Write all pages; a page that has not changed keeps its time, so that it is not read again."""
    folder = Path(app.srcdir) / "reference" / "generated"
    folder.mkdir(parents=True, exist_ok=True)
    pages = {f"{package}.rst": api_page.page(import_module(package)) for package in PACKAGES}
    pages["cli.md"] = cli_page.page()
    pages["yaml.md"] = yaml_page.page()
    pages["messages.md"] = messages_page.page()
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
