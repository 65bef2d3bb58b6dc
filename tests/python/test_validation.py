"""``quadcore validate``: flights, chains, tables, page and refusals."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from test_docs import COMMANDS
from vehicles import AIR, CROSS, DRAG, MOTOR, vehicle

import quadcore as qc
from quadcore.chapter2 import Vehicle
from quadcore.cli import main
from quadcore.validation import MODEL, Case, Experiment, causes, compare, conduct, states
from quadcore.validation import figures as pictures_of_study
from quadcore.validation.ascent import ascent
from quadcore.validation.experiment import at_steps
from quadcore.validation.figures import pictures
from quadcore.validation.given_speeds import speeds
from quadcore.validation.output import size
from quadcore.validation.thesis import KINDS, SIM_SLOW, thesis_figures

ENGINES = [name for name, _ in qc.engines()]
ROOT = Path(__file__).resolve().parents[2]
HEXAROTOR = ROOT / "tests/data/gazebo11/cases/B1_hexa_hover/model.urdf"
FAST = ["--drag", "none", "--sim-slow", "1", "--engine", "eigen", "--duration", "0.5", "--quiet"]


@pytest.fixture(scope="module")
def study():
    return conduct(Experiment.of(), ENGINES, [1, 8], ["none", "all"])


@pytest.fixture(scope="module")
def distances(study):
    """Largest distance from the model by engine, sim_slow and drag."""
    assert not any(row.failure for row in study.rows)
    return {row.case[:3]: row.difference.largest["distance"] for row in study.rows}


def test_every_flight_ascends_and_moves_in_all_axes_without_a_steep_angle(study):
    for flight in study.flights.values():
        ranges = np.ptp(states(flight.log)[:, :6], axis=0)
        assert ranges[:2].min() > 0.2
        assert flight.log.position[-1, 2] > 20
        assert ranges[3:].min() > np.radians(2)
    for row in study.rows:
        assert row.steepest < np.radians(60)


def test_slowing_down_seems_to_cure_gazebo(distances):
    assert distances["gazebo11", 1, "all"] > 10
    assert distances["gazebo11", 8, "all"] < distances["gazebo11", 1, "all"] / 10
    assert distances["gazebo11", 8, "none"] < distances["gazebo11", 1, "none"] / 10


def test_engines_without_the_fault_need_no_slowing_down(distances):
    for engine in ("ode", "eigen"):
        for drag in ("none", "all"):
            assert distances[engine, 1, drag] < distances[engine, 8, drag]
            assert distances[engine, 1, drag] < distances["gazebo11", 1, drag] / 10


def test_a_chain_leads_from_the_plant_to_the_model_and_adds_up(study):
    assert len(study.chains) == 4
    for chain in study.chains:
        assert not chain.failure
        assert chain.links[0].begin == Case("gazebo11", chain.sim_slow, chain.drag)
        assert chain.links[-1].end == Case(MODEL, 1, chain.drag)
        for link, after in zip(chain.links, chain.links[1:]):
            assert link.end == after.begin
        assert sum(link.share for link in chain.links) == pytest.approx(chain.distance, abs=1e-12)
        ends = [study.flights[case].log for case in (chain.links[0].begin, chain.links[-1].end)]
        whole = compare(*ends).largest["distance"]
        assert chain.distance == pytest.approx(whole, abs=1e-12)
    assert [len(chain.links) for chain in study.chains] == [5, 6, 5, 6]


def test_the_fault_is_repaired_before_the_slow_down_is_undone(study):
    """At full speed the fault costs metres that a slowed plant does not show."""
    chain = next(c for c in study.chains if (c.drag, c.sim_slow) == ("all", 8))
    plants = [link.begin[:2] for link in chain.links[:4]]
    assert plants == [("gazebo11", 8), ("ode", 8), ("eigen", 8), ("eigen", 1)]
    for link in chain.links:
        assert abs(link.share) < chain.distance
        assert link.largest < 1


def test_each_link_changes_one_thing(study):
    for chain in study.chains:
        for link in chain.links[:-1]:
            assert sum(a != b for a, b in zip(link.begin, link.end)) == 1


def test_the_links_say_what_is_wrong(study):
    chain = next(c for c in study.chains if (c.drag, c.sim_slow) == ("all", 1))
    fault, step, drag, left_out, rest = chain.links
    assert fault.largest > 10
    assert 0.01 < step.largest < 1
    assert 0.1 < drag.largest < 1
    assert 0.1 < left_out.largest < 1
    assert rest.largest < 2e-4
    bare = next(c for c in study.chains if (c.drag, c.sim_slow) == ("none", 1))
    assert bare.links[2].largest < 1e-10


def test_what_is_left_out_is_the_torque_of_rotors_that_spin_up(study):
    sizes = [row.difference.largest["distance"] for row in study.left_out]
    no_lag, spin_up, dragged, both = sizes
    assert no_lag > 0.5
    assert both == pytest.approx(spin_up, rel=0.05)
    assert dragged < spin_up / 20


def test_only_gazebo_damps_and_as_expected(study):
    assert [entry.sim_slow for entry in study.damping] == [1, 8]
    for entry in study.damping:
        assert sorted(entry.measured) == sorted(ENGINES)
        for engine, decay in entry.measured.items():
            if engine == "gazebo11":
                assert decay == pytest.approx(entry.formula, rel=0.01)
            else:
                assert abs(decay) < 1e-3 * entry.formula


def test_the_model_has_no_second_engine_in_it(study):
    """Its flight is apart from that of the engine whose limit it is."""
    flights = [study.flights[Case("eigen", 1, "all", "given speeds")], study.flights[Case(MODEL)]]
    assert 1e-6 < compare(*(flight.log for flight in flights)).largest["distance"] < 2e-4


def test_an_ascent_lifts_a_hexarotor_with_odd_rotors():
    experiment = Experiment.of(str(HEXAROTOR), duration=3)
    assert experiment.commands.shape[1] == 7
    assert (np.sign(experiment.commands[:, 1:]) == [1, -1, 1, -1, 1, -1]).all()
    log = experiment.fly(Case("eigen")).log
    assert log.position[-1, 2] > 11
    assert np.abs(states(log)[:, 3:5]).max() < 0.3


def test_a_vehicle_that_the_input_cannot_lift_tilt_or_turn_is_refused_with_the_reason(hangar):
    def refused(rotors, **air):
        air = {**AIR, **DRAG, **air}
        urdf = vehicle(rotors, air=air, motor=MOTOR)
        with pytest.raises(qc.InputError) as refusal:
            ascent(Vehicle.of(hangar(urdf, (0, 0, -9.8), engine="eigen")))
        return str(refusal.value)

    assert "give this vehicle no lift without another force" in refused(CROSS[:2])
    # Lifts and tilts, but nothing turns it about the vertical.
    assert "give this vehicle no torque about z without" in refused(CROSS, rotorTorqueCoeff=0)
    # Turns, but a hundred times less than the built-in flight asks.
    weak = refused(CROSS, rotorTorqueCoeff=AIR["rotorTorqueCoeff"] / 100)
    assert "cannot lift this vehicle and turn it about z as fast as" in weak


def test_a_command_takes_effect_with_the_step_that_feels_it():
    table = np.array([[-1, 1], [0, 2], [0.0011, 3], [0.002, 4], [0.0021, 5], [0.005, 6]])
    assert at_steps(table, 1e-3).tolist() == [[0, 2], [0.002, 4], [0.003, 5], [0.005, 6]]


def test_given_speeds_are_those_of_motors_on_a_held_frame():
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    heavy = Vehicle.of(simulation)
    table = np.array([[0, 400, -400, 400, -400], [0.1, 500, -450, 500, -450]])
    times = np.array([0.05, 0.1, 0.15, 1.0])
    omega = speeds(heavy, table, times, lag=True)
    rate = 5e-4 / 2.8125e-5
    assert np.allclose(omega[:2], table[0, 1:])
    assert omega[2, 0] == pytest.approx(500 - 100 * np.exp(-rate * 0.05), rel=1e-12)
    assert np.allclose(omega[3], table[1, 1:], atol=1e-4)
    assert np.array_equal(speeds(heavy, table, times, lag=False)[1], table[1, 1:])


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """Folder that the command has written."""
    folder = tmp_path_factory.mktemp("validate") / "deep" / "out"
    assert main(["validate", *FAST, "--jobs", "1", "--out", str(folder)]) == 0
    return folder


def test_the_command_writes_tables_figures_and_one_page(out):
    page = (out / "report.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]{1,40})', page)
    assert len(sources) == 8 and all(s.startswith("data:image/png;base64,") for s in sources)
    for kind in ("position", "error", "attitude", "velocity", "rates", "chain"):
        assert (out / f"{kind}_none.png").read_bytes().startswith(b"\x89PNG")

    (row,) = csv.DictReader((out / "errors.csv").open())
    assert (row["engine"], row["sim_slow"], row["drag"], row["failure"]) == (
        "eigen", "1.0", "none", ""
    )  # fmt: skip
    (found,) = json.loads((out / "validation.json").read_text())["errors"]
    for state in ("x", "psi", "vz", "thetadot", "distance"):
        for kind, name in (("max", "largest"), ("rms", "rms")):
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
    assert "because of" in printed.out
    assert f"written {tmp_path / 'report.html'}" in printed.out
    assert printed.err == ""
    names = sorted(path.name for path in out.iterdir())
    assert len(names) == 13
    for name in names:
        assert (out / name).read_bytes() == (tmp_path / name).read_bytes(), name


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
    assert option.default is None  # `conduct` decides
    assert ",".join(f"{n:g}" for n in SIM_SLOW) in option.help


@pytest.fixture(scope="module")
def short():
    """Study of a flight so short that most differences are rounding."""
    return conduct(Experiment.of(duration=0.5), ENGINES, [1, 8], ["none", "all"], 1)


def test_no_text_of_a_picture_is_cut_off(short, study, monkeypatch):
    figures = []
    for module in (pictures_of_study, causes):
        monkeypatch.setattr(module, "png", figures.append)
    for draw, what in [*pictures(short).values(), *pictures(study).values()]:
        draw(*what)
    assert len(figures) == 2 * 14
    for figure in figures:
        box = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())  # inch
        width, height = figure.get_size_inches()
        title = figure._suptitle.get_text()
        assert min(box.x0, box.y0, width - box.x1, height - box.y1) >= 0, title


def test_bars_are_labelled_as_the_tables_have_it_and_rounding_is_no_bar(short, monkeypatch):
    figures = []
    monkeypatch.setattr(causes, "png", figures.append)
    chains = [chain for chain in short.chains if chain.drag == "none"]
    causes.draw_chains(chains)
    (axes,) = figures[0].axes
    links = {(link.begin, link.end): link.largest for chain in chains for link in chain.links}
    assert sorted(text.get_text() for text in axes.texts) == sorted(
        f" {size(largest)} m" for largest in links.values()
    )
    widths = [bar.get_width() for bar in axes.patches]
    assert sum(width > 0 for width in widths) == sum(size > 1e-9 for size in links.values()) == 2


def test_rounding_is_drawn_as_a_flat_line(short, monkeypatch):
    figures = []
    monkeypatch.setattr(pictures_of_study, "png", figures.append)
    for kind, least in (("error", 1e-8), ("position", 1e-3), ("rates", 1e-3)):
        pictures_of_study.draw(pictures_of_study.curves(short, "none"), kind)
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
    says = "1 of 8 pictures failed; the first, attitude_none: its process was ended by SIGKILL"
    assert capsys.readouterr().err == f"error: {says}\n"
    (row,) = csv.DictReader((tmp_path / "errors.csv").open())
    assert row["failure"] == "" and float(row["max_distance"]) >= 0
    drawn = sorted(path.stem for path in tmp_path.glob("*.png"))
    assert len(drawn) == 7 and "attitude_none" not in drawn and "velocity_induced" not in drawn
    page = (tmp_path / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 7
    assert len(list(tmp_path.iterdir())) == 7 + 5


def test_flights_that_fail_are_rows_with_a_reason(tmp_path, capsys):
    """At steps of 7 ms a rotor turns more than half a turn, unless it is slowed."""
    arguments = ["--dt", "0.007", "--sim-slow", "1,8", "--drag", "none", "--duration", "0.7"]
    arguments += ["--engine", "ode,eigen", "--no-plots", "--out", str(tmp_path)]
    assert main(["validate", *arguments]) == 3
    printed = capsys.readouterr()
    assert printed.err.startswith("error: 2 of 4 flights failed; the first (ode, sim_slow 1, ")
    assert "more than half a turn per step" in printed.err and printed.err.count("\n") == 1
    assert re.search(r"ode +1 +failed\node +8 +[\d.e-]+\n", printed.out)
    rows = list(csv.DictReader((tmp_path / "errors.csv").open()))
    assert [bool(row["failure"]) for row in rows] == [True, False, True, False]
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
    assert 0 < found["errors"][0]["largest"]["distance"] < 0.1


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--engine", "eigen,bullet"], "'bullet' is none of gazebo11, ode, eigen"),
        (["--sim-slow", "1,0"], "0 is not greater than 0"),
        (["--sim-slow", "1,x"], "'x' is not a finite number"),
        (["--drag", "none,lift"], "drag 'lift' does not act on this vehicle (none, profile, "),
        (["--set", "drone_plugin.sim_slow=2"], "drone_plugin.sim_slow: every flight has its own"),
        (["--set", "motorpid_plugin.kd=1e-9"], "the mathematical model has proportional motors"),
        (["--commands", "late.csv"], "the first row is for t = 1; begin at t = 0"),
        (["--commands", "none.csv"], "none.csv: cannot be read"),
        (["--duration", "1", "--log-every", "1001"], "the flight has 1000 steps"),
        (["--motors", "electric"], "--motors: invalid choice: 'electric'"),
        (["--out", "late.csv"], "late.csv: cannot be made"),
        (["nowhere.urdf"], "nowhere.urdf: no such file, and no shipped model of that name"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(arguments, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("late.csv").write_text("t,w1,w2,w3,w4\n1,471,-471,471,-471\n")
    assert main(["validate", *arguments, "--quiet"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ") and says in error and error.count("\n") == 1


def yaw_loop(slow):
    """Roots of the loop of the published yaw gains on the model's own yaw, at hover."""
    k, b, rotor, gain = 1.1487e-5, 2.69e-7, 2.8125e-5, 5e-4
    hover = np.sqrt(1.04 * 9.8 / (4 * k))
    lag, zero = gain / rotor, 2 * b * hover * slow / rotor
    numerator = lag * np.polymul([-1 / zero, 1], [16, 96, 96])
    return np.roots(np.polyadd(np.polymul([1, 0, 0, 0], [1, lag]), numerator)), zero


def test_what_the_docs_say_of_the_published_gains():
    roots = np.roots([1, 0.125, 2.4, 0.8])
    assert np.round(roots[0], 2) == 0.10 + 1.57j
    drag = 4 * (0.01 + 0.0025 + 0.005) / 1.04
    growth = np.roots([1, 0.125 + drag, 2.4, 0.8]).real.max()
    assert round(drag, 3) == 0.067 and round(1 / growth) == 15
    for enough, stable in ((0.20, False), (0.21, True)):
        assert (np.roots([1, 0.125 + enough, 2.4, 0.8]).real.max() < 0) == stable
    for slow, zero, root in ((1, 9.0, 10.4 + 11.3j), (8, 72, -2.9 + 14.0j)):
        found, where = yaw_loop(slow)
        assert round(where, 1 if slow == 1 else 0) == zero
        assert np.round(found[found.imag.argmax()], 1) == root
        assert (found.real.max() < 0) == (slow == 8)


@pytest.mark.parametrize(("slow", "holds"), [(1, False), (8, True)])
def test_the_published_yaw_gains_hold_a_slowed_plant_only(slow, holds):
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": slow})
    state = simulation.state.copy()
    spin = np.array([1, -1, 1, -1])
    hover = np.sqrt(simulation.mass * 9.8 / (4 * 1.1487e-5))
    state.orientation[:] = [0, 0, np.sin(0.005), np.cos(0.005)]
    state.rotor_velocity[:] = spin * hover / slow
    simulation.set_state(state)
    integral, yaws = 0.0, []
    for _ in range(4000):
        yaw = 2 * np.arctan2(simulation.state.orientation[2], simulation.state.orientation[3])
        integral -= yaw * simulation.dt
        wanted = -96 * yaw + 96 * integral - 16 * simulation.state.angular_velocity[2]
        torque = simulation.inertia[2, 2] * wanted
        simulation.command(spin * np.sqrt(np.maximum(hover**2 + spin * torque / (4 * 2.69e-7), 0)))
        simulation.step()
        yaws.append(abs(yaw))
    assert (max(yaws[3000:]) < 1e-3) == holds
    assert (max(yaws[3000:]) > 0.1) != holds


def test_drag_makes_the_open_loop_unstable_as_the_docs_say():
    """About hover: a disturbance grows e-fold in 1.8 s, tenfold in 4.2 s."""
    v = Vehicle.of(qc.Simulation("quadrotor", engine="eigen"))
    drag = len(v.arms) * (v.K_I + v.K_T + v.K_P)
    tip = -v.gravity[2] * drag * v.arms[0, 2] / v.inertia[0, 0]
    growth = np.roots([1, drag / v.mass, 0, tip]).real.max()
    assert (round(1 / growth, 1), round(np.log(10) / growth, 1)) == (1.8, 4.2)


def test_real_gazebo_and_gazebo11_are_measured_alike_in_the_docs():
    page = (ROOT / "docs" / "gazebo.md").read_text()
    table = page.split("<!-- measured: decay -->")[1].split("<!-- end -->")[0]
    rows = [row.strip("| ").split(" | ") for row in table.strip().splitlines()[2:]]
    assert [row[0] for row in rows] == ["1", "8", "10", "18"]
    for _, _, real, gazebo, *_ in rows:
        digits = len(real.split(".")[1])
        assert round(float(gazebo), digits) == float(real)


def test_the_docs_say_what_the_command_finds(study):
    page = (ROOT / "docs" / "validation.md").read_text()
    table = re.findall(r"^\| (\w+) \| (1|8) \| ([\d.]+) \|.* ([\d.]+) \|$", page, re.MULTILINE)
    assert len(table) == 6
    for engine, slow, none, everything in table:
        for drag, printed in (("none", none), ("all", everything)):
            row = next(r for r in study.rows if r.case[:3] == (engine, float(slow), drag))
            assert size(row.difference.largest["distance"]) == printed
