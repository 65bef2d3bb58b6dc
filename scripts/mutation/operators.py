"""One-line mutants of C++ text: plausible mistakes."""

from __future__ import annotations

import re
from typing import Callable, Iterator, List, NamedTuple, Tuple, Union


class Mutant(NamedTuple):
    """A line of a file, and its replacement."""

    file: str
    line: int
    """Counted from 1."""
    before: str
    after: str


Replacement = Union[str, Callable[["re.Match[str]"], str]]


def _swap(a: str, b: str, around: str = r"(?<= ){}(?= )") -> List[Tuple[str, Replacement]]:
    return [(around.format(re.escape(x)), y) for x, y in ((a, b), (b, a))]


def _other_number(match: re.Match[str]) -> str:
    return {"0": "1", "1": "0", "0.0": "1.0", "1.0": "0.0"}.get(match[0], f"2*{match[0]}")


_WORD = r"\b{}\b"
_CALL = r"(?<=[\w)\]])\.{}\(\)"
# Patterns and their replacements. Binary operators are between spaces, as clang-format writes them;
# templates and pointers are not.
_SLIPS: List[Tuple[str, Replacement]] = [
    *_swap("+", "-"),
    *_swap("*", "/"),
    *_swap("+=", "-="),
    *_swap("*=", "/="),
    *_swap("<", "<="),
    *_swap(">", ">="),
    *_swap("==", "!="),
    *_swap("&&", "||"),
    *_swap("min", "max", _WORD),
    *_swap("sin", "cos", _WORD),
    *_swap("true", "false", _WORD),
    *_swap("break", "continue", _WORD),
    *_swap("rbegin", "begin", _WORD),
    *_swap("head", "tail", _WORD),
    *_swap("row", "col", r"(?<=\.){}(?=\()"),
    (r"(?:(?<=[(\[{,=?:] )|(?<=[(\[{])|(?<=return ))-(?=[\w(])", ""),  # unary minus
    (r"(?<![\w<.])\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w>.])", _other_number),
    (r"\bM_PI\b", "3.0"),
    (_CALL.format("x"), ".y()"),
    (_CALL.format("y"), ".z()"),
    (_CALL.format("z"), ".x()"),
    (_CALL.format("(?:transpose|inverse|normalized|cwiseAbs)"), ""),
    (r"\.cross\(", ".cwiseProduct("),
    (r"\bstd::(?:abs|floor|sqrt|hypot|remainder)\(", "("),
    (r"(?<=R)cm(?=_F\b)", ""),  # a rotor's origin for its centre of mass
    (r"(?<=[( ])!(?=[\w(])", ""),
]
_CONDITION = re.compile(r"^(\s*(?:\} else )?if )\((.*)\)( \{| \w.*;)$")
_STATEMENT = re.compile(r"^\s*(?:[\w:>.\[\]()*-]+(?:<[\w:, ]+>)?[\w:>.\[\]()-]*)"
                        r"(?:\(.*\)|\s[-+*/]?= .*|\+\+);$")  # fmt: skip
_KEPT = re.compile(r"^\s*(?:return|throw|using|const|static|namespace|template)\b")


def mutants_of(file: str, text: str) -> Iterator[Mutant]:
    """Yield every mutant of a file, in order."""
    lines = text.splitlines()
    complete = True  # the line begins a statement
    for number, line in enumerate(lines, 1):
        code = code_of(line)
        if code.strip() and not code.lstrip().startswith("#"):
            seen = {line}
            for after in _variants(code, line, complete):
                if after not in seen:
                    seen.add(after)
                    yield Mutant(file, number, line, after)
        complete = begins_statement(line, complete)


def code_of(line: str) -> str:
    """Blank comments and the contents of strings without changing the length."""
    blank = re.sub(r'"(?:\\.|[^"\\])*"', lambda m: '"' + "_" * (len(m[0]) - 2) + '"', line)
    return re.sub(r"//.*", lambda m: " " * len(m[0]), blank)


def begins_statement(line: str, complete: bool) -> bool:
    """Whether the next line begins a statement."""
    code = code_of(line).rstrip()
    return code[-1] in "{};:" if code else complete


def _variants(code: str, line: str, complete: bool) -> Iterator[str]:
    for pattern, replacement in _SLIPS:
        for match in re.finditer(pattern, code):
            new = replacement if isinstance(replacement, str) else replacement(match)
            yield line[: match.start()] + new + line[match.end() :]
    condition = _CONDITION.match(code.rstrip())
    if condition and balanced(condition[2]):
        for constant in ("true", "false"):
            yield line[: condition.start(2)] + constant + line[condition.end(2) :]
    statement = code.strip()
    if complete and _STATEMENT.match(code.rstrip()) and not _KEPT.match(code):
        yield line.replace(statement.rstrip(), ";")


def balanced(text: str) -> bool:
    """Whether all parentheses are balanced."""
    depth = 0
    for letter in text:
        depth += (letter == "(") - (letter == ")")
        if depth < 0:
            return False
    return depth == 0
