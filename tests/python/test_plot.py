"""Pictures of logs that there are, and of what a flight's numbers are worth."""

from __future__ import annotations

import threading
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import quadcore as qc
from quadcore.cli import main
from quadcore.report import log_plots, plots
from quadcore.report.autopilot_plot import draw_autopilot, has_autopilot
from quadcore.report.drawing import Drawing
from quadcore.studies.compare import plots as overlaid

ONE = {f"{name}.png" for name in ("position", "attitude", "rates", "rotors", "path")}


@pytest.fixture(autouse=True)
def logs(tmp_path, monkeypatch):
    """Two logs, of a fall and of a climb."""
    monkeypatch.chdir(tmp_path)
    for name, speed in (("fall", 0), ("climb", 500)):
        sim = qc.Simulation("quadrotor", engine="eigen")
        sim.command(speed * np.sign(sim.hover_speed))
        sim.run(0.2).to_csv(f"{name}.csv")


def pictures(folder):
    return {path.name for path in Path(folder).iterdir()}


def test_one_log_gives_the_pictures_of_its_flight():
    assert main(["plot", "fall.csv", "--out", "a"]) == 0
    log = qc.Log.of_file("fall.csv")
    log.title = "fall"
    log.plot("b")
    assert pictures("a") == ONE
    assert all(Path("a", name).read_bytes() == Path("b", name).read_bytes() for name in ONE)


def test_pictures_go_to_a_folder_that_the_help_names(capsys):
    with pytest.raises(SystemExit):
        main(["plot", "--help"])
    assert "(default: out/plot)" in capsys.readouterr().out
    drawn = []
    for log in ("fall.csv", "climb.csv"):  # of which the second overwrites
        assert main(["plot", log]) == 0
        assert capsys.readouterr().out.count("written out/plot/") == len(ONE)
        assert pictures("out/plot") == ONE
        drawn.append({name: Path("out/plot", name).read_bytes() for name in ONE})
    assert all(drawn[0][name] != drawn[1][name] for name in ONE)


def test_several_logs_are_drawn_over_each_other(capsys):
    assert main(["plot", "fall.csv", "climb.csv", "--out", "both"]) == 0
    assert pictures("both") == ONE | {"differences.png"}
    assert capsys.readouterr().out.count("written both/") == 6


def test_what_is_no_log_and_too_few_names_are_refused(capsys):
    Path("none.csv").write_text("a,b\n1,2\n")
    assert main(["plot", "none.csv", "--out", "a"]) == 2
    assert "none.csv" in capsys.readouterr().err
    assert main(["plot", "fall.csv", "climb.csv", "--names", "one", "--out", "a"]) == 2
    assert "--names: 1 name(s) for 2 flight(s)" in capsys.readouterr().err
    assert not Path("a").exists()


def test_rounding_is_drawn_as_a_flat_line():
    table = np.zeros((3, 18))
    table[:, 0], table[:, 7] = range(3), 1
    table[:, 1], table[:, 3] = [0, 1e-14, -1e-14], [10, 9, 7]
    x, _, z = log_plots._draw_position(qc.Log(table, {})).axes
    assert x.get_ylim() == (-1, 1) and list(x.get_yticks()) == [0]
    assert z.get_ylim()[1] - z.get_ylim()[0] < 4


def test_rounding_is_flat_where_flights_are_drawn_over_each_other():
    logs = []
    for spread in (0, 1e-13):
        table = np.zeros((3, 18))
        table[:, 0], table[:, 7] = range(3), 1
        table[:, 1], table[:, 3] = [0, spread, -spread], [10, 9, 7 - 1e3 * spread]
        logs.append(qc.Log(table, {}))
    curves = [overlaid.Curve(name, log) for name, log in zip("ab", logs)]
    figures = overlaid.list_figures(curves, logs[0], "a")
    x, _, z = figures["position"]().axes
    assert list(x.get_yticks()) == [0] and z.get_ylim()[1] - z.get_ylim()[0] < 4
    assert list(figures["differences"]().axes[0].get_yticks()) == [0]


@pytest.mark.parametrize("sizes", [(1e-5, 8.6e-4, 0.03), (0.03, 123.0, 23456.0)])
@pytest.mark.parametrize("from_", [0.0, -10.0, 123.0])
def test_no_label_is_cut_off_or_lies_on_its_neighbour(sizes, from_):
    table = np.zeros((9, 18))
    table[:, 0], table[:, 7] = range(9), 1
    table[:, 1:4] = from_ - np.multiply.outer(np.linspace(0, 1, 9), sizes)
    table[:, 8:11] = table[:, 11:14] = table[:, 1:4]
    log = qc.Log(table, {}, topics={"error": dict(zip("xyz", table[:, 1:4].T))})
    for draw in (
        log_plots._draw_position,
        log_plots._draw_error,
        log_plots._draw_rates,
        log_plots.draw_overview,
    ):
        figure = draw(log)
        renderer = FigureCanvasAgg(figure).get_renderer()
        figure.draw(renderer)
        for axes in figure.axes:
            label = axes.yaxis.label.get_window_extent(renderer)
            ticks = [tick.get_window_extent(renderer) for tick in axes.get_yticklabels()]
            shown = [tick for tick in ticks if axes.bbox.y0 <= tick.y1 and tick.y0 <= axes.bbox.y1]
            assert label.x0 >= 0 and label.x1 <= min(tick.x0 for tick in shown)
            others = [other.bbox for other in figure.axes if other is not axes]
            assert not any(label.overlaps(box) for box in others)


def test_each_slow_rotor_has_a_panel_with_its_speed_times_the_slowdown():
    log = qc.Log.of_file("climb.csv")
    log.per_command = 0.1
    panels = log_plots._draw_rotors(log).axes
    assert [axes.get_ylabel() for axes in panels] == [f"rotor {i} (rad/s)" for i in range(1, 5)]
    (beside,) = panels[1].child_axes
    assert np.allclose(beside._functions[0](np.array([47.1])), 471)
    assert beside.get_ylabel() == r"$\times$ slowdown (rad/s)"


def test_what_an_autopilot_knew_is_drawn_as_errors_and_bands():
    table = np.zeros((5, 18))
    table[:, 0], table[:, 1], table[:, 7] = range(5), [0, 1, 2, 3, 4], 1
    known = {"armed": [np.nan, 1, 1, 0, 0], "mode": [np.nan, 6, 6, 6, 4]}
    known["estimate_x"] = [np.nan, 1.1, 2.2, 3.0, 3.9]
    still = ("estimate_y", "estimate_z", "estimate_roll", "estimate_pitch")
    known.update({name: [np.nan, 0, 0, 0, 0] for name in still})
    known["estimate_yaw"] = [np.nan, 0, 0, 0, np.radians(350)]
    topics = {"controller": {name: np.array(values, float) for name, values in known.items()}}
    log = qc.Log(table, {}, topics=topics)
    assert has_autopilot(log) and not has_autopilot(qc.Log(table, {}))
    position, angles, bands = draw_autopilot(log, "").axes
    assert np.allclose(position.lines[0].get_ydata()[1:], [0.1, 0.2, 0, -0.1])
    assert np.allclose(angles.lines[2].get_ydata()[1:], [0, 0, 0, -10])
    assert [text.get_text().strip() for text in bands.texts] == [
        "armed",
        "not armed",
        "mode 6",
        "mode 4",
    ]


def test_flights_over_each_other_tell_commands_and_what_they_are_compared_with(monkeypatch):
    drawn = {}
    none = Drawing("", "<svg></svg>", {})
    monkeypatch.setattr(
        plots, "finish", lambda figure, _: drawn.setdefault(len(drawn), figure) and none
    )
    flight = ["compare", "quadrotor", "--duration", "0.01", "--commands", "c.csv", "--out", "o"]
    flight += ["--jobs", "1"]
    Path("c.csv").write_text("t,w1,w2,w3,w4\n0,471,-471,471,-471\n")
    vary = ["--vary", "motorpid_plugin.kp=0.0005,0.001", "--against", "2", "--quiet"]
    assert main([*flight, *vary]) == 0
    *_, rotors, differences = drawn.values()
    (beside,) = rotors.axes[0].child_axes
    assert np.allclose(beside._functions[0](np.array([47.1])), 471)
    assert differences._suptitle.get_text() == "Difference from kp 0.001"


def test_a_run_that_can_hardly_be_meant_is_said_and_flown(capsys):
    run = ["run", "quadrotor", "--duration", "0.01", "--quiet"]
    Path("one_way.csv").write_text("t,w1,w2,w3,w4\n0,471,471,471,471\n")
    Path("hover.csv").write_text("t,w1,w2,w3,w4\n0,471,-471,471,-471\n")
    for more, expected in (
        ([], "warning: no rotor command is given"),
        (["--commands", "one_way.csv"], "the vehicle hovers at 471, -471, 471, -471 rad/s"),
        (["--commands", "hover.csv"], ""),
        (["--controller", "geometric"], ""),
    ):
        assert main([*run, *more]) == 0
        err = capsys.readouterr().err
        assert expected in err and bool(expected) == bool(err)
    # Whose plugins know in which sense each turns.
    assert main(["run", "hummingbird", *run[2:], "--commands", "one_way.csv"]) == 0
    assert capsys.readouterr().err == ""


def test_the_summary_has_the_maximum_rotor_speed_as_it_was_commanded(capsys):
    Path("hover.csv").write_text("t,w1,w2,w3,w4\n0,471,-471,471,-471\n")
    run = ["run", "quadrotor", "--duration", "2", "--commands", "hover.csv"]
    for more, expected in ([], "47.1"), (["--xacro", "sim_slow:=1"], "471.0"):
        assert main([*run, *more]) == 0
        (line,) = (row for row in capsys.readouterr().out.splitlines() if "max rotor" in row)
        assert expected in line
        assert ("(commanded 471.0 rad/s)" in line) == (not more)


def test_threads_draw_the_same_and_leave_settings_alone(tmp_path):
    log = qc.Log.of_file("climb.csv")
    before = dict(matplotlib.rcParams)

    threads = [threading.Thread(target=log.plot, args=(tmp_path / f"{i}",)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert dict(matplotlib.rcParams) == before
    for file in (tmp_path / "0").iterdir():
        assert {(tmp_path / f"{i}" / file.name).read_bytes() for i in range(3)} == {
            file.read_bytes()
        }
