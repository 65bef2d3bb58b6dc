"""The installed package's shared libraries: what they export, what plugins are built for."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

import quadcore as qc

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ROOT / "cpp" / "core" / "include"
CORE = Path(qc.plugin_folders()[-1])


def exported(library: Path) -> list[str]:
    """Demangled names of the symbols that a library offers to others."""
    command = ["nm", "-D", "-C", "--defined-only", library]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    return [line.split(" ", 2)[2] for line in lines]


def test_the_core_exports_what_its_public_headers_declare_and_nothing_else():
    (core,) = CORE.glob("libquadcore.so*")  # one file: a wheel holds no links
    declared = set()
    for header in (Path(qc.cmake_prefix()) / "include").rglob("*.hpp"):
        declared |= set(re.findall(r"\w+", re.sub(r"//.*", "", header.read_text())))
    symbols = exported(core)
    assert any(symbol.startswith("quadcore::read_model(") for symbol in symbols)
    for symbol in symbols:
        # A function made from a template has its result in front.
        prefix = r"(?:(?:vtable|typeinfo|typeinfo name) for |void )?"
        named = re.match(prefix + r"quadcore::(\w+)", symbol)
        assert named and named[1] in declared, symbol


def test_plugins_and_bindings_export_their_one_door():
    plugins = list(CORE.glob("lib*_plugin.so"))
    assert len(plugins) >= 3
    for plugin in plugins:
        assert exported(plugin) == ["quadcore_plugin"]
    assert exported(Path(qc._core.__file__)) == ["PyInit__core"]


def test_the_core_says_which_version_programs_were_linked_with():
    (core,) = CORE.glob("libquadcore.so*")
    dynamic = subprocess.run(["readelf", "-d", core], capture_output=True, text=True, check=True)
    minor = ".".join(qc.__version__.split(".")[:2])
    assert f"soname: [libquadcore.so.{minor}]" in dynamic.stdout


def interface_hash(folder: Path, script: Path) -> str:
    """Hash of the plugin interface in a folder, by the function that the build calls."""
    source = ROOT / "cpp" / "core" / "plugin_interface.cmake"
    script.write_text(
        f'cmake_minimum_required(VERSION 3.16)\ninclude("{source}")\n'
        f'hash_headers(hash headers "{folder}/quadcore/plugin/*.hpp")\nmessage(STATUS ${{hash}})\n'
    )
    done = subprocess.run(["cmake", "-P", script], capture_output=True, text=True, check=True)
    return done.stdout


@pytest.fixture
def headers(tmp_path):
    """A copy of the public headers that may be changed."""
    subprocess.run(["cp", "-r", HEADERS, tmp_path / "include"], check=True)
    return tmp_path / "include"


def test_every_header_that_a_plugin_includes_is_in_the_hash_and_no_other(headers, tmp_path):
    installed = Path(qc.cmake_prefix()) / "include"
    page = (ROOT / "docs" / "plugins.md").read_text()
    offered = sorted(set(re.findall(r"core/include/(quadcore/[\w/]+\.hpp)", page)))
    assert "quadcore/plugin/random.hpp" in offered
    plugin = tmp_path / "plugin.cpp"
    plugin.write_text("#include <quadcore/plugin.hpp>\n")
    command = ["g++", "-std=c++17", "-M", "-DEIGEN_MAX_ALIGN_BYTES=16", "-I", installed]
    command += ["-DEIGEN_MALLOC_ALREADY_ALIGNED=1", "-isystem", "/usr/include/eigen3", plugin]
    rule = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    included = set(re.findall(r"include/(quadcore/\S+)", rule))
    assert set(offered) <= included
    included -= {"quadcore/plugin.hpp", "quadcore/plugin_interface.hpp"}  # name and hash the others
    before = interface_hash(headers, tmp_path / "hash.cmake")
    for header in sorted(headers.rglob("*.hpp")):
        text = header.read_text()
        header.write_text(text + "// changed\n")
        after = interface_hash(headers, tmp_path / "hash.cmake")
        name = str(header.relative_to(headers))
        assert (after != before) == (name in included), name
        header.write_text(text)
