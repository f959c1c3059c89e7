# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The site that `./dev docs` makes of docs/: Sphinx reads what tools/site.py has laid out."""
import os
import pathlib

project = 'holdfast'
author = 'The holdfast authors'
copyright = 'The holdfast authors, Apache-2.0'
release = os.environ['HOLDFAST_VERSION']

extensions = ['myst_parser', 'sphinx_copybutton', 'sphinx.ext.autodoc', 'breathe']
source_suffix = {'.md': 'markdown'}
myst_heading_anchors = 6
myst_enable_extensions = ['colon_fence']
breathe_projects = {'holdfast': os.environ['HOLDFAST_DOXYGEN_XML']}
breathe_default_project = 'holdfast'
autodoc_member_order = 'bysource'
# The prompt and the outputs of commands are shown, not copied.
copybutton_prompt_text = '$ '
copybutton_only_copy_prompt_lines = True
# What may stand in C++ that Sphinx's parser does not know.
cpp_id_attributes = ['nodiscard']

html_theme = 'furo'
html_title = f'holdfast {release}'
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {'navigation_with_keys': True}
html_static_path = [str(pathlib.Path(__file__).parent / 'static')]
html_css_files = ['holdfast.css']
