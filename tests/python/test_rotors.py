"""RotorS' motors."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from faults import refusal

import quadcore as qc

# Firefly, iris and ardrone have an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

ENGINES = [name for name, _ in qc.engines()]
DATA = Path(__file__).resolve().parents[1] / "data"
BARE = {"sensors": "false"}
HOVER = 540.6748120114936  # rad/s, of the bare firefly
SENSES = np.array([1, -1, 1, -1, 1, -1])  # of its rotors
SLOWDOWN = 10
UP, DOWN = 0.0125, 0.025  # s

# One after the other and by sines, each row on the grid of steps of 10 ms.
ROWS = np.arange(0, 3, 0.01)
SINES = np.column_stack(
    [ROWS, *(np.float32(HOVER + 8 * np.sin((2 + 0.7 * i) * ROWS + i)) for i in range(6))]
)


def firefly(engine="gazebo11", arguments=BARE, spawn=(0, 0, 10), **options):
    return qc.Simulation("firefly", engine=engine, xacro_args=arguments, spawn=spawn, **options)


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def edited(tmp_path):
    """A maker of fireflies whose document was edited."""
    document = qc.read_model("firefly", BARE).document.text

    def make(*edits, engine="gazebo11", **options):
        text = document
        for old, new in edits:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "edited.urdf"
        path.write_text(text)
        return qc.Simulation(path, engine=engine, spawn=(0, 0, 10), **options)

    return make


@pytest.mark.parametrize("engine", ENGINES)
def test_a_speed_follows_its_command_with_a_lag_that_differs_upwards_and_downwards(engine):
    simulation = firefly(engine)
    commands = np.array([[0, *[600] * 6], [0.05, *[400] * 6]])
    log = simulation.run(0.1, commands=commands)
    up = 600 * (1 - np.exp(-log.time / UP))
    down = 400 + (up[50] - 400) * np.exp(-(log.time - 0.05) / DOWN)
    expected = np.where(log.time <= 0.05, up, down)[:, None] * SENSES / SLOWDOWN
    assert np.allclose(log.rotor_velocity, expected, rtol=0, atol=1e-9)


def test_a_command_carries_single_precision_and_is_followed_up_to_the_limit():
    simulation = firefly("eigen")
    simulation.command([1000, 540.123456789, 838, 0, 1, 2])
    simulation.step(1000)
    wanted = [838, np.float32(540.123456789), 838, 0, 1, 2] * SENSES / SLOWDOWN
    assert np.allclose(simulation.state.rotor_velocity, wanted, rtol=1e-12, atol=1e-9)


def test_commands_come_in_the_order_of_the_motors_numbers(edited):
    number = "<motorNumber>{}</motorNumber>"
    swapped = edited(
        (number.format(0), number.format("x")),
        (number.format(3), number.format(0)),
        (number.format("x"), number.format(3)),
    )
    order = [3, 1, 2, 0, 4, 5]
    log = swapped.run(1, commands=SINES[:, [0, *(1 + np.array(order))]])
    assert np.array_equal(log.position, edited().run(1, commands=SINES).position)


def test_a_speed_that_is_set_is_what_the_motor_goes_on_from():
    simulation = firefly()
    simulation.command([HOVER] * 6)
    state = simulation.state.copy()
    state.rotor_velocity = HOVER * SENSES / SLOWDOWN
    simulation.set_state(state)
    simulation.step(100)
    wanted = np.float32(HOVER) * SENSES / SLOWDOWN
    assert np.allclose(simulation.state.rotor_velocity, wanted, rtol=0, atol=1e-5)
    assert abs(simulation.state.position[2] - 10) < 1e-6


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flight_from_a_snapshot_goes_on_as_it_did(engine):
    simulation = qc.Simulation("firefly", engine=engine, spawn=(0, 0, 10))
    simulation.command([HOVER + 3] * 6)
    simulation.step(57)
    taken = simulation.snapshot()
    simulation.command([HOVER - 20, *[HOVER] * 5])
    simulation.step(100)
    place, imu = simulation.state.position.copy(), simulation.topic("imu")
    simulation.restore(taken)
    simulation.command([HOVER - 20, *[HOVER] * 5])
    simulation.step(100)
    assert np.array_equal(simulation.state.position, place)
    assert simulation.topic("imu") == imu


# Nothing but the motors acts.
FREE = {
    f"motor_{i}.{tag}": 0
    for i in range(6)
    for tag in ("motorConstant", "rotorDragCoefficient", "rollingMomentCoefficient")
}
WEIGHTLESS = '<sdf version="1.6"><world name="w"><gravity>0 0 0</gravity></world></sdf>'


@pytest.mark.parametrize("engine", ENGINES)
def test_the_frame_bears_the_reaction_of_spin_up_only_with_the_tag(engine, tmp_path):
    world = tmp_path / "weightless.world"
    world.write_text(WEIGHTLESS)
    turned = {}
    for reaction in ("false", "true"):
        simulation = firefly(engine, {**BARE, "reaction": reaction}, world=world, parameters=FREE)
        simulation.command([800, 0, 300, 0, 0, 0])
        simulation.step(500)
        turned[reaction] = simulation.state.angular_velocity
    blade = 0.0833333 * 0.005 * SLOWDOWN * (0.1**2 + 0.015**2)
    momentum = blade * 1100 / SLOWDOWN
    # The blades' own turning with the frame is momentum, too.
    expected = -momentum / simulation.inertia[2, 2]
    assert np.abs(turned["false"]).max() < 1e-9
    assert turned["true"][2] == pytest.approx(expected, rel=1e-6 if engine == "eigen" else 1e-3)


def spinning(engine, dt):
    """A firefly whose rotors turn as in a hover."""
    simulation = firefly(engine, dt=dt)
    state = simulation.state.copy()
    state.rotor_velocity = HOVER * SENSES / SLOWDOWN
    simulation.set_state(state)
    return simulation


def test_in_eigen_flights_converge_with_the_fourth_order_of_the_step():
    def place(dt):
        return spinning("eigen", dt).run(2, commands=SINES, log_every=10).position[-1]

    limit = place(0.000625)
    error = [np.linalg.norm(place(dt) - limit) for dt in (0.01, 0.005, 0.0025)]
    assert all(12 < coarse / fine < 25 for coarse, fine in zip(error, error[1:])), error


def test_eigen_is_what_rotors_approaches_with_small_steps_and_far_nearer_at_its_own():
    recorded = DATA / "rotors" / "F3_firefly_multisine" / "commands.csv.gz"
    commands = np.loadtxt(recorded, delimiter=",", skiprows=1)

    def place(engine, dt):
        return firefly(engine, dt=dt).run(10, commands=commands, log_every=100).position[-1]

    limit = place("eigen", 0.001)
    gazebo = [np.linalg.norm(place("gazebo11", dt) - limit) for dt in (0.01, 0.002, 0.001)]
    assert gazebo[0] > 30
    assert 1.5 < gazebo[1] / gazebo[2] < 4  # of first order
    assert np.linalg.norm(place("eigen", 0.01) - limit) < gazebo[0] / 1000


def test_eigen_averages_blades_over_their_turns_and_says_so(edited):
    simulation = firefly("eigen")
    (said,) = [w for w in simulation.warnings if "over a turn about the joint" in w]
    assert re.search(
        r"multirotor\.xacro:\d+: .*averages the inertia of firefly/rotor_0, .*rotor_5 ", said
    )
    moments = np.diag(simulation.model.links[1].inertia)
    assert moments[0] == moments[1]
    flown = np.diag(firefly("ode").model.links[1].inertia)
    assert moments == pytest.approx([flown[:2].mean(), flown[:2].mean(), flown[2]], rel=1e-12)


MOTOR_0 = '<plugin name="motor_0" filename="librotors_gazebo_motor_model.so">'
SECOND = "<jointName>firefly/rotor_1_joint</jointName>"
PID = '<plugin name="pid" filename="libmotorpid_plugin.so"><kp>1e-4</kp></plugin>'


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            SECOND + "<linkName>firefly/rotor_1</linkName>",
            "<jointName>firefly/rotor_0_joint</jointName><linkName>firefly/rotor_0</linkName>",
            (
                "'motor_1' drives joint 'firefly/rotor_0_joint', which 'motor_0' (",
                "Keep one of them",
            ),
        ),
        (
            SECOND + "<linkName>firefly/rotor_1</linkName>",
            "<motorType>position</motorType><jointName>firefly/rotor_0_joint</jointName>"
            "<linkName>firefly/rotor_0</linkName>",
            (
                "'motor_1' drives joint 'firefly/rotor_0_joint', which 'motor_0' (",
                "Keep one of them",
            ),
        ),
        (
            MOTOR_0,
            PID + MOTOR_0,
            (
                "'pid' drives joint 'firefly/rotor_0_joint', which 'motor_0' (",
                "Keep one of them",
            ),
        ),
        *(
            (
                MOTOR_0,
                PID + MOTOR_0 + f"<motorType>{kind}</motorType>",
                (
                    "'pid' drives joint 'firefly/rotor_0_joint', which 'motor_0' (",
                    "Keep one of them",
                ),
            )
            for kind in ("position", "force")
        ),
        (
            MOTOR_0,
            PID + PID.replace('"pid"', '"more"') + MOTOR_0,
            (
                "'motor_0' drives joint 'firefly/rotor_0_joint', which 'more' (",
                "Keep one of them",
            ),
        ),
        (SECOND, "", ("'motor_1': required tag <jointName> is missing", "Add <jointName>")),
        ("<motorConstant>", "<thrustConstant>", ("mismatched", "")),
        (
            "<turningDirection>ccw</turningDirection>",
            "<turningDirection>left</turningDirection>",
            ("<turningDirection> 'left' is not a valid value. Use ccw | cw",),
        ),
        (
            "<motorNumber>5</motorNumber>",
            "<motorNumber>6</motorNumber>",
            ("<motorNumber> 6 is not a valid motor number: the model has 6 motors,",),
        ),
        (
            "<linkName>firefly/rotor_2</linkName>",
            "<linkName>firefly/base_link</linkName>",
            ("'firefly/base_link' is not the child of joint", "Write firefly/rotor_2"),
        ),
        (
            "<motorConstant>8.54858e-06</motorConstant>",
            "<motorConstnt>8.54858e-06</motorConstnt>",
            ("unknown tag <motorConstnt>. Did you mean 'motorConstant'?",),
        ),
        (
            MOTOR_0,
            '<plugin name="jet" filename="librotors_gazebo_jet.so"/>' + MOTOR_0,
            ("librotors_gazebo_jet.so was not found", "--ignore librotors_gazebo_jet.so"),
        ),
    ],
    ids=[
        "two motors on a joint",
        "two motors of different kinds on a joint",
        "a motor and a PID",
        "a motor that holds an angle and a PID",
        "a motor that exerts a torque and a PID",
        "two PIDs and a motor",
        "no joint",
        "no XML",
        "no direction",
        "no number",
        "another link",
        "unknown tag",
        "foreign module",
    ],
)
def test_errors_in_a_motor_are_reported_with_their_line_and_a_remedy(old, new, says):
    flat = re.sub(r">\s+<", "><", qc.read_model("firefly", BARE).document.text)
    path = Path("edited.urdf")
    assert old in flat
    path.write_text(flat.replace(old, new, 1).replace("><", ">\n<"))
    message = refusal(qc.Simulation, path)
    assert re.match(r".*edited\.urdf:\d+: ", message)
    for part in says:
        assert part in message


KIND = "<turningDirection>ccw</turningDirection>"


def test_a_motor_may_exert_a_torque(edited):
    simulation = edited((KIND, KIND + "<motorType>force</motorType>"))
    simulation.command([1e-6, 0, 0, 0, 0, 0])
    simulation.step(100)
    moment = 0.0833333 * 0.005 * SLOWDOWN * (0.1**2 + 0.015**2)
    assert simulation.state.rotor_velocity[0] == pytest.approx(1e-6 / moment * 0.1, rel=1e-3)


def test_motors_of_one_number_follow_one_command_and_that_is_said(edited):
    simulation = edited(("<motorNumber>3<", "<motorNumber>0<"))
    (said,) = [w for w in simulation.warnings if "<motorNumber>" in w]
    assert "motors 'motor_0' and 'motor_3' have the same <motorNumber> 0 (" in said
    simulation.command([500, 0, 0, 0, 0, 0])
    simulation.step(200)
    assert list(abs(simulation.state.rotor_velocity) > 1) == [
        True,
        False,
        False,
        True,
        False,
        False,
    ]


def test_without_bounds_a_motor_holds_no_angle_as_in_gazebo_and_that_is_said(edited):
    gains = "<joint_control_pid><p>2e-3</p><d>4e-4</d></joint_control_pid>"
    simulation = edited((KIND, KIND + "<motorType>position</motorType>" + gains))
    (said,) = [w for w in simulation.warnings if "produces no torque" in w]
    assert "motor 'motor_0'" in said
    simulation.command([0.5, 0, 0, 0, 0, 0])
    simulation.step(100)
    assert abs(simulation.state.rotor_angle[0]) < 1e-12


def test_a_motor_may_hold_an_angle(edited):
    gains = "<joint_control_pid><p>2e-3</p><d>4e-4</d><cmdMax>-1</cmdMax></joint_control_pid>"
    simulation = edited((KIND, KIND + "<motorType>position</motorType>" + gains))
    simulation.command([0.5, 0, 0, 0, 0, 0])
    simulation.step(3000)
    assert simulation.state.rotor_angle[0] == pytest.approx(0.5, abs=1e-3)
