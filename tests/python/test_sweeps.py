"""What a sweep flies, and what it tells."""

from __future__ import annotations

import csv
import json
import math
import shlex
from pathlib import Path

import numpy as np
import pytest
from processes import run_command
from sweeps import MASS, ishigami, rows, sweep

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.design import Design

FLY = ["--controller", "geometric", "--reference", "circle", "--xacro", "sim_slow:=1"]
SHORT = [*FLY, "--duration", "0.5", "--no-plots", "--quiet"]


def test_a_row_is_what_the_flight_by_itself_is():
    found = sweep(
        {"drone_plugin.rotorThrustCoeff": [1.1e-5], "frame.mass": [1.05, 1.2]}, samples=None
    )
    circle = qc.references.circle()
    simulation = qc.Simulation(
        engine="eigen",
        xacro_args={"sim_slow": 1},
        parameters={"drone_plugin.rotorThrustCoeff": 1.1e-5, "frame.mass": 1.2},
    )
    simulation.set_state(qc.references.start(simulation, circle))
    log = simulation.run(0.5, controller="geometric", reference=circle, log_every=10)
    away = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
    assert found.columns["max_position"][1] == away.max()
    assert found.columns["failure"].tolist() == ["", ""]


def test_sweeps_evaluations_and_flights_share_measures():
    found = sweep({"controller.delay": [0, 0.004]}, samples=None, seeds=2, engines=["eigen", "ode"])
    evaluated = qc.evaluate(
        "geometric",
        "circle",
        ["eigen", "ode"],
        vary={"controller.delay": [0, 0.004]},
        seeds=2,
        duration=0.5,
        xacro_args={"sim_slow": 1},
    )
    assert found.columns["rms_position"].tolist() == [r["rms_position"] for r in evaluated.table]
    assert found.columns["seed"].tolist() == [0, 1] * 4


def test_commands_fly_open_loop_and_their_motion_is_measured(tmp_path):
    commands = tmp_path / "c.csv"
    commands.write_text("t,w1,w2,w3,w4\n0,480,-480,480,-480\n0.2,500,-480,470,-480\n")
    found = qc.sweep(
        commands=commands,
        vary={"frame.mass": [1, 1.3]},
        xacro_args={"sim_slow": 1},
        duration=0.6,
    )
    log = qc.Simulation(
        engine="eigen", xacro_args={"sim_slow": 1}, parameters={"frame.mass": 1.3}
    ).run(0.6, commands=commands, log_every=10)
    assert found.columns["final_z"][1] == log.position[-1, 2]
    up = qc.Simulation().state.orientation  # level
    assert up[3] == 1 and found.columns["final_tilt"][1] > 0
    z = 1 - 2 * (log.orientation[:, 0] ** 2 + log.orientation[:, 1] ** 2)
    assert found.columns["max_tilt"][1] == pytest.approx(np.arccos(z).max(), rel=1e-6)


def test_rows_that_fly_together_are_what_they_are_alone(tmp_path, monkeypatch):
    """One of them spins up until its flight fails; others land."""
    commands = tmp_path / "c.csv"
    commands.write_text("t,w1,w2,w3,w4\n0.0125,480,-480,480,-480\n0.2,300,-300,300,-301\n")

    def fly():
        return qc.sweep(
            commands=commands,
            vary={"frame.mass": "uniform:0.9:1.3", "motorpid_plugin.kp": [5e-4, 9.0]},
            samples=10,
            xacro_args={"sim_slow": 1},
            world="default",
            spawn=(0, 0, 0.3),
            duration=1.0,
            log_every=7,
            processes=1,
        )

    together = fly()
    monkeypatch.setattr("quadcore.studies.sweep.execution.fly_together", lambda specs: None)
    alone = fly()
    for name, column in together.columns.items():
        np.testing.assert_array_equal(column, alone.columns[name])
    assert (together.columns["failure"] != "").sum() == 10


def test_axes_are_lists_ranges_distributions_and_rows_of_a_file(tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("frame.ixx,frame.iyy\n0.1,0.2\n0.3,0.4\n")
    design = Design(
        {"a.b": "1:2:2", "c.d": "log:1:100:3", "e.f": "normal:5:0.1", "world": ["empty"]},
        points,
        samples=2,
    )
    assert len(design) == 2 * 3 * 1 * 2 * 2
    assert design.names == ["a.b", "c.d", "world", "frame.ixx", "frame.iyy", "e.f"]
    last = design[len(design) - 1]
    assert abs(float(last.pop("e.f")) - 5) < 1
    assert list(last.values()) == ["2", "100", "empty", "0.3", "0.4"]


@pytest.mark.parametrize("kind", ["latin", "sobol", "random", "saltelli"])
def test_sets_are_the_same_by_seed_and_others_by_another(kind):
    def values(seed):
        design = Design({"a.b": "uniform:2:3", "c.d": "loguniform:1:100"}, None, kind, 16, seed)
        return [tuple(point.values()) for point in design]

    assert values(3) == values(3) != values(4)
    numbers = np.array(values(3), dtype=float)
    assert len(numbers) == (16 * 4 if kind == "saltelli" else 16)
    assert 2 <= numbers[:, 0].min() < numbers[:, 0].max() <= 3
    if kind in ("latin", "sobol"):  # one in each sixteenth, of magnitudes too
        for unit in (numbers[:, 0] - 2, np.log10(numbers[:, 1]) / 2):
            assert sorted((16 * unit).astype(int)) == list(range(16))


@pytest.mark.parametrize(
    ("text", "quantile"),
    [
        ("uniform:-1:3", 0.0),
        ("loguniform:0.1:10", 10**-0.5),
        ("normal:5:2", 5 - 2 * 0.67448975),
        ("truncnormal:5:2:5:9", 5 + 2 * 0.303676),
        ("lognormal:2:0.5", 2 * math.exp(-0.5 * 0.67448975)),
        ("triangular:0:1:4", 1.0),
    ],
)
def test_distributions_mean_what_they_say(text, quantile):
    made = Design({"a.b": text}, samples=1).drawn["a.b"]
    assert made.ppf(0.25) == pytest.approx(quantile, rel=1e-4, abs=1e-9)


def test_sobol_indices_of_the_ishigami_function_are_those_of_its_authors():
    axes = {f"x{i}": f"uniform:{-math.pi}:{math.pi}" for i in (1, 2, 3)}
    found = qc.sweep(function=ishigami, vary=axes, design="saltelli", samples=1024, processes=1)
    one, three = 0.5 * (1 + 0.1 * math.pi**4 / 5) ** 2, 8 * 0.01 * math.pi**8 / 225
    whole = one + 49 / 8 + three
    first = [row["first"] for row in found.sensitivities]
    total = [row["total"] for row in found.sensitivities]
    assert first == pytest.approx([one / whole, 49 / 8 / whole, 0], abs=0.02)
    assert total == pytest.approx([(one + three) / whole, 49 / 8 / whole, three / whole], abs=0.02)


def test_rank_correlations_see_what_grows_and_what_does_not():
    found = qc.sweep(
        function=lambda point: {"up": math.exp(point["a"]), "down": -point["b"]},
        measures=["up", "down"],
        vary={"a": "uniform:0:9", "b": "1:5:5", "name": ["x", "y"]},
        samples=20,
        processes=1,
    )
    ranks = {(row["measure"], row["axis"]): row["rank"] for row in found.sensitivities}
    assert ranks["up", "a"] == pytest.approx(1) and ranks["down", "b"] == pytest.approx(-1)
    assert abs(ranks["up", "b"]) < 1e-9 and len(ranks) == 4


def test_the_command_line_of_a_row_flies_it_again(in_empty_folder):
    Path("s.yaml").write_text(
        "controller: ['pd:kd_xy=2.2']\nreference: ['step:dx=0.5']\nxacro: {sim_slow: 1}\n"
        "vary: {controller.kp_xy: 'uniform:2:3', frame.mass: [1.1], scenario: [gusty]}\n"
        "set: {odometry.positionNoise: 0.001}\nsamples: 3\nseed: 5\nduration: 0.5\n"
    )
    assert run_command("sweep", "s.yaml", "--out", "out", "--no-plots").returncode == 0
    worst = json.loads(Path("out/sweep.json").read_text())["worst"][0]
    words = shlex.split(worst["again"])
    assert run_command(*words[1:], "--log", "log.csv", "--quiet").returncode == 0
    log = qc.Log.of_file("log.csv")
    away = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
    row = rows("out")[worst["row"]]
    assert float(row["max_position"]) == away.max()
    assert float(row["rms_position"]) == worst["rms_position"]


def test_the_page_tells_what_was_flown(in_empty_folder):
    vary = ["--vary", "frame.mass=uniform:0.9:1.1", "--vary", "frame.ixx=0.01,0.02"]
    done = run_command(
        "sweep", *FLY, "--duration=0.5", *vary, "--samples=4", "--out=out", "--parquet"
    )
    assert done.returncode == 0, done.stderr
    page = Path("out/report.html").read_text()
    for part in ("8 rows: 8 flown, 0 failed", "frame.mass", "quadcore run quadrotor", "<svg "):
        assert part in page
    assert {path.name for path in Path("out").iterdir()} == {
        "table.csv", "table.parquet", "sweep.json", "report.html", "measure.png",
        "sensitivity.png", "surface.png", "parallel.png", "run.json", "logs", "models",
    }  # fmt: skip


def _root(point):
    return {"root": math.sqrt(point["a"]), "way": math.inf if point["a"] > 2 else point["a"]}


def test_parquet_holds_what_the_csv_holds(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    qc.sweep(
        function=_root,
        measures=["root", "way"],
        vary={"a": [-1, 0.1, 4], "name": ["=x", "-y"]},
        out=tmp_path,
        parquet=True,
    )
    table = parquet.read_table(tmp_path / "table.parquet").to_pydict()
    assert table["root"][2:] == [0.1**0.5, 0.1**0.5, 2, 2] and table["root"][0] != table["root"][0]
    assert table["way"][4] == math.inf and table["row"] == list(range(6))
    assert "ValueError" in table["failure"][0] and table["failure"][2] == ""
    with (tmp_path / "table.csv").open() as stream:
        assert [row["fingerprint"] for row in csv.DictReader(stream)] == table["fingerprint"]


@pytest.mark.parametrize(
    ("words", "worst"),
    [
        (["--reference", "circle"], "no controller is given. Add --controller or --commands."),
        ([*SHORT, "--vary", "a.b=uniform:1:2"], "vary a.b: a distribution requires a number of"),
        ([*SHORT, "--samples", "3"], "no axis has a distribution. Vary one as uniform:"),
        ([*SHORT, "--vary", "a.b=normal:1", "--samples", "3"],
         "vary a.b: 'normal:1' is not a distribution. Write normal:MEAN:DEVIATION with numbers."),
        ([*SHORT, "--vary", "a.b=uniform:2:1", "--samples", "3"],
         "the numbers of uniform:2:1 are invalid"),
        ([*SHORT, "--vary", "a.b=uniform:1:2", "--samples", "3", "--design", "sobol"],
         "samples is 3, but design sobol requires a power of two. Give 2 or 4."),
        ([*SHORT, "--vary", "drone_plugin.k=1,2"], "drone_plugin"),
        ([*SHORT, "--vary", "engine=eigen,ode"], "vary engine: engines are not an axis here."),
        ([*SHORT, "--vary", "frame.mass=1,2", "--measure", "x"], "metric 'x' does not exist"),
        ([*SHORT, "--vary", "frame.mass=1:2:2000000"], "2000000 flights are more than 1000000"),
        (["nowhere.yaml"], "nowhere.yaml: cannot be read"),
    ],
)  # fmt: skip
def test_wrong_sweeps_are_refused_in_one_line(words, worst, in_empty_folder, capsys):
    assert main(["sweep", *words]) == 2
    error = capsys.readouterr().err
    assert worst in error and error.startswith("error: ") and error.count("\n") == 1
    assert not Path("out/sweep/table.csv").exists()


def test_rows_of_a_file_of_points_are_refused_by_line(in_empty_folder):
    Path("p.csv").write_text("frame.mass\n1\n1,2\n")
    with pytest.raises(
        qc.InputError, match=r"p\.csv:3: cells are missing or extra. Write 1 values"
    ):
        sweep({}, points="p.csv", samples=None)


def test_drawn_axes_may_be_any_distribution_with_quantiles():
    stats = pytest.importorskip("scipy.stats")
    found = sweep({"frame.mass": stats.beta(2, 3, 0.9, 0.2)}, samples=4)
    assert 0.9 < found.columns["frame.mass"].min() < found.columns["frame.mass"].max() < 1.1


def test_the_description_in_the_docs_flies(in_empty_folder):
    page = Path(__file__).resolve().parents[2] / "docs" / "sweep.md"
    text = page.read_text().split("```yaml\n")[1].split("```")[0]
    Path("mass.yaml").write_text(text)
    done = run_command(
        "sweep", "mass.yaml", "--samples=3", "--duration=0.1", "--no-plots", "--out=out"
    )
    assert done.returncode == 0, done.stderr
    assert len(rows("out")) == 2 * 2 * 3


def test_pandas_reads_what_is_written(tmp_path):
    pandas = pytest.importorskip("pandas")
    found = sweep(samples=4, out=tmp_path, parquet=True)
    frames = [
        pandas.DataFrame(found.columns),
        pandas.read_csv(tmp_path / "table.csv"),
        pandas.read_parquet(tmp_path / "table.parquet"),
    ]
    for frame in frames:
        assert frame["rms_position"].tolist() == found.columns["rms_position"].tolist()
        assert frame["row"].tolist() == [0, 1, 2, 3]


def test_one_sample_set_serves_every_controller():
    found = qc.sweep(["pd", "geometric"], "hover", MASS, samples=3, duration=0.1)
    masses = found.columns["frame.mass"]
    assert masses[:3].tolist() == masses[3:].tolist()
    assert found.columns["controller"].tolist() == ["pd"] * 3 + ["geometric"] * 3
