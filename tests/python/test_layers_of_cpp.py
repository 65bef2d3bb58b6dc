"""Includes of the C++ libraries point down.

Each folder of cpp is a library that links those below it, so that a private header from above does
not compile. Public headers share one include root; here they belong to the library that has the
source of the same name. A header without one belongs to nobody, and its own includes count.
"""

import re
from functools import lru_cache
from pathlib import Path

import pytest

CPP = Path(__file__).resolve().parents[2] / "cpp"
INCLUDE = re.compile(r'^#include "(.*)"', re.MULTILINE)


def read_libraries():
    """Return the folder of each library, and the libraries that each links."""
    folders, links = {}, {}
    for file in (CPP / name / "CMakeLists.txt" for name in ("core", "engines", "control", "batch")):
        for listed in file.parent.rglob("CMakeLists.txt"):
            text = listed.read_text(encoding="utf-8")
            for name in re.findall(r"quadcore_add_objects\((\w+)", text):
                folders[name] = listed.parent
            for name, linked in re.findall(r"target_link_libraries\((\w+)([^)]*)\)", text):
                links[name] = set(re.findall(r"quadcore_\w+", linked))
    return folders, links


FOLDERS, LINKS = read_libraries()
ROOTS = [*FOLDERS.values(), CPP / "core" / "include", CPP / "control" / "include", CPP / "engines"]
SOURCES = {
    source.stem: name
    for name, folder in FOLDERS.items()
    for source in folder.glob("*.cpp")
    if folder.parent.name in ("src", "engines")
}


def library_of(file):
    """Return the library that a source or a header belongs to, or None."""
    if CPP / "core" / "include" in file.parents:
        return SOURCES.get(file.stem)
    by_folder = {folder: name for name, folder in FOLDERS.items()}
    return next((by_folder[folder] for folder in file.parents if folder in by_folder), None)


def below(library):
    return {library}.union(*(below(linked) for linked in LINKS.get(library, ())))


@lru_cache(maxsize=None)
def find(name, folder):
    places = (root / name for root in (folder, *ROOTS))
    return next((place for place in places if place.is_file()), None)


def find_included(file, seen):
    """Yield the owned headers that a file includes, through those that nobody owns."""
    for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
        header = find(name, file.parent)
        if header is None or header in seen:
            continue
        seen.add(header)
        if library_of(header):
            yield header
        else:
            yield from find_included(header, seen)


def upward(file):
    allowed = below(library_of(file))
    return [
        f"{file.relative_to(CPP)} of {library_of(file)} includes {header.relative_to(CPP)}"
        f" of {library_of(header)}"
        for header in find_included(file, set())
        if library_of(header) not in allowed
    ]


@pytest.mark.parametrize("library", sorted(FOLDERS))
def test_includes_point_down(library):
    files = [f for f in CPP.rglob("*.[ch]pp") if library_of(f) == library]
    assert files
    assert [fault for file in files for fault in upward(file)] == []


def test_an_include_that_points_up_is_found(tmp_path, monkeypatch):
    file = FOLDERS["quadcore_read"] / "probe.cpp"
    monkeypatch.setattr(
        Path,
        "read_text",
        lambda path, encoding: '#include "quadcore/simulation.hpp"\n' if path == file else "",
    )
    assert upward(file) == [
        "core/src/read/probe.cpp of quadcore_read includes core/include/quadcore/simulation.hpp"
        " of quadcore_simulation"
    ]
