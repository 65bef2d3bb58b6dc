"""No page that a command writes is cut, and flights play: on a laptop and on a telephone."""

from __future__ import annotations

import pytest
from browser import assert_it_plays, what_sticks_out

from quadcore.cli import main

WIDTHS = (390, 1280)  # px
FAST = ("--engine", "eigen", "--quiet")
SWEEP = """controller: geometric
reference: circle
engine: eigen
vary: {drone_plugin.rotorThrustCoeff: uniform:1.1e-5:1.2e-5, controller.delay: [0, 0.004]}
samples: 2
duration: 0.5
"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Of every command that writes one."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "speeds.csv").write_text("t,w1,w2,w3,w4\n0,476,-476,476,-476\n")
    (folder / "sweep.yaml").write_text(SWEEP)
    speeds = ("--commands", f"{folder}/speeds.csv", "--duration", "2")
    kp, drag = "motorpid_plugin.kp=0.0005,0.001", "drone_plugin.translationalDragCoeff=0,0.01"
    controllers = ("--controller", "geometric,indi", "--reference", "circle,hover", "--seeds", "2")
    log = f"{folder}/log.csv"
    for words in (
        ("run", "quadrotor", *FAST, *speeds, "--log", log),
        ("play", log, "-o", f"{folder}/play/report.html", "--model", "quadrotor"),
        ("compare", "quadrotor", "--vary", kp, "--vary", drag, *FAST, *speeds),
        ("evaluate", *controllers, *FAST, "--duration", "0.5"),
        ("sweep", f"{folder}/sweep.yaml", "--quiet"),
        ("validate", "--duration", "0.2", "--no-plots", "--quiet"),
    ):
        out = () if words[0] in ("run", "play") else ("--out", f"{folder}/{words[0]}")
        (folder / words[0]).mkdir(exist_ok=True)
        assert main([*words, *out]) == 0
    return sorted(folder.glob("*/report.html"))


def test_nothing_is_cut_on_a_laptop_and_on_a_telephone(pages, tmp_path):
    names = {page.parent.name for page in pages}
    assert names == {"play", "compare", "evaluate", "sweep", "validate"}
    found = what_sticks_out(pages, WIDTHS, tmp_path)
    assert [(*key, *out) for key, out in found.items() if out] == []


def test_a_page_of_flights_plays_to_the_end(pages, tmp_path):
    (page,) = (page for page in pages if page.parent.name == "play")
    assert_it_plays(page, WIDTHS, tmp_path)
