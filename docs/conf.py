"""The documentation as a site: `sphinx-build -W -n docs OUT`, with the extra `docs` installed.

`-D symobs_examples=NAME,…` builds a gallery of these alone, `-D symobs_live=URL` links every example to a live page.
"""

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_site"), str(HERE.parent)]  # the extension, and the symobs of this checkout

project = "symobs"
author = copyright = "The symobs authors"  # noqa: A001 - Sphinx's name
release = version = tomllib.loads((HERE.parent / "pyproject.toml").read_text())["project"]["version"]
extensions = ["myst_parser", "sphinx_copybutton", "symobs_docs"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_site", "_cache"]
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 3
suppress_warnings = ["myst.header"]  # a derivation begins at a heading of its own
nitpicky = True
html_theme = "furo"
html_title = "symobs"
html_copy_source = html_show_sourcelink = False
html_theme_options = {"light_css_variables": {"color-brand-primary": "#1f5fbf", "color-brand-content": "#1f5fbf"}}
html_static_path = ["_site/static"]
html_css_files = ["gallery.css"]
copybutton_prompt_text = ""
