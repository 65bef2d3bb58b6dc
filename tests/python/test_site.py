"""The pages as a site, as scripts/docs builds it: without a network, on laptop and telephone."""

from __future__ import annotations

import html.parser
import json
import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from browser import assert_it_plays, look_at_pages, what_sticks_out

SITE = Path(__file__).resolve().parents[2] / "build" / "docs" / "html"
WIDTHS = (1280, 390)  # px; narrowing shows what keeps its width


def is_of_today():
    """Whether the site was built after the last change of a page."""
    index, docs = SITE / "index.html", SITE.parents[2] / "docs"
    pages = (file for file in docs.rglob("*") if file.suffix in (".md", ".rst", ".py", ".css"))
    return index.exists() and index.stat().st_mtime > max(p.stat().st_mtime for p in pages)


pytestmark = pytest.mark.skipif(
    not is_of_today(), reason="the site is not built, or older than a page; scripts/docs builds it"
)


class Page(html.parser.HTMLParser):
    """What a page fetches by itself, where its links lead, and the names that lead into it."""

    def __init__(self, file):
        super().__init__()
        self.fetched, self.links, self.names = set(), set(), set()
        self.feed(file.read_text())

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.names |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        if tag == "a":
            self.links.add(attributes.get("href") or "")
        elif tag == "link" and attributes["rel"] not in ("index", "search", "next", "prev"):
            self.fetched.add(attributes["href"])
        if attributes.get("src"):
            self.fetched.add(attributes["src"])


@pytest.fixture(scope="module")
def pages():
    """Of the site, by their files; not those that its theme's scripts bring along."""
    files = [file for file in SITE.rglob("*.html") if "_static" not in file.parts]
    return {file: Page(file) for file in sorted(files)}


def test_no_page_of_the_site_needs_a_network(pages):
    for file, page in pages.items():
        for fetched in page.fetched:
            assert not re.match(r"(\w+:)?//", fetched), f"{file}: {fetched}"
            assert (file.parent / fetched.partition("?")[0]).exists(), f"{file}: {fetched}"
    for sheet in SITE.rglob("*.css"):
        assert not re.search(r"@import|url\(['\"]?(\w+:)?//", sheet.read_text()), sheet


def test_every_link_within_the_site_leads_to_its_place(pages):
    for file, page in pages.items():
        for link in page.links:
            if re.match(r"(\w+:)", link):
                continue
            target, _, name = unquote(link).partition("#")
            leads_to = (file.parent / target).resolve() if target else file
            assert leads_to.is_file(), f"{file}: {link}"
            if name and leads_to in pages:
                assert name in pages[leads_to].names, f"{file}: {link}"


def test_no_page_of_the_site_is_cut_on_a_laptop_and_on_a_telephone(pages, tmp_path):
    with_player = [SITE / "index.html"]  # which is opened again at each width
    others = [page for page in pages if page not in with_player]
    found = what_sticks_out(with_player, WIDTHS, tmp_path)
    found.update(what_sticks_out(others, WIDTHS, tmp_path, once=True))
    assert [(*key, *out) for key, out in found.items() if out] == []


def test_the_player_on_the_first_page_flies_to_the_end(tmp_path):
    assert_it_plays(SITE / "index.html", WIDTHS, tmp_path)


FOUND = {
    "install": ("install",),
    "trajectory": ("control",),
    "tracking error": ("tracking_errors", "evaluate"),
    "frames": ("concepts",),
    "NED": ("concepts",),
    "gains": ("tune", "control"),
    "wind": ("disturbances",),
    "mass": ("models",),
    "crash": ("troubleshooting",),
    "plugin": ("plugins", "shipped_plugins"),
    "topic": ("plugins", "tags", "ros"),
    "ROS 2": ("install", "troubleshooting"),
    "MATLAB": ("matlab",),
    "GPU": ("install", "troubleshooting"),
    "licence": ("troubleshooting",),
}
"""Pages of which one must be among the first three results of a search."""

SEARCH = """
async function look(view, inside) {
  const found = {};
  view.eval("DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false");  // fetches each page found
  for (const query of Object.keys(QUERIES)) {
    inside.querySelector("#search-results").replaceChildren();
    view.eval(`Search.performSearch(${JSON.stringify(query)})`);
    const summary = () => inside.querySelector("#search-results .search-summary").textContent;
    while (!/finished|did not match/.test(summary())) {
      await new Promise((resolve) => view.setTimeout(resolve, 20));
    }
    const links = [...inside.querySelectorAll("#search-results ul.search > li > a")];
    found[query] = links.slice(0, 3).map((link) => new URL(link.href).pathname);
  }
  return found;
}
"""


def test_a_search_of_the_site_finds_the_page_wanted_among_the_first_three(tmp_path):
    script = f"const QUERIES = {json.dumps(FOUND)};{SEARCH}"
    (found,) = look_at_pages(script, [SITE / "search.html"], [1280], tmp_path).values()
    firsts = {
        query: [Path(place).relative_to(SITE).with_suffix("").as_posix() for place in places]
        for query, places in found.items()
    }
    missed = [f"{q}: {firsts[q]}" for q in FOUND if not set(FOUND[q]) & set(firsts[q])]
    assert missed == []
