"""Many mutants of a file in one text; an environment variable selects one at run time.

This avoids a build for each mutant (R. H. Untch, A. J. Offutt, M. J. Harrold, "Mutation analysis
using mutant schemata", ISSTA 1993). It works for statements, declarations, conditions, loops and
short functions on one line; other mutants must be built alone.
"""

from __future__ import annotations

import re
from typing import Dict, List, NamedTuple, Optional

from operators import Mutant, balanced, begins_statement, code_of

CHOICE = "QUADCORE_MUTANT"
HEADER = f"""#pragma once
#include <cstdlib>
inline const char* const quadcore_mutant_text = std::getenv("{CHOICE}");
inline const long quadcore_mutant_number =
    quadcore_mutant_text ? std::strtol(quadcore_mutant_text, nullptr, 10) : 0;
#define MUTANT(n) (quadcore_mutant_number == n)
"""

_DECLARATION = re.compile(r"^\s*(const(?:expr)? )?([\w:]+(?:<[\w:, ]+>)?\*?) (\w+) = (.+);$")
_CONDITION = re.compile(r"^(\s*(?:\} else )?if \()(.*)\) \{$")
_LOOP = re.compile(r"^(\s*for \()([\w:]+) (\w+ =) (.*?); (.*)\) \{$")
_RETURN = re.compile(r"^(.*\{ )return ([^;]*); \}(.*)$")
_NO_STATEMENT = re.compile(
    r"^(?:else|\}|case|default|const|using|enum|struct|class|namespace|template)\b"
    r"|^(?!return |throw )[\w:<>, ]+[&*]* \w+(?:;|\(|\{| = |\[)"
)


class Schema(NamedTuple):
    """A file with many mutants."""

    text: str
    source_lines: List[int]
    """For each line of the text, its line in the file; 0 for an added line."""
    mutant_at: Dict[int, int]
    """Line of the text, counted from 1 -> number of its mutant."""
    left_out: List[int]
    """Numbers of the mutants that must be built alone."""


class _Choice(NamedTuple):
    """Parts of a line: before the mutants, one mutant, the original with the rest."""

    head: str
    mutant: str
    original: str


def schema(text: str, mutants: Dict[int, Mutant], header: str) -> Schema:
    """Write mutants, by their numbers, into the text of their file."""
    written = [f'#include "{header}"']
    source_lines, mutant_at, left_out = [0], {}, []
    lines = text.splitlines()
    complete = True
    for i, line in enumerate(lines, 1):
        following = lines[i].strip() if i < len(lines) else ""
        chosen: Dict[int, _Choice] = {}
        for number in [n for n, mutant in mutants.items() if mutant.line == i]:
            choice = _choice(line, mutants[number].after, complete, following)
            first = next(iter(chosen.values()), choice)
            if choice and (choice.head, choice.original) == (first.head, first.original):
                chosen[number] = choice
            else:
                left_out.append(number)
        if chosen:
            first = next(iter(chosen.values()))
            written.append(first.head)
            for number, choice in chosen.items():
                written.append(choice.mutant.replace("MUTANT()", f"MUTANT({number})"))
                mutant_at[len(written)] = number
            written.append(first.original)
        else:
            written.append(line)
        source_lines += [i] * (len(written) - len(source_lines))
        complete = begins_statement(line, complete)
    return Schema("\n".join(written) + "\n", source_lines, mutant_at, left_out)


def _choice(line: str, changed: str, complete: bool, following: str) -> Optional[_Choice]:
    old, new = (text[: len(code_of(text).rstrip())] for text in (line, changed))
    for form in (_condition, _loop, _returned, _declared):
        found = form(old, new)
        if found:
            return found
    if not (complete and old.endswith(";") and balanced(old)) or following.startswith("else"):
        return None
    if _NO_STATEMENT.match(old.strip()):
        return None
    return _Choice("", f"if (MUTANT()) {{ {new.strip()} }} else", f"{{ {old.strip()} }}")


def _condition(old: str, new: str) -> Optional[_Choice]:
    a, b = _CONDITION.match(old), _CONDITION.match(new)
    if not (a and b and balanced(a[2]) and balanced(b[2])):
        return None
    return _Choice(a[1], f"MUTANT() ? bool({b[2]}) :", f"bool({a[2]})) {{")


def _loop(old: str, new: str) -> Optional[_Choice]:
    a, b = _LOOP.match(old), _LOOP.match(new)
    if not (a and b) or a[4] == b[4]:
        return None
    return _Choice(
        f"{a[1]}{a[2]} {a[3]}", f"MUTANT() ? {a[2]}({b[4]}) :", f"{a[2]}({a[4]}); {a[5]}) {{"
    )


def _returned(old: str, new: str) -> Optional[_Choice]:
    a, b = _RETURN.match(old), _RETURN.match(new)
    if not (a and b) or (a[1], a[3]) != (b[1], b[3]):
        return None
    return _Choice(a[1], f"if (MUTANT()) return {b[2]};", f"return {a[2]}; }}{a[3]}")


def _declared(old: str, new: str) -> Optional[_Choice]:
    a, b = _DECLARATION.match(old), _DECLARATION.match(new)
    if not (a and b) or a[2] in ("auto", "return", "using", "else", "static"):
        return None
    if not (balanced(a[4]) and balanced(b[4])) or "," in re.sub(r"\(.*\)|\{.*\}|\[.*\]", "", a[4]):
        return None
    cast = "" if a[2].endswith("*") else a[2]
    head = f"{'const ' if a[1] else ''}{a[2]} {a[3]} ="
    return _Choice(head, f"MUTANT() ? {cast}({b[4]}) :", f"{cast}({a[4]});")
