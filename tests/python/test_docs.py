"""The README and the docs say what is so.

Further pages than those named here are only held to what is common to all: links, quotations,
options. An option in a code span of its own is taken for one of quadcore's; those of other programs
are written with the program's name before them.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.cli import make_parser

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES += sorted((ROOT / "docs" / "commands").glob("*.md"))
COMMANDS = next(
    action.choices
    for action in make_parser()._actions
    if isinstance(action, argparse._SubParsersAction)
)


def name_of(page):
    return str(page.relative_to(ROOT))


def blocks(page, language):
    """Fenced blocks of a language, in order."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)


def prose(page):
    """The page without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)


def anchors(page):
    """Names that a link into the page may point to: headings as GitHub spells them, and ids."""
    names = set(re.findall(r'<a id="([^"]+)"', page.read_text()))
    for heading in re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", heading.lower())
        names.add(words.strip().replace(" ", "-"))
    return names


def options_of(*commands):
    return {option for command in commands for option in COMMANDS[command]._option_string_actions}


every_page = pytest.mark.parametrize("page", PAGES, ids=name_of)


@every_page
def test_every_relative_link_leads_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        linked = page.parent / file if file else page
        assert linked.exists(), target
        assert not anchor or anchor in anchors(linked), target


@every_page
def test_every_quadcore_command_line_is_one(page):
    lines = "\n".join(blocks(page, "(?:sh|bash|console)")).replace("\\\n", " ").splitlines()
    spans = re.findall(r"(?<!`)`([^`\n]+)`(?!`)", prose(page))
    # At the start of a line or behind a prompt or another command, after settings of variables.
    called = re.compile(
        r"(?:^|[|;&$])\s*(?:\w+=\S+\s+)*(?:python3? -m |\S*/)?quadcore ([a-z][\w-]*)([^|;&#]*)"
    )
    for line in lines + spans:
        for command, rest in called.findall(line):
            assert command in COMMANDS, line
            assert set(re.findall(r"(?<!\S)--[\w-]+", rest)) <= options_of(command), line


@every_page
def test_every_option_named_alone_exists(page):
    for span in re.findall(r"(?<!`)`(--[^`\n]+)`(?!`)", prose(page)):
        assert re.split(r"[ =]", span)[0] in options_of(*COMMANDS), span


@every_page
def test_what_is_quoted_is_so(page):
    text = page.read_text()
    quotations = re.findall(
        r"^<!-- quoted: (\S+) -->\n+```\w*\n(.*?)^```$", text, re.DOTALL | re.MULTILINE
    )
    assert len(quotations) == text.count("<!-- quoted:")
    for path, quoted in quotations:
        assert quoted in (ROOT / path).read_text(), path


def test_the_page_on_ros_has_the_kinds_that_the_node_carries_and_their_types():
    """The node's own table is in C++ and needs ROS to be asked."""
    source = (ROOT / "cpp/ros/messages/ros_types.cpp").read_text()
    carried = re.findall(r"transport<messages::(\w+), (\w+)::(\w+)>\(\)", source)
    # A fix, which goes out as two messages, has that of its place.
    carried += re.findall(r"TypedOutlet<messages::(\w+), (\w+)::(\w+)> place_;", source)
    carried += re.findall(r"outgoing<.*TypedOutlet<messages::(\w+), (\w+)::(\w+)>>", source)
    carried += re.findall(r"class (Scan)Outlet .*?Publisher<(\w+)::(\w+)>", source, re.DOTALL)
    assert len(carried) > 9
    table = dict(
        re.findall(r"^\| `(\w+)` \| `([\w/]+)` \|", (ROOT / "docs/ros.md").read_text(), re.M)
    )
    assert table == {kind.lower(): f"{package}/{name}" for kind, package, name in carried}


def test_each_command_has_a_page():
    pages = {page.stem for page in (ROOT / "docs" / "commands").glob("*.md")}
    assert pages == {*COMMANDS, "index"}


def test_the_page_of_plugins_has_a_row_for_each():
    page = ROOT / "docs" / "shipped_plugins.md"
    shipped = {file.name for folder in qc.plugin_folders() for file in Path(folder).glob("*.so")}
    rows = re.findall(r"^\| \[`(lib\w+\.so)`\]", page.read_text(), re.M)
    assert sorted(rows) == sorted(name for name in shipped if name.endswith("_plugin.so"))


def test_the_reference_is_what_the_generator_writes():
    generated = subprocess.run(
        [sys.executable, ROOT / "scripts" / "document_tags.py", "--print"],
        stdout=subprocess.PIPE,
        check=True,
    ).stdout
    assert generated.decode() == (ROOT / "docs" / "tags.md").read_text(encoding="utf-8"), (
        "docs/tags.md is out of date; run scripts/document"
    )


def test_the_reference_of_cpp_has_every_public_header_once():
    listed_headers = re.findall(
        r"doxygenfile:: (\S+)", (ROOT / "docs/reference/cpp.rst").read_text()
    )
    headers = (ROOT / "cpp").glob("*/include/quadcore/**/*.hpp")
    assert sorted(listed_headers) == sorted(header.name for header in headers)


def test_the_readme_is_short():
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 130
    (example,) = blocks(ROOT / "README.md", "python")
    assert len(example.strip().splitlines()) <= 8  # six, the import and a blank line


@pytest.mark.parametrize("engine", [name for name, _ in qc.engines()])
def test_the_model_of_the_guide_flies(engine, tmp_path):
    model, world = blocks(ROOT / "docs" / "models.md", "xml")
    (tmp_path / "hexarotor.urdf.xacro").write_text(model)
    (tmp_path / "windy.world").write_text(world)
    simulation = qc.Simulation(
        tmp_path / "hexarotor.urdf.xacro", engine=engine, world=tmp_path / "windy.world"
    )
    assert simulation.warnings == []
    simulation.command([510, -510] * 3)
    simulation.step(2000)
    assert simulation.state.position[0] > 0.1  # the wind takes it along
    assert simulation.state.linear_velocity[2] > 0
