"""List the tests of a file: those that import it, name it, or are listed for its mutants."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Dict, Iterator, List, Sequence

sys.path.insert(0, str(Path(__file__).parent / "mutation"))
from plan import PARTS

PYTHON = Path("tests/python")
MOST = 4
"""Test files for one source."""


def tests_of(paths: Sequence[Path]) -> List[str]:
    """List the files of tests/python that know some files."""
    texts = {path: path.read_text(encoding="utf-8") for path in sorted(PYTHON.rglob("test_*.py"))}
    return sorted({str(test) for path in paths for test in _python_tests(path, texts)})


def _python_tests(path: Path, texts: Dict[Path, str]) -> Iterator[Path]:
    if path in texts:
        yield path
    elif path.parts[:2] == PYTHON.parts:
        yield from _that_hold(rf"\b{path.stem}\b", texts)
    elif path.parts[:2] == ("python", "quadcore"):
        module = ".".join(path.with_suffix("").parts[1:])
        imports = rf"{module}\b|from {module.rpartition('.')[0]} import [^\n]*\b{path.stem}\b"
        yield from [*_that_hold(imports, texts), *_closest(path, texts)][:MOST]
    elif path.parts[0] == "cpp":
        listed = [
            PYTHON / test for part in PARTS if str(path) in part.sources for test in part.tests
        ]
        yield from listed[:MOST] or _closest(path, texts)
    else:
        yield from _that_hold(re.escape(path.name if path.suffix else str(path)), texts)


def _closest(path: Path, texts: Dict[Path, str]) -> List[Path]:
    """List the tests that are named after a source, or else after its folder."""
    for name in (path.stem, path.parent.name):
        found = [test for test in texts if re.search(rf"_{name.rstrip('s')}", test.stem)]
        if found:
            return found[:MOST]
    return []


def _that_hold(pattern: str, texts: Dict[Path, str]) -> List[Path]:
    return [test for test, text in texts.items() if re.search(pattern, text)][:MOST]
