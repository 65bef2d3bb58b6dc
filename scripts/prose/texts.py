"""Texts that people read, as Markdown: pages, the help of each command, docstrings.

Each text has a name and the line at which it begins, so that line N of the text is line
``line + N - 1`` of what the name says.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import re
import subprocess
from pathlib import Path
from typing import Iterator, List, NamedTuple

ROOT = Path(__file__).resolve().parents[2]


class Text(NamedTuple):
    """A text to check."""

    name: str
    line: int
    text: str


def read_pages() -> Iterator[Text]:
    """Read the Markdown files of the checkout."""
    list_files = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    names = subprocess.check_output(list_files, cwd=ROOT, text=True)
    for name in names.splitlines():
        if (ROOT / name).exists():  # git lists deleted files, too
            yield Text(name, 1, (ROOT / name).read_text(encoding="utf-8"))


def read_python_docstrings() -> Iterator[Text]:
    """Read the docstrings of public modules, classes, functions and attributes."""
    for file in sorted((ROOT / "python" / "quadcore").rglob("*.py")):
        name = str(file.relative_to(ROOT))
        for node in _list_public(ast.parse(file.read_text(encoding="utf-8"))):
            for string in _list_docstrings(node):
                yield Text(name, string.lineno, format_docstring(string.value.value))


def _list_public(tree: ast.AST) -> Iterator[ast.AST]:
    yield tree
    for node in ast.iter_child_nodes(tree):
        kinds = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
        if isinstance(node, kinds) and not node.name.startswith("_"):
            yield from _list_public(node) if isinstance(node, ast.ClassDef) else [node]


def _list_docstrings(node: ast.AST) -> Iterator[ast.Expr]:
    body: List[ast.stmt] = node.body  # type: ignore[attr-defined]
    is_function = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    for before, statement in zip([None, *body], body):
        if not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
            continue
        if isinstance(statement.value.value, str) and (before is None or not is_function):
            yield statement


def read_core_docstrings() -> Iterator[Text]:
    """Read the docstrings of the compiled module."""
    from quadcore import _core

    for name, thing in sorted(vars(_core).items()):
        members = vars(thing).items() if inspect.isclass(thing) else []
        for member, value in [("", thing), *sorted(members)]:
            text = inspect.getdoc(value) if callable(value) or member else None
            if text and not member.startswith("_") and not name.startswith("_"):
                signature = r"^(\d+\. )?\w+\(.*\)( -> .*)?$|^Overloaded function\.$"
                text = re.sub(signature, "", text, flags=re.MULTILINE)
                yield Text(f"quadcore._core.{name}.{member}".rstrip("."), 1, format_docstring(text))


def read_help() -> Iterator[Text]:
    """Read what ``quadcore --help`` and the help of each command print."""
    from quadcore.cli import make_parser

    yield from _read_help_of(make_parser())


def _read_help_of(parser: argparse.ArgumentParser) -> Iterator[Text]:
    formatter = parser._get_formatter()
    yield Text(f"{parser.prog} --help", 1, parser.description or "")
    yield Text(
        f"{parser.prog} --help, end", 1, re.sub(r"^\s+\S.*$", "", parser.epilog or "", flags=re.M)
    )
    for action in parser._actions:
        option = ", ".join(action.option_strings) or action.metavar or action.dest
        if action.help and action.help != argparse.SUPPRESS:
            yield Text(f"{parser.prog} --help, {option}", 1, formatter._expand_help(action))
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from _read_help_of(each)
            for command in action._choices_actions:
                yield Text(f"{parser.prog} --help, {command.dest}", 1, command.help or "")


def format_docstring(docstring: str) -> str:
    """Format a docstring of NumPy's convention as Markdown with the same lines."""
    lines = docstring.splitlines()
    indents = [len(line) - len(line.lstrip()) for line in lines[1:] if line.strip()]
    lines = [*lines[:1], *(line[min(indents, default=0) :] for line in lines[1:])]
    is_section = is_example = False
    for at, line in enumerate(lines):
        if re.match(r"-{3,}$", line) and at:
            is_section = True
            lines[at - 1] = lines[at] = ""
        elif is_section and not line.startswith(" "):
            lines[at] = ""  # the name and type of what the lines below describe
        elif is_section:
            lines[at] = line[4:]
        is_example = (is_example and bool(line.strip())) or line.lstrip().startswith(">>>")
        if is_example:
            lines[at] = ""
    return "\n".join(lines)
