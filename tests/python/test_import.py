"""What `import quadcore` brings in, and what it leaves until somebody asks."""

from processes import script

import quadcore as qc

# Each takes longer to import than quadcore itself, or brings in what does.
SLOW = [
    *["matplotlib", "mpl_toolkits", "scipy", "jinja2", "markupsafe", "rich", "xacro", "rospkg"],
    *["yaml", "cma", "gymnasium"],
    *["xml.dom", "xml.sax", "urllib.request", "http", "email", "ssl", "multiprocessing", "json"],
]


def test_importing_quadcore_brings_in_numpy_and_nothing_slow():
    asked = f"print(*(name for name in {SLOW} if name in set(sys.modules) - before))"
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


def test_every_name_is_there_when_it_is_asked_for():
    text = "import quadcore; print(*(name for name in dir(quadcore) if hasattr(quadcore, name)))"
    assert set(qc.__all__) <= set(script(text).stdout.split())
    assert "has no attribute 'evaluat'" in script("import quadcore; quadcore.evaluat").stderr
