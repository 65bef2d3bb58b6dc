"""Verdicts on mutants: a table that all runs share, and its summary."""

from __future__ import annotations

import csv
import hashlib
from collections import Counter
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Set, Tuple

from operators import Mutant


class Result(NamedTuple):
    """One row of the table."""

    part: str
    file: str
    line: int
    before: str
    after: str
    verdict: str
    source: str
    """Digest of the file."""
    tests: str
    """Digest of all tests."""


class Results:
    """Verdicts in a CSV file, each written at once, so that an interrupted run keeps them."""

    def __init__(self, path: Path, sources: Path) -> None:
        self._path = path
        self._sources = sources
        tests = sources / "tests"
        self._tests = _digest(sorted([*tests.glob("cpp/*.?pp"), *tests.glob("python/*.py")]))
        self._files: Dict[str, str] = {}
        self._rows: Dict[Tuple[str, str, int, str], Result] = {}
        if path.exists():
            with path.open(newline="", encoding="utf-8") as stream:
                for row in csv.DictReader(stream):
                    values = {**row, "line": int(row["line"])}
                    self._keep(Result(**values))  # type: ignore[arg-type]
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("w", newline="", encoding="utf-8") as stream:
                csv.writer(stream).writerow(Result._fields)

    def known(self, mutant: Mutant) -> Optional[str]:
        """Return the valid verdict on a mutant; a survivor has none after tests changed."""
        row = self._rows.get((mutant.file, self._source(mutant.file), mutant.line, mutant.after))
        if row is None or (row.verdict == "survived" and row.tests != self._tests):
            return None
        return row.verdict

    def add(self, part: str, mutant: Mutant, verdict: str) -> None:
        """Store a verdict."""
        row = Result(part, *mutant, verdict, self._source(mutant.file), self._tests)
        self._keep(row)
        with self._path.open("a", newline="", encoding="utf-8") as stream:
            csv.writer(stream).writerow(row)

    def _keep(self, row: Result) -> None:
        self._rows[row.file, row.source, row.line, row.after] = row

    def _source(self, file: str) -> str:
        if file not in self._files:
            self._files[file] = _digest([self._sources / file])
        return self._files[file]


Pair = Tuple[str, str, str]  # file, before, after


def explained(path: Path) -> Set[Pair]:
    """Read the mutants without a relevant effect, from a file of entries separated by empty lines.

    An entry is a line ``FILE``, pairs of lines ``- BEFORE`` and ``+ AFTER``, and the reason.
    """
    found: Set[Pair] = set()
    for entry in path.read_text(encoding="utf-8").split("\n\n"):
        lines = [line for line in entry.splitlines() if line and not line.startswith("#")]
        if not lines:
            continue
        file, before, pairs = lines[0].strip(), "", 0
        for line in lines[1:]:
            if line.startswith("- "):
                before = line[2:].strip()
            elif line.startswith("+ "):
                found.add((file, before, line[2:].strip()))
                pairs += 1
        if not pairs or not lines[-1].startswith("  "):
            raise SystemExit(f"{path}: the entry of {file} has no mutant or no reason. Add it.")
    return found


def sorted_out(
    verdicts: List[Tuple[str, Mutant, str]], reasons: Set[Pair]
) -> Tuple[str, List[Mutant]]:
    """Return a table of counts for each part, and the survivors without a reason."""
    counts: Dict[str, Counter] = {}
    total: Counter = Counter()
    unexplained = []
    for part, mutant, verdict in verdicts:
        kind = verdict.split(" by ")[0]
        if kind == "survived":
            if (mutant.file, mutant.before.strip(), mutant.after.strip()) in reasons:
                kind = "explained"
            else:
                unexplained.append(mutant)
        for count in (counts.setdefault(part, Counter()), total):
            count[kind] += 1
    lines = ["part         killed  survived  explained   killed of all"]
    for name, c in [*counts.items(), ("all", total)]:
        tried = c["killed"] + c["survived"] + c["explained"]
        row = f"{name:12} {c['killed']:6} {c['survived']:9} {c['explained']:10}"
        lines.append(row + (f"{100 * c['killed'] / tried:14.1f} %" if tried else ""))
    return "\n".join(lines), unexplained


def _digest(files: List[Path]) -> str:
    whole = hashlib.sha256()
    for file in files:
        whole.update(file.read_bytes())
    return whole.hexdigest()[:16]
