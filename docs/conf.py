"""How `make docs` builds the site: `_toc.yml` gives the order of the pages, `_ext` writes the reference."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE / "_ext")]

import surefoot  # noqa: E402

project = "Surefoot"
author = "the authors of Surefoot"
version = release = surefoot.__version__
html_title = f"Surefoot {release}"

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx_external_toc",
    "sphinx_copybutton",
    "docstrings",
    "reference_pages",
]
exclude_patterns = ["_build", "_ext", "pictures"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

# Markdown as code hosts show it: the same anchors of headings, a word after "python" or "yaml" is no language
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]

# Docstrings: `name` is a link where the name is public, and code where it is not
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_class_signature = "mixed"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100
add_module_names = False
toc_object_entries = False
nitpicky = False

# Nothing comes from the network: furo brings its fonts and scripts
html_theme = "furo"
html_theme_options = {"navigation_with_keys": True, "top_of_page_buttons": []}
html_static_path: list[str] = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
copybutton_selector = "div.highlight-python pre, div.highlight-yaml pre, div.highlight-default pre"
