"""Sphinx's settings for the site; `python docs/site` builds it."""

from rlv_landing import __version__
from rlv_landing.figures.style import COLOURS

project = "rlv-landing"
author = "The rlv-landing authors"
version = release = __version__
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
# notebooks are shown as they are stored; the suite runs them
nb_execution_mode = "off"
# as code hosts do
myst_heading_anchors = 4
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
napoleon_google_docstring = True
napoleon_use_ivar = True
# names of code in docstrings stand between single backticks
default_role = "literal"
smartquotes_action = "D"
highlight_language = "text"
html_theme = "furo"
html_title = f"rlv-landing {__version__}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": COLOURS[0], "color-brand-content": COLOURS[0]},
}
