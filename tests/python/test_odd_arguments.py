"""Odd arguments and commands: one clear line and the right exit status."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from flights import quadrotor
from processes import FALL, LONG, run_command, run_refused

import quadcore as qc
from quadcore.cli import main
from quadcore.simulation.commands import read_commands

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def test_commands_that_are_no_real_numbers_are_refused():
    simulation = quadrotor()
    masked = np.ma.array([1.0, 2, 3, 4], mask=[0, 1, 0, 0])
    for speeds in (["1", "2", "3", "4"], masked, [1j, 0, 0, 0], np.array([None, 1, 2, 3])):
        with pytest.raises(qc.InputError, match="array of numbers"):
            simulation.command(speeds)
        with pytest.raises(qc.InputError, match="not a table of real numbers"):
            row = np.ma.concatenate([[0], speeds]) if speeds is masked else [0, *speeds]
            simulation.run(0.1, row[None] if speeds is masked else [row])
    simulation.command([1, 2, 3, np.float32(4)])


@pytest.mark.parametrize("make", [qc.Simulation, qc.BatchSimulation])
def test_an_engine_and_a_step_that_are_none_are_refused_in_one_line(make):
    for given, message in (
        ({"engine": None}, "engine is None. Give one of gazebo11, ode, eigen."),
        ({"engine": "\udc80"}, "engine is '\\udc80'. Give one of gazebo11, ode, eigen."),
        ({"engine": 3}, "engine is 3. Give one of gazebo11, ode, eigen."),
        ({"dt": "a"}, "dt is 'a'. Give the length of a step in s."),
        ({"dt": [1, 2]}, "dt is [1, 2]. Give the length of a step in s."),
    ):
        with pytest.raises(qc.InputError) as refusal:
            make("quadrotor", **given)
        assert str(refusal.value) == message


def test_flights_compared_without_commands_produce_a_warning(capsys):
    flight = ["compare", "quadrotor", "--engine", "eigen", "--duration", "0.01", "--no-plots"]
    assert main([*flight, "--vary", "motorpid_plugin.kp=0.0005,0.001"]) == 0
    message = capsys.readouterr().err
    assert "no rotor command is given" in message and "--controller geometric" in message


def test_an_interrupt_inside_an_argument_is_one():
    class Interrupting:
        def __array__(self, *_, **__):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        quadrotor().command(Interrupting())


@pytest.mark.parametrize("number", ["1_0e-3", "\u0661", "1e", "0x1p3", "nan", "1,5"])
def test_numbers_are_those_of_a_urdf_everywhere(number, capsys):
    Path("c.csv").write_text(f"t,w1,w2,w3,w4\n0,1,1,1,{number}\n", encoding="utf-8")
    for option in ("--dt", "--duration", "--spawn", "--seed"):
        value = f"0,0,{number}" if option == "--spawn" else number
        assert main(["run", "quadrotor", option, value]) == 2
    assert main(["compare", "quadrotor", "--vary", f"motorpid_plugin.kp=1e-4:{number}:3"]) == 2
    assert main(["run", "quadrotor", "--commands", "c.csv"]) == 2
    with pytest.raises(qc.InputError):
        qc.Simulation("quadrotor", spawn=(0, 0, number))
    assert capsys.readouterr().err.count("error: ") == 6


def test_a_pipe_as_commands_is_refused():
    for name in ("c.csv", "c.mat"):
        os.mkfifo(name)
        assert "is not a regular file" in run_refused(*FALL, "--commands", name)


def test_a_mat_file_is_not_unpacked_beyond_what_can_be_meant():
    names = ["t", "w1", "w2", "w3", "w4"]
    scipy.io.savemat(
        "c.mat", {name: np.zeros(10**7 + 1) for name in names[:1]}, do_compression=True
    )
    with pytest.raises(qc.InputError, match="save t, w1"):
        read_commands("c.mat", 4)
    scipy.io.savemat("d.mat", {"t": np.zeros(10**7 + 1), "w1": [0.0]}, do_compression=True)
    with pytest.raises(qc.InputError, match="t has 10000001 values, more than 10000000"):
        read_commands("d.mat", 1)


def test_a_csv_file_has_a_largest_size(monkeypatch):
    Path("c.csv").write_text("t,w1\n0,1\n")
    monkeypatch.setattr("quadcore.formats.csv._LARGEST", 8)
    with pytest.raises(qc.InputError, match="exceeds the limit"):
        read_commands("c.csv", 1)


def test_engine_and_world_are_varied_alone():
    assert "Use an axis for each" in run_refused(
        "compare", "quadrotor", "--vary", "engine,world=eigen"
    )


def test_a_time_at_which_the_clock_would_stand_still_is_refused():
    simulation = quadrotor()
    state = simulation.state.copy()
    state.time = 1e300
    with pytest.raises(qc.InputError, match="the time is beyond 1e9 s"):
        simulation.set_state(state)


def test_no_negative_zero_is_printed(capsys):
    commands = "t,w1,w2,w3,w4\n0,-1,1,-1.0001,1\n"
    Path("c.csv").write_text(commands)
    for _ in range(2):
        assert main([*FALL, "--spawn=-0.0,-1e-9,1", "--commands", "c.csv"]) == 0
    assert "-0.0000" not in capsys.readouterr().out


def test_each_log_is_written_once_and_holds_what_its_name_says(capsys):
    assert main([*FALL, "--quiet", "--log", "a.csv", "--log", "b.csv"]) == 0
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()
    assert main([*FALL, "--log", "c.csv", "--log", "./c.csv"]) == 2
    assert "would be written twice" in capsys.readouterr().err
    log = quadrotor().run(0.01)
    for write in (log.to_csv, log.to_mat):
        with pytest.raises(qc.InputError, match="Name a file that ends in"):
            write("a.npz")


def test_a_flight_shorter_than_a_step_is_refused(capsys):
    assert main(["run", "quadrotor", "--duration", "1e-5"]) == 2
    assert "Give more." in capsys.readouterr().err
    assert len(quadrotor().run(0)) == 1


def test_a_cell_that_a_spreadsheet_would_run_is_text(toy):
    Path("=1+1.urdf").write_text(Path("toy.urdf").read_text())
    assert (
        run_command(
            "compare", "=1+1.urdf", "toy.urdf", "--duration", "0.01", "--out", "out"
        ).returncode
        == 0
    )
    assert "1,'=1+1.urdf," in Path("out/table.csv").read_text()


def test_tables_are_written_before_pictures(toy, monkeypatch):
    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("quadcore.report.plots.finish", fail)
    vary = ["--vary", "motor.kp=1e-4,2e-4", "--duration", "0.01", "--out", "out", "--jobs", "1"]
    assert main(["compare", "toy.urdf", *vary]) == 130
    assert Path("out/table.csv").exists() and Path("out/comparison.json").exists()


def test_a_view_read_beside_a_step_is_not_a_copy():
    """`copy` is of one moment, or refused: positions and velocities belong together."""
    drags = ("induced", "translational", "profile", "parasitic")
    still = {f"drone_plugin.{drag}DragCoeff": 0 for drag in drags}
    simulation = quadrotor("eigen", parameters=still)
    ending = threading.Event()

    def fly():
        while not ending.wait(0.001):
            simulation.step(200)

    thread = threading.Thread(target=fly)
    thread.start()
    copies = 0
    give_up = time.monotonic() + LONG
    while copies < 20 and time.monotonic() < give_up:
        try:
            state = simulation.state.copy()
        except qc.InputError:
            continue
        copies += 1
        assert state.linear_velocity[2] == pytest.approx(-9.8 * state.time, rel=1e-9)
        assert state.position[2] == pytest.approx(10 - 4.9 * state.time**2, rel=1e-9)
    ending.set()
    thread.join()


@pytest.mark.parametrize("name", ["motorpid_plugin.kp", "propeller1.izz", "drone_plugin.dragModel"])
def test_an_error_about_a_text_by_others_is_one_line_without_control_characters(name):
    for text in ("\x1b[2J", "a\nb", "\udc80", "x" * 5000):
        with pytest.raises(qc.InputError) as refusal:
            quadrotor("eigen", parameters={name: text})
        assert str(refusal.value).isprintable() and 0 < len(str(refusal.value)) < 1000


def test_a_controller_reads_odometry_and_no_other_topic():
    simulation = quadrotor("eigen")
    assert list(qc.Odometry(simulation).position) == [0, 0, 10]
    with pytest.raises(qc.InputError, match=r"^topic 'vel_cmd' does not carry odometry\. Name"):
        qc.Odometry(simulation, "vel_cmd")


def test_a_controller_of_another_simulation_does_not_fly_this_one():
    simulation, other = quadrotor("eigen"), quadrotor("eigen")
    controller = qc._core.Controller("geometric", other, other, {}, [])
    loop = qc._core.ControlLoop(qc._core.Flight(simulation, None, 1), 500, 0)
    hover = qc._core.ReferenceShape("hover", {})
    with pytest.raises(qc.InputError, match="the controller flies another simulation"):
        loop.follow(1, controller, "odom", hover)
    with pytest.raises(qc.InputError, match=r"limits has the shape \(3,\)"):
        loop.advance(1, lambda: [0, 0, 0, 0], [1.0, 1.0, 1.0])


@pytest.mark.parametrize("member", ["rotor_velocity", "rotor_angle"])
def test_a_motion_made_in_python_has_the_vehicles_rotors(member):
    simulation = quadrotor("eigen")
    moved = simulation.state.copy()
    setattr(moved, member, np.zeros(3))
    simulation._move_by(lambda *_: moved)
    with pytest.raises(qc.FlightError, match="another number of rotors"):
        simulation.step()


@pytest.mark.parametrize("shape", ["waypoints", "series"])
def test_a_path_has_a_place_at_a_time_that_is_no_number(shape):
    rows = [[0, 0, 0, 1], [1, 1, 0, 1], [2, 1, 1, 1], [3, 0, 1, 1], [4, 0, 0, 1], [5, 1, 0, 1]]
    path = qc._core.ReferenceShape(shape, {}, rows)
    for t in (float("nan"), float("inf"), -float("inf")):
        assert np.isfinite(path.at(t).position).all()
