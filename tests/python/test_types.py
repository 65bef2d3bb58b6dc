"""Type checkers find mistakes in scripts that use quadcore."""

from __future__ import annotations

import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import get_args, get_type_hints

import pytest

import quadcore as qc
from quadcore import _core
from quadcore.control import keywords
from quadcore.simulation import engines, flight_plan

SCRIPTS = Path(__file__).parents[1] / "data" / "types"
PACKAGE = Path(qc.__file__).parent


def run_checker(module, *arguments, **environment):
    pytest.importorskip(module)
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr
    return done.stdout


def run_mypy(folder):
    """Return file name, line and message of each error."""
    is_installed = PACKAGE.parent.name in ("site-packages", "dist-packages")
    printed = run_checker(
        *["mypy", "--strict", "--config-file=", "--follow-imports=silent"],
        "--cache-dir=/dev/null",
        *map(str, SCRIPTS.glob("*.py")),
        MYPYPATH="" if is_installed else str(PACKAGE.parent),
    )
    found = re.findall(r"^(.*\.py):(\d+): error: (.*)$", printed, re.MULTILINE)
    return [(Path(file).name, int(line), message) for file, line, message in found]


def run_pyright(folder):
    """Return file name, line and message of each error."""
    setting = {"typeCheckingMode": "strict", "extraPaths": [str(PACKAGE.parent)]}
    shutil.copytree(SCRIPTS, folder / "scripts")  # pyright looks at no file outside the project
    (folder / "pyrightconfig.json").write_text(json.dumps(setting))
    printed = run_checker(
        *["pyright", "--project", str(folder), "--pythonpath", sys.executable, "--outputjson"],
        PYRIGHT_PYTHON_GLOBAL_NODE="off",
    )
    return [
        (Path(each["file"]).name, each["range"]["start"]["line"] + 1, each["message"])
        for each in json.loads(printed)["generalDiagnostics"]
        if each["severity"] == "error"
    ]


@pytest.fixture(scope="module", params=[run_mypy, run_pyright])
def errors(request, tmp_path_factory):
    return request.param(tmp_path_factory.mktemp("checked"))


def test_a_correct_script_has_no_type_error(errors):
    assert [error for error in errors if error[0] == "correct.py"] == []


def test_each_of_eleven_mistakes_is_a_type_error(errors):
    lines = enumerate((SCRIPTS / "mistakes.py").read_text().splitlines(), 1)
    mistakes = {number for number, line in lines if re.search(r"  # \d+$", line)}
    assert len(mistakes) == 11
    assert {line for file, line, _ in errors if file == "mistakes.py"} == mistakes


def test_literal_names_are_those_of_the_core():
    assert get_args(engines.EngineName) == tuple(name for name, _ in _core.engines())
    known = [name for part in get_args(engines.AnyEngineName) for name in get_args(part)]
    assert known == [name for name, _ in engines.list_engines()]
    assert get_args(qc.ControllerName) == qc.controllers.NAMES
    assert get_args(qc.ReferenceName) == qc.references.NAMES


def types_of(table):
    return {spec.name: bool if spec.is_flag else float for spec in table}


@pytest.mark.parametrize(
    ("module", "rows", "shared"),
    [
        (qc.controllers, _core.controllers(), get_type_hints(keywords.Setup)),
        (qc.references, _core.references(), {}),
    ],
)
def test_typed_keywords_are_those_of_the_core(module, rows, shared):
    typed = re.findall(r"def (\w+)\(.*\*\*\w+: Unpack\[(\w+)\]", inspect.getsource(module))
    found = {name: get_type_hints(getattr(keywords, kind)) for name, kind in typed}
    assert found == {name: {**types_of(table), **shared} for name, _, table, *_ in rows}
    assert set(found) < set(module.__all__)


def test_typed_keywords_of_the_inner_loop_and_of_a_plan():
    assert get_type_hints(keywords.InnerLoopGains) == types_of(_core.inner_loop())
    assert set(flight_plan._Others.__annotations__) < set(qc.FlightPlan.__annotations__)


def test_help_begins_with_typed_signatures():
    first = inspect.getdoc(qc.Simulation.command).splitlines()[0]
    assert first.endswith("speeds: numpy.typing.ArrayLike) -> None")
    assert "kp_xy: float = " in str(inspect.signature(qc.controllers.geometric))
    assert "radius: float = " in str(inspect.signature(qc.references.spiral))
