"""What a flight or a model is warned of, once, and that it leaves with the flight."""

from __future__ import annotations

import functools
import warnings

import numpy as np
import pytest
from flights import ENGINES
from vehicles import AIR, CROSS, DRAG, LIFT, MOTOR, start, vehicle

import quadcore as qc
from quadcore.cli import main

G, MASS, K = 9.8, 1.04, DRAG["parasiticDragCoeff"]
SINGULAR = 4.6712  # s: np.pi / 2 / np.sqrt(4 * K * G / MASS)
UPSIDE_DOWN = (0, 0, 1000, np.pi, 0, 0)
DRIVES = "a propeller tilts beyond 90 degrees, where the parasitic drag of <dragModel> appendix"


def collect_warnings(call):
    """Messages of the warnings that a call raises."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(issubclass(warning.category, qc.QuadcoreWarning) for warning in caught)
    return [str(warning.message) for warning in caught]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")
def test_an_inverted_vehicle_is_driven_by_the_appendix_drag_to_a_singularity(engine):
    simulation = qc.Simulation("quadrotor", engine=engine, spawn=UPSIDE_DOWN)
    log = simulation.run(4, log_every=500)
    fall = -np.sqrt(G * MASS / (4 * K)) * np.tan(log.time * np.sqrt(4 * K * G / MASS))
    # ODE's engines take first-order steps.
    assert np.allclose(log.linear_velocity[:, 2], fall, rtol=1e-9 if engine == "eigen" else 3e-3)
    with pytest.raises(qc.FlightError) as failed:
        simulation.run(2)
    assert failed.value.time == pytest.approx(SINGULAR, abs=0.02)
    message = str(failed.value)
    assert f"plugin 'drone_plugin': {DRIVES}" in message
    assert "smaller step" not in message


@pytest.mark.parametrize("engine", ENGINES)
def test_drag_that_drives_produces_one_warning_a_flight(hangar, engine):
    air = {**AIR, **DRAG}
    simulation = start(hangar(vehicle(air=air), engine=engine), angular_velocity=[0, 10, 0])
    at_load = simulation.warnings
    assert collect_warnings(lambda: simulation.step(140)) == []  # 80 degrees
    fresh = collect_warnings(lambda: simulation.run(0.1))
    assert len(fresh) == 1
    assert fresh[0].startswith("t = 0.15") and DRIVES in fresh[0]
    assert simulation.warnings == [*at_load, *fresh]
    assert collect_warnings(lambda: simulation.run(1)) == []  # upright and over again


def test_the_warnings_of_a_flight_belong_to_its_state(hangar):
    simulation = start(hangar(vehicle(air={**AIR, **DRAG})), angular_velocity=[0, 10, 0])
    upright = simulation.snapshot()
    first = collect_warnings(lambda: simulation.step(200))
    assert len(first) == 1 == len(simulation.warnings)
    tipped = simulation.snapshot()
    simulation.restore(upright)
    assert simulation.warnings == []
    assert collect_warnings(lambda: [simulation.step() for _ in range(200)]) == first
    other = hangar(vehicle(air={**AIR, **DRAG}))
    assert collect_warnings(lambda: simulation.restore(tipped)) == []
    assert simulation.warnings == first
    assert collect_warnings(lambda: simulation.step(500)) == []
    simulation.reset()
    assert simulation.warnings == [] == other.warnings


@pytest.mark.parametrize(
    "changed", [{"parasiticDragCoeff": 0}, {"dragModel": "chapter2"}], ids=["none", "chapter2"]
)
def test_drag_that_slows_produces_no_warning(hangar, changed):
    simulation = hangar(vehicle(air={**AIR, **DRAG, **changed}))
    start(simulation, angular_velocity=[0, 10, 0])
    assert collect_warnings(lambda: simulation.run(1)) == []


def test_a_warning_made_an_error_ends_the_call_after_its_step(hangar):
    simulation = start(hangar(vehicle(air={**AIR, **DRAG})), angular_velocity=[0, 10, 0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(qc.QuadcoreWarning, match="beyond 90 degrees"):
            for _ in range(500):
                simulation.step()
    assert simulation.time == pytest.approx(0.158, abs=0.002)
    simulation.step(100)  # it goes on


def test_the_command_line_prints_what_a_flight_is_warned_of(tmp_path, capsys):
    (tmp_path / "off.csv").write_text("t,w1,w2,w3,w4\n0,0,0,0,0\n")
    arguments = ["run", "quadrotor", "--spawn", "0,0,1000,3.1,0,0", "--duration", "0.1", "--quiet"]
    arguments += ["--commands", str(tmp_path / "off.csv")]
    assert main([*arguments, "--out", str(tmp_path / "out"), "--no-plots"]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("warning: t = 0.000000 s: plugin 'drone_plugin': a propeller tilts")


def test_the_warning_about_a_vehicle_without_drag_tags_names_the_values_of_the_thesis(hangar):
    [message] = collect_warnings(lambda: hangar(vehicle(air=LIFT)))
    assert "plugin 'aerodynamic': no drag is set" in message
    for tag, value in DRAG.items():
        assert f"<{tag}>{value}" in message
        one = vehicle(air={**LIFT, tag: 0})
        assert collect_warnings(functools.partial(hangar, one)) == []
    parameters = {"aerodynamic.inducedDragCoeff": 0}
    assert collect_warnings(lambda: hangar(vehicle(air=LIFT), parameters=parameters)) == []


@pytest.mark.parametrize(
    ("model", "harm"),
    [("appendix", "its reaction torque has the wrong sign"), ("chapter2", "its thrust points")],
)
def test_an_axis_against_the_lift_is_reported(hangar, model, harm):
    urdf = vehicle(air={**AIR, **DRAG, "dragModel": model}).splitlines()
    line = next(i for i, text in enumerate(urdf) if 'joint name="rotor2"' in text)
    urdf[line] = urdf[line].replace('axis xyz="0 0 1"', 'axis xyz="0.1 0 -1"')
    [message] = collect_warnings(lambda: hangar("\n".join(urdf)))
    assert "joint 'rotor2' (" in message and f".urdf:{line + 1})" in message
    assert "opposite to the z of link 'propeller2'" in message and harm in message
    assert "Point the axis along the thrust" in message


def stiff(call):
    """Messages of motors that are too stiff for the step."""
    return [
        message for message in collect_warnings(call) if "<kp> is too large for the step" in message
    ]


@pytest.mark.parametrize("dt", [1e-3, 5e-4])
@pytest.mark.parametrize(("engine", "bound"), [("gazebo11", 2), ("ode", 2), ("eigen", 2.785)])
def test_a_motor_too_stiff_for_the_step_is_reported(hangar, engine, bound, dt):
    """A heavy frame, so that each rotor stands alone."""

    def error_grows(factor):
        kp = factor * CROSS[0].inertia[2] / dt
        urdf = vehicle(CROSS, 1e3, (1e3, 1e3, 1e3, 0, 0, 0), motor={"kp": kp})
        simulations = []
        messages = stiff(lambda: simulations.append(hangar(urdf, engine=engine, dt=dt)))
        [simulation] = simulations
        simulation.command([1, 2, 3, -4])
        simulation.step(100)
        grows = np.abs(simulation.state.rotor_velocity - [1, 2, 3, -4]).max() > 8
        assert len(messages) == (4 if grows else 0)
        return grows

    assert error_grows(1.01 * bound)
    assert not error_grows(0.99 * bound)


def test_joint_damping_counts_as_stiffness(hangar):
    damped = [rotor._replace(damping=0.04) for rotor in CROSS]  # 1422 1/s
    assert stiff(lambda: hangar(vehicle(damped, motor=MOTOR))) == []
    messages = stiff(lambda: hangar(vehicle(damped, motor={"kp": 0.02})))
    assert len(messages) == 4
    assert "Use <kp> below 0.01625 N m s/rad" in messages[0]


INCOMPLETE = """<robot name="incomplete" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find quadcore)/urdf/quadrotor.urdf.xacro"/>
<xacro:include filename="nothing_*.xacro"/>
</robot>"""
DOUBTS = {
    "a tag": lambda: qc.Simulation(parameters={"motorpid_plugin.ki": 1}),
    "of a batch": lambda: qc.BatchSimulation("incomplete.xacro", 2),
    "of a model that is read": lambda: qc.read_model("incomplete.xacro"),
    "of a flight that is described": lambda: qc.FlightPlan.of("incomplete.xacro"),
    "of a study": lambda: qc.evaluate("pd", "hover", duration=0.02, models="incomplete.xacro"),
    "a flight": lambda: qc.Simulation(spawn=UPSIDE_DOWN).run(0.1),
    "a step": lambda: qc.Simulation(spawn=UPSIDE_DOWN).step(),
    "a plan that is flown": lambda: qc.FlightPlan.of(spawn=UPSIDE_DOWN, duration=0.1).fly(),
    "an event too late": lambda: qc.FlightPlan.of(scenario="lost_rotor", duration=0.1),
    "a file that xacro does not find": lambda: qc.Simulation("incomplete.xacro"),
    "gains of another": lambda: qc.controllers.parse("other.yaml", "quadrotor"),
}


@pytest.mark.parametrize("doubt", DOUBTS)
def test_a_warning_shows_the_line_that_called_quadcore(doubt, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "incomplete.xacro").write_text(INCOMPLETE)
    (tmp_path / "other.yaml").write_text("law: geometric\nvehicle: hexarotor\n")
    with pytest.warns(qc.QuadcoreWarning) as shown:
        DOUBTS[doubt]()
    line = DOUBTS[doubt].__code__.co_firstlineno
    assert {(warning.filename, warning.lineno) for warning in shown} == {(__file__, line)}


def test_a_warning_within_a_controller_shows_its_line():
    def controller(t, state, reference):
        qc.Simulation(parameters={"motorpid_plugin.ki": 1})
        return [471, -471, 471, -471]

    with pytest.warns(qc.QuadcoreWarning) as shown:
        qc.Simulation(engine="eigen").run(0.002, controller=controller)
    line = controller.__code__.co_firstlineno + 1
    assert {(warning.filename, warning.lineno) for warning in shown} == {(__file__, line)}
