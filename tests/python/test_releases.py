"""What users install, and the way there: the package's page, the workflows, scripts/release."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pages
import pytest

import quadcore as qc

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "python" / "README.md"
ZIZMOR = shutil.which("zizmor", path=str(Path(sys.executable).parent))
ADDRESS = "https://example.org/quadcore"
NAMED = "CMakeLists.txt pyproject.toml package.xml python/quadcore/__init__.py CITATION.cff"


def test_the_page_of_the_package_stands_by_itself():
    assert f'readme = "{PAGE.relative_to(ROOT)}"' in (ROOT / "pyproject.toml").read_text()
    assert not re.findall(r"\]\((?!https://)", PAGE.read_text())  # PyPI has no file beside it
    assert not re.findall(r"^.{111,}$", PAGE.read_text(), re.MULTILINE)


def test_what_that_page_says_to_type_runs(tmp_path):
    assert "arning" not in pages.run(PAGE, tmp_path)
    log = qc.Log.of_file(tmp_path / "hover.csv")
    assert log.position[-1] == pytest.approx([0, 0, 10], abs=1e-3)
    assert (tmp_path / "hover.html").exists()


@pytest.mark.skipif(not ZIZMOR, reason="zizmor is for Python 3.11 and later")
def test_the_workflows_are_valid_and_hand_out_no_rights():
    done = subprocess.run(
        [ZIZMOR, "--offline", "--strict-collection", "--quiet", ".github"],
        cwd=str(ROOT), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def ready(tmp_path):
    """A repository whose version 1.2.3 can be released."""
    folder = tmp_path / "repository"
    version = qc.__version__
    for name in [*NAMED.split(), "README.md", "CHANGELOG.md", "scripts/release"]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(str(ROOT / name), str(folder / name))
    for name in [*NAMED.split(), "README.md"]:
        edit(folder / name, version, "1.2.3")
    edit(folder / "CHANGELOG.md", "## [Unreleased]", "## [Unreleased]\n\n## [1.2.3] - 2031-12-24")
    readme = folder / "README.md"
    readme.write_text(re.sub(r"git clone \S+", f"git clone {ADDRESS}", readme.read_text(), count=1))
    if "[project.urls]" not in (folder / "pyproject.toml").read_text():
        edit(folder / "pyproject.toml", "[project.scripts]", "[project.urls]\n\n[project.scripts]")
    git(folder, "init", "-q")
    commit(folder)
    return folder


def edit(file, old, new):
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def git(folder, *arguments):
    subprocess.run(["git", *arguments], cwd=str(folder), check=True, stdout=subprocess.PIPE)


def commit(folder):
    git(folder, "add", "-A")
    who = ["-c", "user.name=somebody", "-c", "user.email=somebody@example.org"]
    git(folder, *who, "commit", "-q", "--allow-empty", "-m", "change")


def run_release(folder, version="1.2.3"):
    return subprocess.run(
        ["scripts/release", version], cwd=str(folder), capture_output=True, text=True, check=False
    )


needs_git = pytest.mark.skipif(not shutil.which("git"), reason="there is no git")


@needs_git
@pytest.mark.parametrize("version", ["1.2.3", "v1.2.3"])
def test_what_is_ready_may_be_released_and_tagged(ready, version):
    done = run_release(ready, version)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("quadcore: 1.2.3 is ready: git tag v1.2.3")
    git(ready, "tag", "v1.2.3")
    assert run_release(ready, version).returncode == 0


@needs_git
@pytest.mark.parametrize(
    ("name", "old", "new", "complaint"),
    [
        *((name, "1.2.3", "1.2.2", f"{name}: does not have") for name in NAMED.split()),
        ("README.md", "{1.2.3}", "{1.2}", "README.md: does not have"),
        ("CHANGELOG.md", "2031-12-24", "soon", "CHANGELOG.md: has no heading '## [1.2.3] - YEAR"),
        ("README.md", ADDRESS, "REPOSITORY", "README.md: 'git clone REPO"),
        ("pyproject.toml", "[project.urls]\n", "", "pyproject.toml: has no [project.urls]"),
    ],
)
def test_an_unfinished_release_is_refused(ready, name, old, new, complaint):
    edit(ready / name, old, new)
    assert "there are uncommitted changes" in run_release(ready).stderr
    commit(ready)
    done = run_release(ready)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"quadcore: {complaint}") and done.stderr.count("\n") == 1


@needs_git
def test_a_tag_is_not_moved(ready):
    git(ready, "tag", "v1.2.3")
    commit(ready)
    done = run_release(ready)
    assert (done.returncode, done.stderr) == (1, "quadcore: tag v1.2.3 is another commit's\n")
