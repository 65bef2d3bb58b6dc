"""Pages that commands write: readable on a laptop and on a telephone, in light and in dark."""

from __future__ import annotations

from html import escape
from pathlib import Path

import pytest
from browser import assert_it_plays, audit_pages, what_sticks_out

import quadcore as qc
from quadcore.cli import main

WIDTHS = (1280, 390)  # px; narrowing shows what keeps its width
FAST = ("--engine", "eigen", "--quiet")
NAME = "</script><img src=x onerror=faults.push('ran')>&\"'"
"""Name of the vehicle."""
FILE = "<img src=x onerror=faults.push(1)>&'\".urdf"
SWEEP = """controller: geometric
reference: circle
engine: eigen
vary: {drone_plugin.rotorThrustCoeff: uniform:1.1e-5:1.2e-5, controller.delay: [0, 0.004]}
samples: 2
duration: 0.5
"""
SPEEDS = "t,w1,w2,w3,w4\n0,476,-476,476,-476\n"
EVALUATION = (
    "evaluate", "--controller", "pd,geometric,indi", "--reference", "circle", "--scenario",
    "gusty", "--duration", "15", "--quiet",
)  # fmt: skip
"""The first command of README."""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """A page of every command that writes one; names of vehicles, files and flights are hostile."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "speeds.csv").write_text(SPEEDS)
    (folder / "sweep.yaml").write_text(SWEEP)
    text = qc.read_model("quadrotor").document.text
    model = folder / FILE
    model.write_text(text.replace('name="quadrotor"', f'name="{escape(NAME)}"', 1))
    vehicle = qc.read_model(model)
    assert vehicle.name == NAME
    speeds = ("--commands", f"{folder}/speeds.csv", "--duration", "2")
    kp, drag = "motorpid_plugin.kp=0.0005,0.001", "drone_plugin.translationalDragCoeff=0,0.01"
    controllers = ("--controller", "geometric,indi", "--reference", "circle,hover", "--seeds", "2")
    log, flown = f"{folder}/log.csv", f"{folder}/flown.csv"
    thrust = "drone_plugin.rotorThrustCoeff"
    guided = ("--controller", "geometric", "--reference", "eight", "--log-every", "10")
    main(["run", "crazyflie", *FAST, *guided, "--duration", "6", "--log", flown])
    main(["run", str(model), *FAST, *speeds, "--log-every", "10", "--log", log])
    for words in (
        ("run", str(model), *FAST, *speeds),
        ("play", log, "--names", NAME, "-o", f"{folder}/play/report.html", "--model", str(model)),
        ("compare", str(model), "--vary", kp, "--vary", drag, *FAST, *speeds),
        ("evaluate", *controllers, *FAST, "--duration", "0.5", "--model", str(model)),
        ("sweep", f"{folder}/sweep.yaml", "--quiet", "--model", str(model)),
        ("validate", str(model), "--duration", "0.2", "--drag", "none", "--quiet"),
        (
            "tune",
            "pd",
            str(model),
            "--only",
            "kp_xy",
            "--duration",
            "1",
            "--budget",
            "2",
            "--quiet",
        ),
        ("fit", str(model), *FAST, "--log", log, "--free", thrust, *speeds[:2]),
        ("predict", "crazyflie", "--log", flown, "--quiet"),
    ):
        out = () if words[0] == "play" else ("--out", f"{folder}/{words[0]}")
        (folder / "play").mkdir(exist_ok=True)
        assert main([*words, *out]) == 0, words[0]
    return {page.parent.name: page for page in sorted(folder.glob("*/report.html"))}


@pytest.fixture(scope="module", params=["light", "dark"])
def audited(request, pages, tmp_path_factory):
    """What is wrong with each page, by command."""
    folder = tmp_path_factory.mktemp(request.param)
    found = audit_pages(pages.values(), folder, request.param == "dark")
    return {name: found[page] for name, page in pages.items()}


def test_nothing_is_cut_on_a_laptop_and_on_a_telephone(pages, tmp_path):
    commands = "run play compare evaluate sweep validate tune fit predict"
    assert set(pages) == set(commands.split())
    found = what_sticks_out(list(pages.values()), WIDTHS, tmp_path, once=True)
    assert [(*key, *out) for key, out in found.items() if out] == []


def test_a_page_of_flights_plays_to_the_end(pages, tmp_path):
    assert_it_plays(pages["play"], WIDTHS, tmp_path)


def test_axe_finds_nothing_serious_on_any_page(audited):
    assert {name: each["violations"] for name, each in audited.items() if each["violations"]} == {}


def test_no_page_requests_anything_or_writes_to_the_console(audited):
    for name, each in audited.items():
        assert (name, each["requests"], each["faults"]) == (name, [], [])


def test_hostile_names_are_shown_as_text(audited):
    for name, each in audited.items():
        assert each["images"] == 0, name
        if name != "predict":  # flies a built-in vehicle
            shown = FILE if name in ("compare", "evaluate", "sweep", "tune", "validate") else NAME
            assert shown in each["text"], name


def test_every_page_has_verdict_conditions_command_version_and_contents(pages):
    for name, page in pages.items():
        text = page.read_text(encoding="utf-8")
        if name != "play":
            assert 'class="verdict"' in text and 'class="conditions"' in text
            assert f"<code>quadcore {name} " in text
            assert f"quadcore {qc.__version__}, " in text and '<nav aria-label="contents">' in text
        assert text.count('class="quadcore-player"') >= 1
        assert Path(page).stat().st_size < 2e6


def test_the_page_of_the_first_command_of_readme_is_small(tmp_path):
    readme = (Path(__file__).resolve().parents[2] / "README.md").read_text()
    assert " ".join(EVALUATION[:7]) in readme
    assert main([*EVALUATION, "--out", str(tmp_path)]) == 0
    assert (tmp_path / "report.html").stat().st_size < 2e6
