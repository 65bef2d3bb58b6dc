"""What `quadcore validate` writes, draws, prints and refuses."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
from pathlib import Path

import pytest
from flights import ENGINES
from matplotlib.backends.backend_agg import FigureCanvasAgg
from test_docs import COMMANDS

import quadcore as qc
from quadcore.cli import main
from quadcore.thesis.validation import Experiment, cause_plots, run_study
from quadcore.thesis.validation import figures as pictures_of_study
from quadcore.thesis.validation.figures import list_figures
from quadcore.thesis.validation.output import size
from quadcore.thesis.validation.thesis_figures import KINDS, SIM_SLOW, thesis_figures

ROOT = Path(__file__).resolve().parents[2]
HEXAROTOR = ROOT / "tests/data/gazebo11/cases/B1_hexa_hover/model.urdf"
FAST = ["--drag", "none", "--sim-slow", "1", "--engine", "eigen", "--duration", "0.5", "--quiet"]


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """Folder that the command has written."""
    folder = tmp_path_factory.mktemp("validate") / "deep" / "out"
    assert main(["validate", *FAST, "--jobs", "1", "--out", str(folder)]) == 0
    return folder


def test_the_command_writes_tables_figures_and_one_page(out):
    page = (out / "report.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]{1,40})', page)
    assert all(source.startswith("#") for source in sources)
    assert page.count('<figure class="plot"><svg ') == 8
    for kind in ("position", "error", "attitude", "velocity", "rates", "chain"):
        assert (out / f"{kind}_none.png").read_bytes().startswith(b"\x89PNG")

    (row,) = csv.DictReader((out / "errors.csv").open())
    assert (row["engine"], row["sim_slow"], row["drag"], row["failure"]) == (
        "eigen", "1.0", "none", ""
    )  # fmt: skip
    (found,) = json.loads((out / "validation.json").read_text())["errors"]
    for state in ("x", "psi", "vz", "thetadot", "distance"):
        for kind, name in (("max", "max"), ("rms", "rms")):
            assert float(row[f"{kind}_{state}"]) == found[name][state]
    chain = list(csv.DictReader((out / "chains.csv").open()))
    total = sum(float(link["share"]) for link in chain[:-1])
    assert total == pytest.approx(float(chain[-1]["share"]), abs=1e-15)

    again = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    assert again.run(0.5, out / "commands.csv").time[-1] == 0.5


def test_the_same_command_writes_the_same_bytes_and_prints_what_it_found(out, tmp_path, capsys):
    assert main(["validate", *FAST[:-1], "--jobs", "3", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr()
    assert re.search(r"eigen +1 +[\d.e-]+\n", printed.out)
    assert "cause  " in printed.out
    assert f"written {tmp_path / 'report.html'}" in printed.out
    assert printed.err == ""
    names = sorted(str(path.relative_to(out)) for path in out.rglob("*") if path.is_file())
    assert len([name for name in names if "/" not in name]) == 14
    assert {"logs/1.csv", "models/1.urdf"} <= set(names)
    for name in names:
        one, other = ((folder / name).read_bytes() for folder in (out, tmp_path))
        if name == "report.html":  # its head has the command line and the date
            one, other = (page.partition(b"</header>")[2] for page in (one, other))
        if name == "run.json":  # so has its first part
            one, other = (text.partition(b'"worlds"')[2] for text in (one, other))
        assert one == other != b"", name


def test_the_page_sets_the_formula_of_the_damper_beside_no_engine_but_in_a_column_of_its_own(out):
    page = (out / "report.html").read_text()
    (entry,) = json.loads((out / "validation.json").read_text())["damping"]
    assert list(entry["measured"]) == ["eigen"] and abs(entry["measured"]["eigen"]) < 1e-9
    (row,) = re.findall(r"<tr>.*>" + re.escape(size(entry["formula"])) + "<.*</tr>", page)
    assert re.findall(r">([^<]+)</td>", row)[:2] == ["1", size(entry["formula"])]


def test_the_pictures_carry_the_numbers_of_the_thesis_figures():
    """As its captions have them: five for each drag, and five for all at 1, 8 and 10."""
    kinds = ("position", "error", "attitude", "velocity", "rates")
    assert tuple(KINDS) == kinds
    numbers = [
        thesis_figures(drag, kind, SIM_SLOW)
        for drag in ("profile", "parasitic", "translational", "induced")
        for kind in kinds
    ]
    assert numbers == [f"6.{i}" for i in range(1, 21)]
    together = [thesis_figures("all", kind, SIM_SLOW) for kind in kinds]
    assert together[0] == "6.21, 6.26, 6.31" and together[4] == "6.25, 6.30, 6.35"
    assert thesis_figures("all", "error", [18, 8]) == "6.27"
    assert thesis_figures("none", "position", [1]) == thesis_figures("flapping", "rates", [1]) == ""


def test_the_slow_downs_of_text_and_captions_are_flown_unless_others_are_named():
    assert SIM_SLOW == (1, 8, 10, 18)
    (option,) = (a for a in COMMANDS["validate"]._actions if a.dest == "sim_slow")
    assert option.default is None  # `run_study` decides
    assert ",".join(f"{n:g}" for n in SIM_SLOW) in option.help


@pytest.fixture(scope="module")
def short():
    """Study of a flight so short that most differences are rounding."""
    return run_study(Experiment.of(duration=0.5), ENGINES, [1, 8], ["none", "all"], 1)


def test_no_text_of_a_picture_is_cut_off(short, study, monkeypatch):
    figures = []
    for module in (pictures_of_study, cause_plots):
        monkeypatch.setattr(module, "finish", figures.append)
    for draw, what in [*list_figures(short).values(), *list_figures(study).values()]:
        draw(*what)
    assert len(figures) == 2 * 14
    for figure in figures:
        box = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())  # inch
        width, height = figure.get_size_inches()
        title = figure._suptitle.get_text()
        assert min(box.x0, box.y0, width - box.x1, height - box.y1) >= 0, title


def test_bars_are_labelled_as_the_tables_have_it_and_rounding_is_no_bar(short, monkeypatch):
    figures = []
    monkeypatch.setattr(cause_plots, "finish", figures.append)
    chains = [chain for chain in short.chains if chain.drag == "none"]
    cause_plots.draw_chains(chains)
    (axes,) = figures[0].axes
    links = {(link.begin, link.end): link.max for chain in chains for link in chain.links}
    assert sorted(text.get_text() for text in axes.texts) == sorted(
        f" {size(largest)} m" for largest in links.values()
    )
    widths = [bar.get_width() for bar in axes.patches]
    assert sum(width > 0 for width in widths) == sum(size > 1e-9 for size in links.values()) == 2


def test_rounding_is_drawn_as_a_flat_line(short, monkeypatch):
    figures = []
    monkeypatch.setattr(pictures_of_study, "finish", figures.append)
    for kind, least in (("error", 1e-8), ("position", 1e-3), ("rates", 1e-3)):
        pictures_of_study.draw(pictures_of_study.collect_curves(short, "none"), kind)
        for axes in figures[-1].axes:
            low, high = axes.get_ylim()
            assert high - low >= 0.999 * least


def test_a_process_killed_while_it_draws_costs_its_picture_alone(tmp_path, monkeypatch, capsys):
    whole = pictures_of_study.draw

    def draw(what, kind):
        if kind == "attitude":
            os.kill(os.getpid(), signal.SIGKILL)
        return whole(what, kind)

    monkeypatch.setattr(pictures_of_study, "draw", draw)
    (tmp_path / "velocity_induced.png").write_bytes(b"of another study")
    assert main(["validate", *FAST, "--jobs", "2", "--out", str(tmp_path)]) == 3
    says = "1 of 8 figures failed. The first one: attitude_none: its process was ended by SIGKILL"
    assert capsys.readouterr().err == f"error: {says}\n"
    (row,) = csv.DictReader((tmp_path / "errors.csv").open())
    assert row["failure"] == "" and float(row["max_distance"]) >= 0
    drawn = sorted(path.stem for path in tmp_path.glob("*.png"))
    assert len(drawn) == 7 and "attitude_none" not in drawn and "velocity_induced" not in drawn
    page = (tmp_path / "report.html").read_text()
    assert page.count('<figure class="plot"><svg ') == 7
    assert len(list(tmp_path.iterdir())) == 7 + 8  # figures; tables, page, run.json, folders


def test_flights_that_fail_are_rows_with_a_reason(tmp_path, capsys):
    """At steps of 7 ms a rotor turns more than half a turn, unless it is slowed. eigen flies on."""
    arguments = ["--dt", "0.007", "--sim-slow", "1,8", "--drag", "none", "--duration", "0.7"]
    arguments += ["--engine", "ode,eigen", "--no-plots", "--out", str(tmp_path)]
    assert main(["validate", *arguments]) == 3
    printed = capsys.readouterr()
    warning, error = printed.err.splitlines()
    assert "more than half a turn per step, so its" in warning
    assert error.startswith("error: 1 of 4 flights failed. The first one (ode, sim_slow 1, ")
    assert "more than half a turn per step. Use a smaller step" in error
    assert re.search(r"ode +1 +failed\node +8 +[\d.e-]+\n", printed.out)
    rows = list(csv.DictReader((tmp_path / "errors.csv").open()))
    assert [bool(row["failure"]) for row in rows] == [True, False, False, False]
    assert "more than half a turn" in (tmp_path / "report.html").read_text()
    assert "more than half a turn" in (tmp_path / "chains.csv").read_text()


def test_warnings_of_the_model_are_passed_on(capsys):
    assert main(["validate", *FAST, "--set", "motorpid_plugin.ki=1"]) == 0
    assert capsys.readouterr().err.startswith("warning: ")


def test_other_commands_motors_and_models_can_be_flown(tmp_path):
    commands = tmp_path / "hover.csv"
    commands.write_text("t,w1,w2,w3,w4,w5,w6\n0,530,-530,530,-530,530,-530\n")
    arguments = [str(HEXAROTOR), "--commands", str(commands), "--motors", "ideal", "--no-plots"]
    assert main(["validate", *arguments, *FAST, "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "validation.json").read_text())
    assert found["commands"] == [[0, 530, -530, 530, -530, 530, -530]]
    assert found["experiment"]["motor_lag"] is False
    assert 0 < found["errors"][0]["max"]["distance"] < 0.1


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--engine", "eigen,bullet"], "'bullet' does not exist. Choose from gazebo11, ode, eigen"),
        (["--sim-slow", "1,0"], "0 is not greater than 0"),
        (["--sim-slow", "1,x"], "'x' is not a finite number"),
        (["--drag", "none,lift"], "drag 'lift' does not act on this vehicle (none, profile, "),
        (["--set", "drone_plugin.sim_slow=2"], "drone_plugin.sim_slow: every flight has its own"),
        (["--set", "motorpid_plugin.kd=1e-9"], "the mathematical model has proportional motors"),
        (["--commands", "late.csv"], "the first row is for t = 1. Begin at t = 0"),
        (["--commands", "none.csv"], "none.csv: cannot be read"),
        (["--duration", "1", "--log-every", "1001"], "the flight has 1000 steps"),
        (["--motors", "electric"], "--motors: invalid choice: 'electric'"),
        (["--out", "late.csv"], "late.csv: cannot be made"),
        (["nowhere.urdf"], "nowhere.urdf: neither a file nor a built-in model"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(arguments, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("late.csv").write_text("t,w1,w2,w3,w4\n1,471,-471,471,-471\n")
    assert main(["validate", *arguments, "--quiet"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ") and says in error and error.count("\n") == 1
