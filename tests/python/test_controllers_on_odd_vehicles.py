"""Controllers on vehicles without the symmetries of the shipped ones."""

from __future__ import annotations

import numpy as np
import pytest
from hooked import G, with_plugins
from vehicles import CROSS, DRAG, LIFT, MOTOR, SKEW, Rotor, plugin, vehicle

import quadcore as qc
from quadcore.control import controllers, references

OFF = (0.05, -0.02, 0.01)
# The order of the commands is neither the file's order nor the one around the vehicle.
ORDER = ["rotor3", "rotor1", "rotor2", "rotor4"]
AIR = {**LIFT, **DRAG, "reactionTorque": "opposing"}
FAN = Rotor((0.01, 0.02, -0.03), (0.3, 0.2, 0), 0.02, (2.0e-5, 2.0e-5, 3.5e-5))  # nobody drives it


def odd(com=OFF, rotors=(*CROSS[:2], FAN, *CROSS[2:]), air=AIR):
    """A vehicle whose third joint follows no command, in an order of commands of its own."""
    names = [f"rotor{i + 1}" for i, rotor in enumerate(rotors) if rotor is not FAN]
    order = " ".join(names[int(name[-1]) - 1] for name in ORDER)
    urdf = vehicle(
        rotors,
        inertia=SKEW,
        com=com,
        air={**air, "rotorJoints": order},
        motor={**MOTOR, "rotorJoints": order, "maxVelocity": 900},
    )
    return with_plugins(urdf, plugin("odometry", {}))


def largest(log, reference, since=5):
    wanted = np.array([reference(t).position for t in log.time])
    return np.linalg.norm(log.position - wanted, axis=1)[log.time > since].max()


def guide(urdf, reference, **tags):
    shape = {"shape": reference.name, **reference.parameters}
    return with_plugins(urdf, plugin("controller", tags), plugin("reference", shape))


@pytest.mark.parametrize("controller", ["geometric", "indi", "lqr", "pd_compensated"])
def test_a_controller_commands_the_rotors_that_are_driven_in_the_order_of_the_command(
    controller, hangar
):
    circle = references.circle(rate=0.8, yaw_rate=0.3)
    called = hangar(odd(), G, engine="eigen")
    plugged = hangar(guide(odd(), circle, law=controller), G, engine="eigen")
    for simulation in (called, plugged):
        simulation.set_state(references.start(simulation, circle))
    one = called.run(8, controller=controller, reference=circle)
    other = plugged.run(8)
    assert one.position.tobytes() == other.position.tobytes()
    assert largest(one, circle) < 2e-3
    assert np.abs(one.rotor_velocity[:, 2]).max() < 10  # the fan


def test_a_belief_is_matched_by_the_names_of_the_joints(hangar, tmp_path):
    circle = references.circle(rate=0.8)
    file = tmp_path / "believed.urdf"
    file.write_text(odd().replace("rotor1 rotor2", "rotor2 rotor1"))  # an order of its own
    plugged = hangar(guide(odd(), circle, law="geometric", belief=file), G, engine="eigen")
    called = hangar(odd(), G, engine="eigen")
    controller = controllers.geometric(belief=qc.Simulation(file, engine="eigen"))
    logs = []
    for simulation, options in (
        (plugged, {}),
        (called, {"controller": controller, "reference": circle}),
    ):
        simulation.set_state(references.start(simulation, circle))
        logs.append(simulation.run(6, **options))
        assert largest(logs[-1], circle) < 2e-3
    assert logs[0].position.tobytes() == logs[1].position.tobytes()
    file.write_text(odd().replace("rotor4", "fourth"))
    with pytest.raises(qc.InputError, match="has a rotor 'fourth', but the simulated vehicle has"):
        hangar(guide(odd(), circle, law="geometric", belief=file), G)


def test_a_xacro_file_to_believe_in_is_refused_with_what_to_do(hangar, tmp_path):
    file = tmp_path / "believed.urdf.xacro"
    file.write_text(odd())
    with pytest.raises(qc.InputError, match="Expand the file: `xacro FILE > URDF`"):
        hangar(guide(odd(), references.circle(), law="pd", belief=file), G)


def test_a_controller_without_ordered_motors_is_refused(hangar):
    still = with_plugins(vehicle(CROSS, air=AIR), plugin("odometry", {}))
    with pytest.raises(qc.InputError, match="no plugin of model 'vehicle' accepts commands"):
        hangar(still, G).run(1, controller="pd", reference="hover")


@pytest.mark.parametrize(
    ("reference", "bar"),
    [
        (references.circle(), 1.5e-3),
        (references.hover(yaw_rate=2), 1e-3),
        (references.spiral(), 0.25e-3),
    ],
    ids=["circle", "turning", "spiral"],
)
@pytest.mark.parametrize("controller", ["geometric", "lqr"])
def test_a_centre_of_mass_off_the_origin_is_made_up_for(controller, reference, bar, hangar):
    simulation = hangar(odd(rotors=CROSS), G, engine="eigen")
    simulation.set_state(references.start(simulation, reference))
    start = simulation.state
    wanted = reference(0)
    assert np.allclose(start.position, wanted.position)
    assert np.allclose(start.linear_velocity, wanted.velocity)
    log = simulation.run(12, controller=controller, reference=reference, log_every=5)
    assert largest(log, reference, 0) < bar


@pytest.mark.parametrize("controller", ["pd", "pd_compensated", "pid"])
def test_a_cascade_follows_a_yaw_that_turns(controller, hangar):
    hover = references.hover(yaw_rate=0.5)
    urdf = odd(
        com=(0, 0, 0),
        rotors=CROSS,
        air={**LIFT, "inducedDragCoeff": 0, "reactionTorque": "opposing"},
    )
    simulation = hangar(urdf, G, engine="eigen")
    simulation.set_state(references.start(simulation, hover))
    log = simulation.run(10, controller=controller, reference=hover, log_every=10)
    x, y, z, w = log.orientation.T
    yaw = np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
    assert np.abs(yaw - 0.5 * log.time)[log.time > 5].max() < 1e-3
