"""A copy of the sources to write, build and test mutants."""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Dict, Iterator, List, Sequence, Set

from operators import Mutant
from plan import PARTS, Part
from schemata import CHOICE, HEADER, Schema, schema

_MUTATED = [source for part in PARTS for source in part.sources]
_COMPILED = ["CMakeLists.txt", "cpp", "tests", "examples", "urdf", "worlds", "config", "launch"]
# A small file spends half of its compile time on these headers.
_PRECOMPILED = ["Eigen/Geometry", "Eigen/LU", "map", "string", "vector", "cmath", "sstream"]
_TESTS = "quadcore_tests"  # with the plugins they need
_UNTOUCHED = "*test_elementary.cpp,*test_random.cpp"  # no part contains them
_MEMORY = 4 << 30  # bytes
_PATIENCE = 10  # processor time of a mutant's tests, relative to the original's


class Workshop:
    """Works on a copy; the user's files are only read."""

    def __init__(self, sources: Path, folder: Path) -> None:
        self.sources = sources
        self.tree, self.build, self.site = (folder / n for n in ("tree", "build", "site"))
        self.header = folder / "mutant.hpp"
        self.log = folder / "last_output.txt"
        self._limits: Dict[str, int] = {}
        self._copy()
        self._configure()

    def build_together(self, mutants: Dict[int, Mutant]) -> Set[int]:
        """Build as many mutants as possible together; returns their numbers.

        For the others, `schema` is not possible, or the compiler refuses them.
        """
        left = dict(mutants)
        while True:
            schemas = {}
            for file in _MUTATED:
                own = {n: m for n, m in left.items() if m.file == file}
                schemas[file] = schema(self._original(file), own, str(self.header))
                self._write(file, schemas[file].text)
                for number in schemas[file].left_out:
                    del left[number]
            if self._built(_TESTS):
                return set(left)
            refused = {n for file, s in schemas.items() for n in self._refused(file, s)}
            if not refused & set(left):
                raise SystemExit(f"the mutants do not build. See {self.log}.")
            for number in refused & set(left):
                del left[number]

    def build_originals(self) -> None:
        """Build the original sources."""
        for file in _MUTATED:
            self._write(file, self._original(file))
        if not self._built(_TESTS):
            raise SystemExit(f"the copy of the sources does not build. See {self.log}.")

    def prepare(self, part: Part) -> None:
        """Check that the tests pass without a mutant, and set their time limits."""
        for test in self._tests(part):
            if test in self._limits:
                continue
            self._limits[test] = 3600
            before = _processor_time()
            if not self._passes(test, 0):
                raise SystemExit(f"{test} fails without a mutant. See {self.log}.")
            self._limits[test] = 10 + int(_PATIENCE * (_processor_time() - before))

    def chosen(self, part: Part, number: int) -> str:
        """Return ``killed by TEST`` or ``survived`` for a mutant that was built with others."""
        for test in self._tests(part):
            if not self._passes(test, number):
                return f"killed by {test}"
        return "survived"

    def alone(self, part: Part, mutant: Mutant) -> str:
        """Build a mutant by itself; the verdict may also be ``does not build``."""
        lines = self._original(mutant.file).splitlines(keepends=True)
        lines[mutant.line - 1] = mutant.after + "\n"
        try:
            self._write(mutant.file, "".join(lines))
            return self.chosen(part, 0) if self._built(part.target) else "does not build"
        finally:
            self._write(mutant.file, self._original(mutant.file))

    def _original(self, file: str) -> str:
        return (self.sources / file).read_text(encoding="utf-8")

    def _write(self, file: str, text: str) -> None:
        if (self.tree / file).read_text(encoding="utf-8") != text:
            (self.tree / file).write_text(text, encoding="utf-8")

    def _refused(self, file: str, of: Schema) -> Iterator[int]:
        """Numbers of the mutants at which the compiler's complaints point."""
        output = self.log.read_text(encoding="utf-8", errors="replace")
        for found in re.finditer(re.escape(file) + r":(\d+):", output):
            line = int(found[1])
            if line in of.mutant_at:
                yield of.mutant_at[line]
            else:
                source = of.source_lines[line - 1]
                yield from (
                    n for at, n in of.mutant_at.items() if of.source_lines[at - 1] == source
                )

    def _copy(self) -> None:
        names = subprocess.run(
            ["git", "ls-files", "-z", "-co", "--exclude-standard", *_COMPILED],
            cwd=self.sources,
            check=True,
            stdout=subprocess.PIPE,
        ).stdout.decode()
        for name in names.rstrip("\0").split("\0"):
            there, here = self.sources / name, self.tree / name
            if not there.is_file() or (name in _MUTATED and here.exists()):
                continue
            if not here.exists() or here.read_bytes() != there.read_bytes():
                here.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(there, here)
        headers = " ".join(f"<{name}>" for name in _PRECOMPILED)
        with (self.tree / "CMakeLists.txt").open("a") as stream:
            stream.write(f"target_precompile_headers(quadcore PRIVATE {headers})\n")
            stream.write(f"target_compile_options({_TESTS} PRIVATE -O0)\n")

    def _configure(self) -> None:
        self.header.write_text(HEADER)
        flags = "-O1 -D_GLIBCXX_ASSERTIONS"  # Eigen's assertions are on as well
        configure = ["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja"]
        configure += ["-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_CXX_FLAGS_DEBUG={flags}"]
        configure += ["-DQUADCORE_BUILD_TESTS=ON", "-DQUADCORE_WITH_ROS=OFF"]
        if not self._ran(configure):
            raise SystemExit(f"CMake fails. See {self.log}.")
        shutil.rmtree(self.site, ignore_errors=True)

    def _built(self, target: str) -> bool:
        if not self._ran(["cmake", "--build", self.build, "--target", target, "--", "-k", "0"]):
            return False
        if not self.site.exists():
            import quadcore

            shutil.copytree(Path(quadcore.__file__).parent, self.site / "quadcore")
        for library in (self.build / "lib").glob("*.so*"):
            if not library.is_symlink():
                shutil.copy(library, self.site / "quadcore" / "lib" / library.name)
        return True

    def _tests(self, part: Part) -> List[str]:
        return [_TESTS, *part.tests]

    def _passes(self, test: str, chosen: int) -> bool:
        if test.endswith(".py"):
            command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
            command += ["--no-header", f"tests/python/{test}"]
        else:
            command = [str(self.build / "tests" / "cpp" / test), "--abort-after=1"]
            command += [f"--source-file-exclude={_UNTOUCHED}"]
        return self._ran(command, self._limits[test], chosen)

    def _ran(self, command: Sequence[object], processor_time: int = 3600, chosen: int = 0) -> bool:
        def limit() -> None:
            resource.setrlimit(resource.RLIMIT_CPU, (processor_time, processor_time))
            resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        with self.log.open("wb") as stream:
            return not subprocess.run(
                list(map(str, command)),
                cwd=self.tree,
                env={**os.environ, "PYTHONPATH": str(self.site), CHOICE: str(chosen)},
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                preexec_fn=limit,
            ).returncode


def _processor_time() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
