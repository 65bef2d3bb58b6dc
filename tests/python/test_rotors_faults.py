"""What faults do to RotorS' motors, and how their rotors turn along with the frame."""

from __future__ import annotations

import numpy as np
import pytest
from fitted import HOVER, firefly_with

import quadcore as qc

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

ENGINES = [name for name, _ in qc.engines()]
DOWN = 0.025  # s, time constant of a rotor that slows down
NOTHING = ("motorConstant", "rotorDragCoefficient", "rollingMomentCoefficient")


def fault(**tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    opening = '<gazebo><plugin name="fault" filename="libfault_plugin.so">'
    return f"{opening}{inner}</plugin></gazebo>"


def fly_hover(simulation, seconds=0.3):
    return simulation.run(seconds, commands=np.array([[0, *[HOVER] * 6]]))


@pytest.mark.parametrize("engine", ENGINES)
def test_rotors_without_lift_let_the_vehicle_fall(engine, tmp_path):
    all_lost = " ".join(f"0 {rotor} 0" for rotor in range(1, 7))
    simulation = firefly_with(tmp_path, fault(losses=all_lost), engine=engine)
    log = fly_hover(simulation)
    fallen = -0.5 * 9.8 * log.time * (log.time + (0 if engine == "eigen" else simulation.dt))
    np.testing.assert_allclose(log.position[:, 2] - 10, fallen, rtol=0, atol=2e-3)
    assert np.abs(log.rotor_velocity[-1]).min() > 50  # they turn all the same


@pytest.mark.parametrize("engine", ENGINES)
def test_a_share_of_the_lift_is_a_share_of_the_wrench(engine, tmp_path):
    whole = fly_hover(firefly_with(tmp_path, fault(losses="9 1 0.5"), engine=engine), 0.01)
    half = firefly_with(tmp_path, fault(losses="0 1 0.5"), engine=engine)
    half = half.run(0.01, commands=np.array([[0, *[HOVER] * 6]]), wrenches=True)
    whole_again = firefly_with(tmp_path, fault(losses="9 1 0.5"), engine=engine)
    whole_again = whole_again.run(0.01, commands=np.array([[0, *[HOVER] * 6]]), wrenches=True)
    np.testing.assert_array_equal(whole.table, whole_again.table)
    ratio = half.wrenches["thrust"][2:, 2] / whole_again.wrenches["thrust"][2:, 2]
    np.testing.assert_allclose(ratio, 5.5 / 6, rtol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_motor_that_is_cut_slows_down_with_its_own_lag(engine, tmp_path):
    log = fly_hover(firefly_with(tmp_path, fault(cuts="0.2 2"), engine=engine))
    before = np.searchsorted(log.time, 0.2 - 1e-9)
    since = log.time[before:] - log.time[before]
    slowing = log.rotor_velocity[before, 1] * np.exp(-since / DOWN)
    # In ODE's engines the frame's turning shows in what a joint measures.
    near = 1e-9 if engine == "eigen" else 5e-3
    np.testing.assert_allclose(log.rotor_velocity[before:, 1], slowing, rtol=0, atol=near)
    assert abs(log.rotor_velocity[-1, 0]) > 50


def test_rotors_of_given_rates_turn_along_with_the_frame_in_ode_as_in_the_equations():
    """Without forces of the air: what the frame bears then is what turns the rotors with it."""
    given = {f"motor_{i}.{tag}": 0 for i in range(6) for tag in NOTHING}
    given.update({f"firefly/rotor_{i}.iyy": 1.2e-5 for i in range(6)})
    given.update({f"firefly/rotor_{i}.ixx": 1.2e-5 for i in range(6)})
    given.update({f"firefly/rotor_{i}.izz": 2.3e-5 for i in range(6)})
    ends = {}
    for engine, dt in (("eigen", 1e-3), ("ode", 1e-3), ("ode", 5e-4)):
        simulation = qc.Simulation(
            "firefly", engine=engine, dt=dt, parameters=given, xacro_args={"sensors": "false"}
        )
        state = simulation.state.copy()
        state.angular_velocity = [3, -2, 1]
        state.rotor_velocity = [80, -10, 30, 0, -50, 20]
        simulation.set_state(state)
        simulation.command([800, 100, 300, 0, 500, 200])
        simulation.step(round(0.2 / dt))
        ends[engine, dt] = simulation.state.angular_velocity.copy()
    errors = [np.abs(ends["ode", dt] - ends["eigen", 1e-3]).max() for dt in (1e-3, 5e-4)]
    assert errors[0] < 5e-3 and errors[0] / errors[1] > 1.8
