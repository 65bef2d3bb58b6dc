"""The pages as a site: `scripts/docs` builds it."""

import re
import subprocess
import sys
from pathlib import Path

from docutils import nodes

import quadcore

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
BUILD = ROOT / "build" / "docs"
MADE = BUILD / "made"

project = "quadcore"
author = "the quadcore authors"
copyright = f"2026, {author}"
release = version = quadcore.__version__

extensions = [
    "breathe",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx-mathjax-offline",
    "sphinxarg.ext",
]
html_theme = "furo"
html_title = f"quadcore {release}"
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_search_scorer = str(DOCS / "static" / "search_scorer.js")
html_extra_path = [str(MADE / "extra")]

myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_google_docstring = False
napoleon_use_ivar = True
breathe_projects = {"quadcore": str(MADE / "xml")}
breathe_default_project = "quadcore"
suppress_warnings = ["duplicate_declaration.cpp"]  # headers open one namespace, again and again


def _as_sphinx_reads_it(app, docname, source):
    """Files of the checkout become their paths, as the site is read without it; anchors labels.

    A link that is called as its file is gets the title of the page, and formulas lose the
    backquotes that one reader of the pages wants.
    """
    folder = (DOCS / docname).parent

    def link(match):
        words, target, anchor = match.groups()
        leads_to = (folder / target).resolve()
        if DOCS not in leads_to.parents:
            return f"{words} (`{leads_to.relative_to(ROOT)}`)"
        return f"[{'' if words.endswith('.md') else words}]({target}{anchor or ''})"

    source[0] = re.sub(r"(?<!!)\[([^\]]+)\]\(([^):#]+)(#[^)]*)?\)", link, source[0])
    source[0] = re.sub(r"\$`([^`]+)`\$", r"$\1$", source[0])
    source[0] = re.sub(r'^<a id="([^"]+)"></a>$', r"(\1)=", source[0], flags=re.MULTILINE)


def _tidy(app, doctree):
    """Leave out defaults that say nothing, and call attributes what the docstrings call them."""
    for paragraph in list(doctree.findall(nodes.paragraph)):
        if paragraph.astext() in ("Default: []", "Default: False"):
            paragraph.parent.remove(paragraph)
    for name in doctree.findall(nodes.field_name):
        if name.astext() == "Variables":
            name[0] = nodes.Text("Attributes")


def _is_documented_by_its_class(app, what, name, member, skip, options):
    """Skip fields of named tuples, of which Python says but their numbers."""
    return (getattr(member, "__doc__", "") or "").startswith("Alias for field number") or None


def _make_flights(page):
    """Simulate the spiral with three controllers, for the animation on the first page."""
    quadcore_ = [sys.executable, "-m", "quadcore"]
    flight = "--engine eigen --xacro sim_slow:=1 --reference spiral --duration 20 --log-every 20"
    logs = []
    for controller in ("pid_thesis", "pd", "geometric"):
        folder = str(MADE / "flights" / controller)
        words = ["run", "quadrotor", *flight.split(), "--quiet", "--no-plots", "--out", folder]
        process = subprocess.run([*quadcore_, *words, "--controller", controller])
        assert process.returncode in (0, 3)  # the printed gains lose the vehicle
        logs.append(f"{folder}/log.csv")
    subprocess.run([*quadcore_, "play", *logs, "--model", "quadrotor", "-o", str(page)], check=True)


def setup(app):
    """Make what the pages are made of: the headers' comments, and flights."""
    (MADE / "extra").mkdir(parents=True, exist_ok=True)
    subprocess.run(["doxygen", "docs/Doxyfile"], cwd=ROOT, check=True)
    _make_flights(MADE / "extra" / "flights.html")
    app.connect("source-read", _as_sphinx_reads_it)
    app.connect("doctree-read", _tidy)
    app.connect("autodoc-skip-member", _is_documented_by_its_class)
