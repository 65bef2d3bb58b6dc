"""Drawings: formats of files, SVG elements of pages, and what a page saves."""

from __future__ import annotations

import re
from pathlib import Path
from xml.dom import minidom

import numpy as np
import pytest
from browser import run_script

import quadcore as qc
from quadcore.cli import main
from quadcore.report.colours import PALETTE
from quadcore.report.drawing import use_formats
from quadcore.report.page import render
from quadcore.report.plots import finish, panels

HOSTILE = "</text><script>faults.push('ran')</script>&\"'"
FLIGHT = ("--engine", "eigen", "--duration", "0.2", "--quiet")


@pytest.fixture(autouse=True)
def in_folder(tmp_path, monkeypatch):
    """Run every test in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def figure(label="a curve"):
    drawn, grid = panels(f"Title of {label}", 1)
    grid[0, 0].plot([0, 1, 2], [0, 1, 4], color=PALETTE[0], label=label)
    grid[0, 0].legend()
    return drawn


def parsed(text):
    return minidom.parseString(text)


def ids_of(text):
    return re.findall(r' id="([^"]*)"', text)


def test_equal_figures_have_equal_files_and_an_element_that_names_nothing_twice():
    with use_formats(["png", "svg", "pdf"]):
        one, other = finish(figure()), finish(figure())
    assert one == other and list(one.files) == ["png", "svg", "pdf"]
    assert one.files["png"].startswith(b"\x89PNG") and one.files["pdf"].startswith(b"%PDF")
    assert one.title == "Title of a curve" and PALETTE[0] in one.svg
    assert parsed(one.files["svg"]).documentElement.tagName == "svg"
    found = ids_of(one.svg)
    assert len(set(found)) == len(found)
    used = set(re.findall(r'(?:url\(#|href="#)([^)"]+)', one.svg))
    assert used == set(found) and used


def test_two_drawings_of_a_page_share_no_name():
    one, other = finish(figure()), finish(figure("another"))
    assert not set(ids_of(one.svg)) & set(ids_of(other.svg))


def test_names_in_a_drawing_stay_text_and_a_page_saves_drawing_and_table(tmp_path):
    drawing = finish(figure(HOSTILE))
    table = {"heads": ["name", "value"], "rows": [[HOSTILE, "1.5"], ["=1+1", "-2"], ["a, b", "3"]]}
    page = render("compare.html", **make_values(drawing, table))
    script = """
    const saved = [];
    URL.createObjectURL = (blob) => { saved.push(blob); return "#"; };
    HTMLAnchorElement.prototype.click = function () { result.name = this.download; };
    document.querySelector(".save-svg").click();
    result.svg_name = result.name;
    document.querySelector(".save-csv").click();
    result.csv_name = result.name;
    result.csv = writeCsv(document.querySelector("table.sortable"));
    result.types = saved.map((blob) => blob.type);
    result.svg = new XMLSerializer().serializeToString(document.querySelector("figure svg"));
    result.scripts = document.querySelectorAll("figure script").length;
    """
    found = run_script(page, script, tmp_path)
    assert found["types"] == ["image/svg+xml", "text/csv"] and found["scripts"] == 0
    assert [found["svg_name"], found["csv_name"]] == ["path.svg", "table_1.csv"]
    parsed(found["svg"])
    lines = found["csv"].splitlines()
    assert lines[0] == "no.,variant,position m" and lines[2] == "2,'=1+1,0.5 0.25"
    assert lines[1] == '1,"' + HOSTILE.replace('"', '""') + '",0.5 0.25'


def make_values(drawing, table):
    """Values of a page of a comparison with three flights."""
    rows = [
        {"number": i, "label": name, "failure": "", "errors": [], "max": {"position": "0.5"},
         "final": {"position": "0.25"}}
        for i, (name, _) in enumerate(table["rows"], start=1)
    ]  # fmt: skip
    return {
        "title": "t", "verdict": "v", "summary": "s", "player": "", "omitted": "", "guided": False,
        "against": "no. 1", "groups": [("", ["position"])], "units": {"position": "m"},
        "rows": rows, "more": 0, "plots": [{"name": "path", "data": drawing}], "flight": {},
        "differences": {}, "first": "a", "axes": [],
    }  # fmt: skip


@pytest.mark.parametrize("kind", ["svg", "pdf"])
def test_commands_write_the_formats_that_are_asked_for(kind):
    guided = ("--controller", "geometric", "--reference", "circle")
    commands = {
        "run": ("run", "quadrotor", *guided),
        "evaluate": ("evaluate", *guided),
    }
    for name, words in commands.items():
        assert main([*words, *FLIGHT, "--format", kind, "--out", name]) == 0
        found = {path.suffix[1:] for path in Path(name).iterdir() if path.suffix in
                 (".png", ".svg", ".pdf")}  # fmt: skip
        assert found == {kind}
        page = Path(name, "report.html").read_text()
        assert ("data:application/pdf" in page) == (kind == "pdf")
    assert main([*commands["evaluate"], *FLIGHT, "--out", "evaluate"]) == 0  # replaces them
    assert {path.suffix for path in Path("evaluate").glob("tracks*")} == {".png"}


def test_a_log_is_drawn_in_formats_from_python():
    log = qc.Simulation("quadrotor", engine="eigen").run(0.1)
    files = log.plot("out", formats=["svg", "pdf"])
    assert {file.suffix for file in files} == {".svg", ".pdf"} and all(map(Path.is_file, files))
    with pytest.raises(qc.InputError, match=r"format 'jpg' does not exist\. Use some of png, svg"):
        log.plot("out", formats=["jpg"])


def test_the_style_sheet_has_the_colours_of_flights_and_styles_plots_of_users():
    from matplotlib import pyplot as plt

    _, grid = panels("ours", 1)
    with plt.style.context(qc.PLOT_STYLE):
        colours = plt.rcParams["axes.prop_cycle"].by_key()["color"]
        _, axes = plt.subplots()
        (curve,) = axes.plot([0, 1])
        assert curve.get_color() == PALETTE[0]
        for side in ("top", "right", "left"):
            assert axes.spines[side].get_visible() == grid[0, 0].spines[side].get_visible()
        assert axes.get_axisbelow() == grid[0, 0].get_axisbelow()
        plt.close("all")
    assert tuple(colours) == PALETTE


def test_formats_in_a_file_of_options_count():
    Path("study.yaml").write_text(
        "controller: geometric\nreference: circle\nduration: 0.2\nformat: [svg]\n"
    )
    assert main(["evaluate", "study.yaml", "--quiet", "--out", "out"]) == 0
    assert Path("out/tracks_1.svg").exists() and not Path("out/tracks_1.png").exists()


def test_numbers_of_a_drawing_are_those_of_the_curve():
    drawn, grid = panels("line", 1)
    time = np.linspace(0, 1, 50)
    grid[0, 0].plot(time, np.sin(20 * time), color="#123456")
    element = finish(drawn).svg
    (path,) = re.findall(r'd="([^"]*)"[^>]*style="[^"]*stroke: #123456', element)
    numbers = np.array(re.findall(r"[\d.]+", path), float).reshape(-1, 2)
    expected = grid[0, 0].transData.transform(np.column_stack([time, np.sin(20 * time)]))
    expected = expected * 72 / drawn.dpi
    expected[:, 1] = 72 * drawn.get_figheight() - expected[:, 1]
    for point in numbers:
        assert np.abs(expected - point).sum(axis=1).min() < 0.2
