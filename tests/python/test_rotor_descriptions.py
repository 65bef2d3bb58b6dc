"""`Simulation.rotors`, and the studies that use it, on vehicles whose tags have different names."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest
from flights import ENGINES
from hooked import G, with_plugins
from vehicles import CROSS, Rotor, plugin, start, vehicle, wrenches

import quadcore as qc

THESIS = ["crazyflie", "hexarotor", "quadrotor"]
ROTORS = ["ardrone", "firefly", "hummingbird", "iris", "neo11", "pelican"]
MODELS = sorted(THESIS + ROTORS)


def tags_of(model):
    """Tags of each plugin of a shipped model as written in its file, by file name."""
    tree = ElementTree.fromstring(qc.read_model(model).document.text)
    for element in tree.iter("plugin"):
        yield element.get("filename"), {tag.tag: (tag.text or "").strip() for tag in element}


def describe_rotors(model, **options):
    return qc.Simulation(model, engine="eigen", **options).rotors


@pytest.mark.parametrize("model", ROTORS)
def test_rotors_of_rotors_vehicles_are_those_of_their_motors_tags(model):
    file = "librotors_gazebo_motor_model.so"
    motors = {tags["jointName"]: tags for name, tags in tags_of(model) if name == file}
    rotors = describe_rotors(model)
    assert {rotor.joint for rotor in rotors} == set(motors)
    for rotor in rotors:
        tags = motors[rotor.joint]
        thrust = float(tags["motorConstant"])
        assert rotor.thrust_coefficient == pytest.approx(thrust, rel=1e-12)
        torque = thrust * float(tags["momentConstant"])
        assert rotor.torque_coefficient == pytest.approx(torque, rel=1e-12)
        assert rotor.torque_sense == -1
        assert rotor.spin == {"ccw": 1, "cw": -1}[tags["turningDirection"]]
        assert rotor.max_speed == float(tags["maxRotVelocity"])
        assert rotor.slowdown == float(tags["rotorVelocitySlowdownSim"])
        lags = (float(tags["timeConstantUp"]), float(tags["timeConstantDown"]))
        assert rotor.time_constant == max(lags)
        assert rotor.command_index == int(tags["motorNumber"])


@pytest.mark.parametrize(
    ("model", "motor"),
    [("crazyflie", ""), *((m, kind) for m in THESIS[1:] for kind in ("pid", "first_order"))],
)
def test_rotors_of_the_thesis_vehicles_are_those_of_their_tags(model, motor):
    simulation = qc.Simulation(
        model, engine="eigen", xacro_args={"motor": motor} if motor else None
    )
    tags = {tag.name: tag.value for plugin in simulation.plugins for tag in plugin.parameters}
    for i, rotor in enumerate(simulation.rotors):
        joint, link = simulation.model.joints[i], simulation.model.links[1 + i]
        assert rotor.joint == simulation.rotor_names[i] == joint.name
        assert rotor.position == pytest.approx(joint.xyz)
        assert rotor.thrust_coefficient == pytest.approx(float(tags["rotorThrustCoeff"]), rel=1e-12)
        assert rotor.torque_coefficient == pytest.approx(float(tags["rotorTorqueCoeff"]), rel=1e-12)
        assert rotor.torque_sense == {"thesis": 1, "opposing": -1}[tags["reactionTorque"]]
        assert rotor.max_speed == float(tags["maxVelocity"])
        assert rotor.slowdown == float(tags["sim_slow"])
        moment = joint.axis @ link.inertia @ joint.axis
        lag = moment / float(tags["kp"]) if "kp" in tags else float(tags["timeConstantDown"])
        assert rotor.time_constant == pytest.approx(lag, rel=1e-12)
        assert rotor.command_index == i


@pytest.mark.parametrize("model", MODELS)
def test_spins_and_coefficients_make_up_what_holds_a_vehicle_in_hover(model):
    simulation = qc.Simulation(model, engine="eigen")
    commands, force, torque = simulation.hover_speed, np.zeros(3), np.zeros(3)
    for rotor in simulation.rotors:
        command = commands[rotor.command_index]
        assert np.sign(command * rotor.rate_per_command) == rotor.spin
        thrust = rotor.thrust_coefficient * command**2 * rotor.axis
        reaction = rotor.torque_sense * rotor.spin * rotor.torque_coefficient * command**2
        force += thrust
        torque += np.cross(rotor.position - simulation.center_of_mass, thrust)
        torque += reaction * rotor.axis
    weight = simulation.mass * -simulation.gravity[2]
    assert force == pytest.approx((0, 0, weight), rel=1e-6, abs=1e-5 * weight)
    assert torque == pytest.approx(np.zeros(3), abs=1e-5 * weight)


def test_a_rotor_that_is_lost_in_flight_is_described_as_before(tmp_path):
    scenario = tmp_path / "loss.yaml"
    scenario.write_text("events:\n  - at: 0.05\n    weaken: 2\n    to: 0.3\n")
    plan = qc.FlightPlan.of("quadrotor", engine="eigen", scenario=scenario)
    simulation = plan.simulation()
    before = [rotor.thrust_coefficient for rotor in simulation.rotors]
    thrusts = []
    for _ in range(2):
        start(simulation, rotor_velocity=[47, -47, 47, -47])
        thrusts.append(wrenches(simulation)["thrust"][2])
        simulation.step(100)
    assert thrusts[1] == pytest.approx(thrusts[0] * (3 + 0.3) / 4)
    assert [rotor.thrust_coefficient for rotor in simulation.rotors] == before


TILTED = (Rotor((0.1, 0.2, 0.3), (0.3, 0.2, 0.1), com=(0, 0, 0.03)), *CROSS[1:])


@pytest.fixture
def own(hangar, hook_plugins):
    """A vehicle with a third party's motors, whose first rotor is tilted."""
    urdf = with_plugins(vehicle(TILTED), plugin("own_motor", {}), plugin("odometry", {}))
    return lambda **options: hangar(urdf, G, engine="eigen", **options)


def test_rotors_of_a_third_partys_motors_are_measured_and_its_lag_is_unknown(own):
    rotors = own().rotors
    for i, rotor in enumerate(rotors):
        assert rotor.thrust_coefficient == pytest.approx(2e-5, rel=1e-12)
        assert rotor.torque_coefficient == pytest.approx(3e-7, rel=1e-9)
        assert (rotor.torque_sense, rotor.spin) == (-1, (-1) ** i)
        assert (rotor.slowdown, rotor.max_speed, rotor.command_index) == (4, 1000, 3 - i)
        assert rotor.rate_per_command == (-1) ** i / 4
        assert np.isnan(rotor.time_constant)
    assert rotors[0].position == pytest.approx((0.1, 0.2, 0.3))
    assert np.linalg.norm(rotors[0].axis) == pytest.approx(1)
    assert rotors[0].axis[2] < 0.99


def test_a_third_partys_thrust_lifts_as_described(own):
    simulation = own(spawn=(0, 0, 5))
    state = simulation.state.copy()
    state.rotor_velocity[:] = [20, -30, 40, -50]
    simulation.set_state(state)
    speeds = [80, 120, 160, 200]
    expected = sum(r.thrust_coefficient * w**2 * r.axis for r, w in zip(simulation.rotors, speeds))
    assert wrenches(simulation)["own_thrust"][:3] == pytest.approx(expected, rel=1e-9)


def test_a_joint_that_nothing_drives_has_no_command_index(hangar):
    (rotor,) = hangar(vehicle(CROSS[:1]), engine="eigen").rotors
    assert rotor.command_index is None
    assert (rotor.spin, rotor.thrust_coefficient, rotor.torque_coefficient) == (0, 0, 0)
    assert (rotor.torque_sense, rotor.slowdown, rotor.max_speed) == (0, 1, np.inf)
    assert np.isnan(rotor.time_constant)


def test_joint_friction_is_part_of_the_rate_per_command_and_not_of_the_slowdown(hangar):
    rotors = [rotor._replace(damping=1e-4) for rotor in CROSS]
    tags = {"rotorThrustCoeff": 1e-5, "rotorTorqueCoeff": 2e-7, "inducedDragCoeff": 0}
    urdf = vehicle(rotors, air={**tags, "sim_slow": 8}, motor={"kp": 4e-4, "sim_slow": 8})
    for rotor in hangar(urdf, G, engine="eigen").rotors:
        assert rotor.slowdown == 8
        assert rotor.rate_per_command == pytest.approx(0.8 / 8)
        assert rotor.thrust_coefficient == pytest.approx(1e-5)
        assert rotor.time_constant == pytest.approx(2.8125e-5 / 5e-4)


def slowdown_one(model):
    """Parameters that let the joints of a RotorS vehicle turn as fast as its rotors."""
    plugins = qc.Simulation(model, engine="eigen").plugins
    motors = [p.name for p in plugins if p.filename == "librotors_gazebo_motor_model.so"]
    return {f"{motor}.rotorVelocitySlowdownSim": 1 for motor in motors}


def evaluate_circle(model, controller="geometric", **options):
    given = {"engines": "eigen", "duration": 6.0, **options}
    (row,) = qc.evaluate(controller, "circle", models=model, **given).table
    return row


@pytest.mark.parametrize("model", ROTORS)
def test_effort_and_energy_are_those_of_the_same_vehicle_whose_joints_are_not_slowed(model):
    slowed = evaluate_circle(model)
    whole = evaluate_circle(model, parameters=slowdown_one(model))
    assert slowed["effort"] == pytest.approx(whole["effort"], rel=0.02)
    assert slowed["energy"] == pytest.approx(whole["energy"], rel=0.001)


@pytest.mark.parametrize("model", ["firefly", "hexarotor"])
def test_energy_is_the_torque_on_the_frame_times_the_speed_of_the_rotors(model):
    """Of one rotor after the other, which turns alone while the vehicle stands still."""
    simulation = qc.Simulation(model, engine="eigen", spawn=(0, 0, 10))
    for i, rotor in enumerate(simulation.rotors):
        state = simulation.state.copy()
        state.rotor_velocity[:] = 0
        state.rotor_velocity[i] = 37 * rotor.spin
        simulation.set_state(state)
        torque = wrenches(simulation)["reaction"][5]
        power = abs(torque) * 37 * rotor.slowdown
        assert power == pytest.approx(
            rotor.torque_coefficient * (37 * rotor.slowdown) ** 3, rel=1e-9
        )
        assert np.sign(torque) == rotor.torque_sense * rotor.spin


class TooFast:
    """A controller that asks every tenth time for more than any motor can do."""

    def __init__(self):
        self.calls = 0

    def reset(self, simulation):
        self.hover = simulation.hover_speed

    def __call__(self, t, state, reference):
        self.calls += 1
        return np.sign(self.hover) * 5000 if self.calls % 10 == 0 else self.hover


@pytest.mark.parametrize("model", MODELS)
def test_a_command_of_5000_rad_s_counts_as_saturated(model):
    row = evaluate_circle(model, TooFast(), duration=0.4)
    assert row["failure"] == ""
    assert row["saturated"] == pytest.approx(0.1)


def test_each_rotor_saturates_at_the_limit_of_its_own_motor():
    parameters = {"motor_0.maxRotVelocity": 400}
    saturated = []
    for first in (399, 401):
        pilot = qc.Simulation("firefly", engine="eigen", parameters=parameters, spawn=(0, 0, 10))
        command = np.full(6, 700.0)
        command[0] = first

        def controller(t, state, reference, command=command):
            return command

        plan = {"parameters": parameters, "duration": 0.1, "spawn": (0, 0, 10)}
        saturated.append(evaluate_circle("firefly", controller, **plan)["saturated"])
        assert [r.max_speed for r in pilot.rotors].count(400) == 1
    assert saturated == [0, 1]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["rotors", "vehicle"])
def test_a_description_in_wind_does_not_change_the_next_step(engine, name):
    """Plugins feel the wind from the first step on, although the probes have still air."""
    plan = qc.FlightPlan.of(engine=engine, wind=(3, 1, 0), controller="pid", reference="hover")
    probed, other = plan.simulation(), plan.simulation()
    getattr(probed, name)
    for sim in (probed, other):
        sim.step(20)
    assert probed.warnings == other.warnings
    assert any(warning.startswith("t = 0.000000 s") for warning in other.warnings)
    np.testing.assert_array_equal(probed.state.position, other.state.position)
