"""Whole flights against invariants, closed forms, and the tests' own integrator."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gyrostat import Gyrostat, angle_between
from scipy.spatial.transform import Rotation
from vehicles import AIR, DRAG, FLAPPING, MOTOR, ODD, SKEW, start, vehicle

import quadcore as qc

ENGINES = [name for name, _ in qc.engines()]
GRAVITY = (0, 0, -9.8)
CHAPTER2 = {**AIR, **DRAG, "dragModel": "chapter2"}
FLAPPER = {**CHAPTER2, **FLAPPING}
HOVER = np.sqrt(1.04 * 9.8 / 4 / 1.1487e-5)
BALANCED = HOVER * np.array([1, -1, 1, -1])
# Up, with a doublet that rolls and pitches.
DOUBLET = np.column_stack(
    [
        [0, 0.3, 0.5, 0.7],
        1.02 * BALANCED * [[1, 1, 1, 1], [0.98, 1, 1.02, 1], [1.02, 0.99, 0.98, 1.01], [1] * 4],
    ]
)


def start_hovering(simulation, **members):
    return start(simulation, rotor_velocity=BALANCED, **members)


@pytest.mark.parametrize("engine", ENGINES)
def test_thrust_at_hover_speed_carries_the_weight(hangar, engine):
    simulation = hangar(vehicle(air=CHAPTER2, motor=MOTOR), GRAVITY, engine=engine)
    start_hovering(simulation).command(BALANCED)
    log = simulation.run(2, wrenches=True)
    assert log.wrenches["thrust"][0, 2] == pytest.approx(9.8 * simulation.mass, rel=1e-14)
    assert np.abs(log.position).max() < 1e-11
    assert angle_between(log.orientation[-1:], [[0, 0, 0, 1]]) < 1e-11


def chapter2(wind, targets):
    """Load for the reference: thrust, reaction, drag and motors of the thesis' chapter 2."""
    k, b = AIR["rotorThrustCoeff"], AIR["rotorTorqueCoeff"]
    in_disc = sum(DRAG[name + "DragCoeff"] for name in ("induced", "translational", "profile"))

    def load(vehicle, v, w, spin, attitude):
        air = attitude.inv().apply(v - wind)
        speed = air + np.cross(w, vehicle.arms)
        across = speed - np.sum(speed * vehicle.axes, axis=1)[:, None] * vehicle.axes
        forces = (k * spin**2)[:, None] * vehicle.axes - in_disc * across
        parasitic = -DRAG["parasiticDragCoeff"] * np.linalg.norm(air) * air
        motors = MOTOR["kp"] * (targets - spin)
        reaction = (b * np.abs(spin) * spin) @ vehicle.axes
        torque = np.cross(vehicle.arms, forces).sum(axis=0) + reaction
        return forces.sum(axis=0) + parasitic, torque, motors

    return load


def reference(log, true, wind):
    """The flight of the doublet, piece by piece between its commands."""
    rows = [log.table[:1, 1:]]
    edges = [*DOUBLET[:, 0], log.time[-1]]
    for begin, end, targets in zip(edges, edges[1:], DOUBLET[:, 1:]):
        times = log.time[(log.time >= begin - 1e-9) & (log.time <= end + 1e-9)]
        rows.append(true.fly(times, rows[-1][-1], chapter2(wind, targets), GRAVITY)[1:])
    return np.vstack(rows)


WIND = np.array([2.0, -1.0, 0.5])
COM = (0.004, -0.003, 0.005)


def errors(hangar, engine, dt):
    """Distance (m) and angle (rad) from the reference: all of chapter 2, wind, no symmetry."""
    simulation = hangar(
        vehicle(ODD, 1, SKEW, COM, CHAPTER2, MOTOR), GRAVITY, WIND, engine=engine, dt=dt
    )
    start_hovering(simulation, linear_velocity=[1, 2, -1], angular_velocity=[0.2, -0.1, 0.3])
    log = simulation.run(1, DOUBLET, log_every=round(0.05 / dt))
    exact = reference(log, Gyrostat(ODD, 1, SKEW, COM), WIND)
    apart = np.linalg.norm(log.position - exact[:, :3], axis=1)
    return np.array([apart.max(), angle_between(log.orientation, exact[:, 3:7]).max()])


def test_a_flight_of_ode_converges_at_first_order_to_the_reference(hangar):
    coarse, middle, fine = (errors(hangar, "ode", dt) for dt in (1e-3, 5e-4, 2.5e-4))
    assert (coarse < [0.01, 0.15]).all()
    assert (middle < coarse / 1.9).all()
    assert (fine < middle / 1.9).all()


def test_a_flight_of_eigen_agrees_with_the_reference(hangar):
    assert (errors(hangar, "eigen", 1e-3) < 1e-9).all()


def test_a_flight_of_gazebo_stays_off_the_reference(hangar):
    assert (errors(hangar, "gazebo11", 2.5e-4) > [0.05, 0.5]).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flight_in_wind_is_one_in_still_air_seen_from_it(hangar, engine):
    wind = np.array([3.0, -2.0, 1.0])
    urdf = vehicle(air=FLAPPER, motor=MOTOR)
    still = start_hovering(hangar(urdf, GRAVITY, engine=engine))
    windy = start_hovering(hangar(urdf, GRAVITY, wind, engine=engine), linear_velocity=wind)
    rest, carried = still.run(2, DOUBLET), windy.run(2, DOUBLET)
    drift = np.outer(rest.time, wind)
    assert np.linalg.norm(rest.position[-1]) > 0.1
    assert np.abs(carried.position - drift - rest.position).max() < 1e-9


MIRROR = np.array([1, -1, 1])


@pytest.mark.parametrize("model", ["appendix", "chapter2"])
@pytest.mark.parametrize("engine", ENGINES)
def test_mirrored_commands_fly_a_mirrored_flight(hangar, engine, model):
    urdf = vehicle(air={**FLAPPER, "dragModel": model}, motor=MOTOR)
    swap = [0, 3, 2, 1]
    straight = start_hovering(hangar(urdf, GRAVITY, engine=engine), linear_velocity=[1, 2, 3])
    mirrored = start(
        hangar(urdf, GRAVITY, engine=engine),
        rotor_velocity=-BALANCED[swap],
        linear_velocity=[1, -2, 3],
    )
    commands = DOUBLET.copy()
    commands[:, 1:] = -commands[:, 1:][:, swap]
    a, b = straight.run(2, DOUBLET), mirrored.run(2, commands)
    assert np.ptp(a.position[:, 1]) > 0.1
    assert np.abs(b.position - a.position * MIRROR).max() < 1e-9
    assert np.abs(b.angular_velocity + a.angular_velocity * MIRROR).max() < 1e-8
    assert np.abs(b.rotor_velocity + a.rotor_velocity[:, swap]).max() < 1e-7


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flight_does_not_depend_on_its_heading(hangar, engine):
    wind = np.array([2.0, 1.0, 0.0])
    urdf = vehicle(ODD, 1, SKEW, COM, FLAPPER, MOTOR)
    flights = []
    for heading in (0, 1, 2.5):
        turn = Rotation.from_euler("z", heading)
        simulation = hangar(
            urdf, GRAVITY, turn.apply(wind), engine=engine, spawn=(0, 0, 0, 0, 0, heading)
        )
        start_hovering(simulation, linear_velocity=turn.apply([1, 2, 3]))
        log = simulation.run(2, DOUBLET)
        attitude = turn.inv() * Rotation.from_quat(log.orientation)
        flights.append((turn.inv().apply(log.position), attitude.as_quat()))
    for position, orientation in flights[1:]:
        assert np.abs(position - flights[0][0]).max() < 1e-9
        assert angle_between(orientation, flights[0][1]).max() < 1e-9


@pytest.mark.parametrize("model", ["appendix", "chapter2"])
@pytest.mark.parametrize(("engine", "exact"), [("gazebo11", 0.05), ("ode", 0.01), ("eigen", 1e-5)])
def test_the_logged_wrenches_sum_to_the_motion_that_is_seen(hangar, engine, exact, model):
    urdf = vehicle(ODD, 1, SKEW, COM, {**FLAPPER, "dragModel": model}, MOTOR)
    simulation = hangar(urdf, GRAVITY, WIND, engine=engine, dt=1e-4)
    start_hovering(simulation, linear_velocity=[1, 2, -1], angular_velocity=[0.2, -0.1, 0.3])
    log = simulation.run(0.5, DOUBLET, wrenches=True)
    true = Gyrostat(ODD, 1, SKEW, COM)

    turn = Rotation.from_quat(log.orientation)
    wrench = sum(log.wrenches.values())
    force = turn.apply(wrench[:, :3]) + true.mass * np.array(GRAVITY)
    torque = turn.apply(wrench[:, 3:])
    swing = turn.apply(np.cross(log.angular_velocity, true.center))
    momentum = true.mass * (log.linear_velocity + swing)
    rates = zip(log.angular_velocity, log.rotor_velocity)
    spin = turn.apply([true.momentum(w, W) for w, W in rates])

    def measure(quantity):
        if engine == "eigen":  # central differences where the command does not change
            smooth = np.abs(DOUBLET[:, :1] - log.time).min(axis=0) > 1.5e-4
            rows = np.flatnonzero(smooth[1:-1]) + 1
            return rows, (quantity[rows + 1] - quantity[rows - 1]) / 2e-4
        rows = np.arange(5000)  # ODE holds the force of the row for the step that begins there
        return rows, np.diff(quantity, axis=0) / 1e-4

    rows, force_seen = measure(momentum)
    assert np.abs(force_seen - force[rows]).max() < 1e-5 * np.abs(force).max()
    rows, torque_seen = measure(spin)
    assert np.abs(torque_seen - torque[rows]).max() < exact * np.abs(torque).max()


DATA = Path(__file__).resolve().parents[1] / "data" / "gazebo11"


@pytest.mark.parametrize(("sim_slow", "metres"), [(1, 65), (8, 3.1), (18, 0.63)])
def test_gazebo_is_as_far_off_as_was_measured(sim_slow, metres):
    """S3 without drag, 10 s; slowing the rotors shrinks the fault and costs little by itself."""
    options = {
        "xacro_args": {"sim_slow": sim_slow},
        "parameters": {f"drone_plugin.{drag}": 0 for drag in DRAG},
    }

    def end(engine, **changed):
        simulation = qc.Simulation("quadrotor", engine=engine, **{**options, **changed})
        return simulation.run(10, DATA / "commands_S3.csv").position[-1]

    assert np.linalg.norm(end("gazebo11") - end("eigen")) == pytest.approx(metres, rel=0.05)
    at_full_speed = end("eigen", xacro_args={"sim_slow": 1})
    assert np.linalg.norm(end("eigen") - at_full_speed) < 0.006
