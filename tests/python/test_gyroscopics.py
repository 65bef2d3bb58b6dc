"""Free motion of spinning vehicles: what is right about it, and what is wrong in Gazebo 11."""

from __future__ import annotations

import numpy as np
import pytest
from gyrostat import Gyrostat, angle_between
from scipy.spatial.transform import Rotation
from vehicles import CROSS, MOTOR, ODD, ROUND, SKEW, Rotor, start, vehicle

HOVER = np.sqrt(1.04 * 9.8 / 4 / 1.1487e-5)  # 471 rad/s
STEPS = (1e-3, 5e-4, 2.5e-4, 1.25e-4)

# Balanced spin hides a wrong gyroscopic torque; unbalanced spin shows it.
spinning = pytest.mark.parametrize(
    ("rotors", "inertia", "com", "spin"),
    [
        pytest.param(CROSS, ROUND, (0, 0, 0), HOVER * np.array([1, -1, 1, -1]), id="balanced"),
        pytest.param(CROSS, ROUND, (0, 0, 0), HOVER * np.ones(4), id="unbalanced"),
        pytest.param(
            ODD, SKEW, (0.01, -0.02, 0.015), HOVER * np.array([0.5, 1, -0.2, 0.7]), id="odd"
        ),
    ],
)


class FreeFlight:
    """Two seconds without any force, and how far they are from what must be."""

    def __init__(self, hangar, engine, dt, rotors, inertia, com, spin):
        simulation = hangar(vehicle(rotors, 1, inertia, com), engine=engine, dt=dt)
        start(simulation, angular_velocity=[0.3, -0.2, 0.5], rotor_velocity=spin)
        log = simulation.run(2, log_every=round(0.1 / dt))
        true = Gyrostat(rotors, 1, inertia, com)
        exact = true.fly(log.time, log.table[0, 1:])
        self.angle = np.degrees(angle_between(log.orientation, exact[:, 3:7]).max())

        rates = list(zip(log.angular_velocity, log.rotor_velocity))
        momentum = Rotation.from_quat(log.orientation).apply([true.momentum(*r) for r in rates])
        whole = np.abs(true.moments * spin).sum()
        self.momentum = np.linalg.norm(momentum - momentum[0], axis=1).max() / whole
        energy = np.array([true.energy(*r) for r in rates])
        self.energy = np.abs(energy / energy[0] - 1).max()

        turned = Rotation.from_quat(log.orientation)
        center = log.position + turned.apply(true.center)
        speed = log.linear_velocity + turned.apply(np.cross(log.angular_velocity, true.center))
        self.drift = np.abs(center - center[0] - np.outer(log.time, speed[0])).max()


@spinning
def test_ode_converges_at_first_order_to_the_reference(hangar, rotors, inertia, com, spin):
    flights = [FreeFlight(hangar, "ode", dt, rotors, inertia, com, spin) for dt in STEPS]
    assert flights[0].angle < 0.3
    assert flights[0].momentum < 1e-3
    assert flights[0].energy < 2e-6
    for coarse, fine in zip(flights, flights[1:]):
        assert fine.angle < coarse.angle / 1.9
        assert fine.momentum < coarse.momentum / 1.9
        assert fine.energy < coarse.energy
        assert fine.drift < 1e-6


@spinning
def test_eigen_agrees_with_the_reference(hangar, rotors, inertia, com, spin):
    flight = FreeFlight(hangar, "eigen", 1e-3, rotors, inertia, com, spin)
    assert flight.angle < 1e-8
    assert flight.momentum < 1e-12
    assert flight.energy < 1e-13
    assert flight.drift < 1e-13


@spinning
def test_gazebo_does_not(hangar, rotors, inertia, com, spin):
    flight = FreeFlight(hangar, "gazebo11", 1e-3, rotors, inertia, com, spin)
    assert flight.angle > 2
    assert flight.momentum > 5e-3
    assert flight.energy > 3e-5


def pitch_decay(hangar, engine, sim_slow, dt=1e-3, rotors=CROSS):
    """Decay of a small pitch rate, 1/s, with the rotors held at hover speed and no other force."""
    spin = HOVER / sim_slow * np.array([1, -1, 1, -1])
    simulation = hangar(vehicle(rotors, motor=MOTOR), engine=engine, dt=dt)
    start(simulation, angular_velocity=[0, 0.01, 0], rotor_velocity=spin)
    simulation.command(spin)
    log = simulation.run(1)
    assert np.abs(log.angular_velocity[:, ::2]).max() < 1e-12
    return -np.polyfit(log.time, np.log(log.angular_velocity[:, 1]), 1)[0]


@pytest.mark.parametrize("engine", ["ode", "eigen"])
def test_pitching_goes_on(hangar, engine):
    assert abs(pitch_decay(hangar, engine, sim_slow=1)) < 0.01


@pytest.mark.parametrize(
    ("sim_slow", "recorded"), [(1, 0.812), (8, 0.0128), (10, 0.0082), (18, 0.0025)]
)
def test_gazebo_damps_pitching_as_recorded(hangar, sim_slow, recorded):
    decay = pitch_decay(hangar, "gazebo11", sim_slow)
    assert decay == pytest.approx(recorded, rel=0.015, abs=5e-5)  # to the digits given
    at_full_speed = pitch_decay(hangar, "gazebo11", 1)
    assert decay == pytest.approx(at_full_speed / sim_slow**2, rel=0.01)


@pytest.mark.parametrize("sim_slow", [1, 2])
@pytest.mark.parametrize("dt", [5e-4, 1e-3])
def test_gazebos_damping_is_that_of_an_explicit_torque_on_four_propellers(hangar, sim_slow, dt):
    Ixx, _, Izz = CROSS[0].inertia
    W = HOVER / sim_slow
    Jx = Gyrostat(CROSS, 1, ROUND).inertia[0, 0]
    assert Jx == pytest.approx(0.00769, rel=1e-3)
    expected = 4 * (Izz - Ixx) * W**2 * dt / (2 * Jx)
    assert pitch_decay(hangar, "gazebo11", sim_slow, dt) == pytest.approx(expected, rel=0.01)


def test_gazebos_damping_drives_where_propellers_are_long_rather_than_flat(hangar):
    Ixx, Izz = 2e-5, 1e-5
    rotors = [rotor._replace(inertia=(Ixx, Ixx, Izz)) for rotor in CROSS]
    Jx = Gyrostat(rotors, 1, ROUND).inertia[0, 0]
    expected = 4 * (Izz - Ixx) * HOVER**2 * 1e-3 / (2 * Jx)
    assert expected == pytest.approx(-0.5751, abs=5e-5)
    decay = pitch_decay(hangar, "gazebo11", 1, rotors=rotors)
    assert decay == pytest.approx(expected, rel=0.02)
    assert abs(pitch_decay(hangar, "ode", 1, rotors=rotors)) < 0.01


class Tumbling:
    """Ten seconds of tumbling, the rotors still at first: energy and momentum over the first."""

    def __init__(self, hangar, engine, rate, inertia=ROUND, way=(0.02, 0.3, 1)):
        simulation = hangar(vehicle(inertia=inertia), engine=engine)
        w = rate * np.array(way) / np.linalg.norm(way)
        log = start(simulation, angular_velocity=w).run(10, log_every=10)
        rates = list(zip(log.angular_velocity, log.rotor_velocity))
        true = Gyrostat(CROSS, 1, inertia)
        energy = np.array([true.energy(*r) for r in rates])
        momentum = np.array([np.linalg.norm(true.momentum(*r)) for r in rates])
        self.energy = energy / energy[0]
        self.momentum = momentum / momentum[0]


@pytest.mark.parametrize(
    ("rate", "energy", "momentum"), [(10.4, 0.002, 0.002), (20.9, 0.01, 0.005), (52, 0.15, 0.1)]
)
@pytest.mark.parametrize("inertia", [ROUND, (0.01, 0.014, 0.02, 0, 0, 0)], ids=["round", "three"])
@pytest.mark.parametrize("way", [(0.02, 0.3, 1), (1, 0.5, 0.3)])
def test_tumbling_makes_no_energy_in_ode(hangar, rate, energy, momentum, inertia, way):
    tumbling = Tumbling(hangar, "ode", rate, inertia, way)
    assert tumbling.energy.min() > 1 - energy
    assert tumbling.momentum.min() > 1 - momentum
    assert tumbling.energy.max() < 1 + 1e-9
    assert tumbling.momentum.max() < 1 + 1e-3


def test_tumbling_makes_energy_in_gazebo(hangar):
    assert Tumbling(hangar, "gazebo11", 20.9).energy.max() == pytest.approx(2.30, abs=0.05)
    assert Tumbling(hangar, "gazebo11", 52).energy.max() > 5


@pytest.mark.parametrize("engine", ["ode", "gazebo11"])
def test_a_two_bladed_rotor_turns_under_its_own_gyroscopic_torque(hangar, engine):
    """On a frame too heavy to answer, Euler: Izz dW/dt = (Ixx - Iyy) wx wy, along the axis."""
    blades = Rotor((0.1, 0.05, 0.02), inertia=(4e-6, 6e-5, 6.3e-5))
    heavy = (1e4, 1e4, 1e4, 0, 0, 0)
    simulation = hangar(vehicle([blades], 1e4, heavy), engine=engine, dt=1e-4)
    start(simulation, angular_velocity=[3, 2, 0.5])
    simulation.step(10)
    Ixx, Iyy, Izz = blades.inertia
    expected = (Ixx - Iyy) / Izz * 3 * 2 * 1e-3
    assert simulation.state.rotor_velocity[0] == pytest.approx(expected, rel=5e-3)
