"""What a command does to the motors, and when."""

from __future__ import annotations

import numpy as np
from flights import HOVER, bits, quadrotor


def test_a_command_holds_from_the_first_step_that_begins_at_its_time():
    def speeds(time):
        table = [[0, 100, 100, 100, 100], [time, 200, 200, 200, 200]]
        return quadrotor().run(0.02, table).rotor_velocity[:, 0]

    on_time = speeds(0.010)
    assert np.array_equal(speeds(0.010 + 0.9e-9), on_time)
    late = speeds(0.010 + 2e-9)
    assert np.array_equal(late, speeds(0.011))
    # The step that starts at row 10 is the first to feel it, and row 11 the first to show it.
    assert np.array_equal(on_time[:11], late[:11])
    assert on_time[11] > late[11]


def test_motors_are_free_until_the_first_command():
    simulation = quadrotor()
    state = simulation.state.copy()
    state.rotor_velocity[:] = 47.1, -47.1, 47.1, -47.1
    simulation.set_state(state)
    log = simulation.run(0.02, [[0.010, 0, 0, 0, 0]])
    assert np.allclose(log.rotor_velocity[:11], state.rotor_velocity, rtol=0, atol=1e-6)
    assert np.abs(log.rotor_velocity[11:]).max() < 46.5


def test_a_run_without_commands_keeps_the_present_one():
    simulation, commanded = quadrotor(), quadrotor()
    simulation.command(HOVER)
    table = simulation.run(0.1).table
    assert np.array_equal(table, commanded.run(0.1, [[0, *HOVER]]).table)


def test_a_command_that_is_too_old_counts_as_zero():
    silent = quadrotor(parameters={"motorpid_plugin.commandTimeout": 0.05})
    stopped = quadrotor()
    for simulation in (silent, stopped):
        simulation.command(HOVER)
    silent.step(200)
    stopped.step(51)  # the command is 50 ms old, but no older, when step 51 starts
    stopped.command([0, 0, 0, 0])
    stopped.step(149)
    assert bits(silent) == bits(stopped)


def test_a_command_saturates_at_the_fastest_speed():
    limited = quadrotor(parameters={"motorpid_plugin.maxVelocity": 450})
    free = quadrotor()
    limited.command([471, -900, 450, -300])
    free.command([450, -450, 450, -300])
    for simulation in (limited, free):
        simulation.step(100)
    assert bits(limited) == bits(free)


def test_rotor_joints_are_commanded_in_the_order_of_the_tag():
    turned = quadrotor(parameters={"motorpid_plugin.rotorJoints": "rotor3 rotor1 rotor4 rotor2"})
    plain = quadrotor()
    turned.command([103, 101, 104, 102])
    plain.command([101, 102, 103, 104])
    for simulation in (turned, plain):
        simulation.step(10)
    assert turned.rotor_names == ["rotor1", "rotor2", "rotor3", "rotor4"]
    assert bits(turned) == bits(plain)


def test_some_of_the_rotors_may_be_driven():
    simulation = quadrotor(parameters={"motorpid_plugin.rotorJoints": ["rotor2"]})
    simulation.command([100])
    simulation.step(10)
    assert np.flatnonzero(np.abs(simulation.state.rotor_velocity) > 1).tolist() == [1]
