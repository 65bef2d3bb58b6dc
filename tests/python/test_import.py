"""What `import quadcore` brings in, and what it leaves until somebody asks."""

import ast
import os
import shutil
import subprocess
from pathlib import Path

from processes import script

import quadcore as qc
from quadcore.support import core_library

# Each takes longer to import than quadcore itself, or brings in what does.
SLOW = [
    *["matplotlib", "mpl_toolkits", "scipy", "jinja2", "markupsafe", "rich", "xacro", "rospkg"],
    *["yaml", "cma", "gymnasium"],
    *["xml.dom", "xml.sax", "urllib.request", "http", "email", "ssl", "multiprocessing", "json"],
]

# Few calls need them.
LATE = ["difflib", "hashlib", "shutil", "tempfile", "quadcore.formats.recordings"]

PACKAGE = Path(qc.__file__).parent
PACKAGES = {
    "autopilots": {
        "ArduPilot",
        "Autopilot",
        "Betaflight",
        "Crazyflie",
        "PX4",
        "Readings",
        "Sticks",
        "read_autopilot",
    },
    "gym": {"Env", "NAME", "OBSERVATIONS", "REWARDS", "VectorEnv"},
    "serve": {"Client", "Server", "ServerError"},
    "fmu": {"export_fmu"},
    "thesis.chapter2": {"GYROSTAT", "THESIS", "MathematicalModel", "Terms", "Vehicle"},
}


def test_importing_quadcore_brings_in_numpy_and_nothing_slow():
    asked = f"print(*(name for name in {SLOW + LATE} if name in set(sys.modules) - before))"
    text = f"import sys, numpy; before = set(sys.modules); import quadcore; {asked}"
    assert script(text).stdout.split() == []


def test_a_urdf_is_flown_without_them(tmp_path):
    (tmp_path / "plain.urdf").write_text(qc.read_model("quadrotor").document.text)
    text = (
        "import sys, numpy; before = set(sys.modules); import quadcore;"
        "quadcore.Simulation('plain.urdf').run(0.1).to_csv('log.csv');"
        f"print(*(name for name in {SLOW} if name in set(sys.modules) - before))"
    )
    done = script(text, cwd=tmp_path)
    assert (tmp_path / "log.csv").exists(), done.stderr
    assert done.stdout.split() == []


def test_the_command_line_starts_without_what_only_some_commands_need():
    slow = [*SLOW[:4], "xacro", "cma", "gymnasium", "pandas", "fmpy", "pyulog"]
    text = f"import sys, quadcore.cli; print(*(name for name in {slow} if name in sys.modules))"
    assert script(text).stdout.split() == []


def test_every_name_is_there_when_it_is_asked_for():
    text = "import quadcore; print(*(name for name in dir(quadcore) if hasattr(quadcore, name)))"
    assert set(qc.__all__) <= set(script(text).stdout.split())
    assert "has no attribute 'evaluat'" in script("import quadcore; quadcore.evaluat").stderr


def test_the_packages_show_exactly_their_public_names():
    """Names of modules that are imported on the way are not public."""
    assert dir(qc) == sorted(qc.__all__)
    for name, public in PACKAGES.items():
        found = script(f"from quadcore.{name} import *; print(*dir())").stdout.split()
        assert {each for each in found if not each.startswith("__")} == public, name


def test_public_modules_are_imported_by_their_public_names():
    text = "from quadcore.controllers import pd; import quadcore.references, quadcore.gains"
    text += "; print(pd())"
    assert script(text).stdout.startswith("quadcore.controllers.pd(")


def imports_of(file):
    """Names that a module imports from the face of the package, of which all others stand above."""
    depth = len(file.relative_to(PACKAGE).parts)
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level == depth and node.module is None:
            yield from (alias.name for alias in node.names)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            names = [getattr(node, "module", None) or "", *(alias.name for alias in node.names)]
            assert "quadcore" not in names, file


def test_modules_import_nothing_but_the_core_from_the_face():
    """import-linter takes these imports for imports of the face, and does not check them."""
    packages = {path.name for path in PACKAGE.iterdir() if path.is_dir()}
    copied = {PACKAGE / "examples", PACKAGE / "notebooks"}  # for users, who import the face
    files = [file for file in PACKAGE.rglob("*.py") if not copied & {*file.parents}]
    files.remove(PACKAGE / "__init__.py")
    assert len(files) > 100
    names = {name for file in files for name in imports_of(file)}
    assert names - packages == {"_core", "__version__"}


def test_a_library_that_is_missing_is_named_with_its_package(tmp_path):
    """As the loader says it, in a package that has nothing but the beginning."""
    package = tmp_path / "quadcore"
    (package / "support").mkdir(parents=True)
    (package / "__init__.py").write_text("from .support import core_library")
    shutil.copy(core_library.__file__, str(package / "support" / "core_library.py"))
    loading = "cannot open shared object file: No such file or directory"
    packages = {"libode.so.8": "libode8", "libtinyxml2.so.9": "libtinyxml2-9"}
    packages["libyaml-cpp.so.0.7"] = "libyaml-cpp0.7"
    for file, name in packages.items():
        (package / "_core.py").write_text(f"raise ImportError('{file}: {loading}')")
        said = script("import quadcore", cwd=tmp_path).stderr
        assert said.splitlines()[-1] == (
            f"ImportError: quadcore was built with {file}, which is missing. Install it (Debian, "
            f"Ubuntu: apt-get install {name}), or rebuild quadcore."
        )
    (package / "_core.py").write_text("raise ImportError('another')")
    assert script("import quadcore", cwd=tmp_path).stderr.endswith("ImportError: another\n")


def test_a_build_names_the_packages_that_it_lacks(tmp_path):
    root = Path(__file__).parents[2]
    done = subprocess.run(
        ["cmake", "-S", str(root), "-B", str(tmp_path), "-DQUADCORE_WITH_ROS=OFF"],
        env={**os.environ, "PKG_CONFIG_LIBDIR": str(tmp_path)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode != 0
    assert "apt-get install libode-dev libccd-dev libtinyxml2-dev libyaml-cpp-dev\n" in done.stderr
