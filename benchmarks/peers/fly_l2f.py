"""l2f, the simulator of "Learning to Fly in Seconds"; turning rotors do nothing to the frame."""

import json

import l2f
import numpy as np
from flight import judge, phases, vehicle
from l2f import vector1024 as vector

V = vehicle()
DT = 1e-2
FASTEST = 1000.0  # rad/s, to which an action of 1 is scaled


def parameters(device):
    """Those of the vehicle, rotor speeds in rad/s."""
    environment, made = l2f.Environment(), l2f.Parameters()
    l2f.initialize_environment(device, environment)
    l2f.initial_parameters(device, environment, made)
    given = json.loads(l2f.parameters_to_json(device, environment, made))
    given["integration"]["dt"] = DT
    given["dynamics"].update(
        rotor_positions=V["rotors"],
        rotor_torque_directions=[[0, 0, -spin] for spin in V["spins"]],
        rotor_thrust_coefficients=[[0, 0, V["thrust"]]] * 4,
        rotor_torque_constants=[V["torque"] / V["thrust"]] * 4,
        rotor_time_constants_rising=[V["lag"]] * 4,
        rotor_time_constants_falling=[V["lag"]] * 4,
        mass=V["mass"],
        gravity=[0, 0, -V["gravity"]],
        J=V["inertia"],
        J_inv=np.linalg.inv(V["inertia"]).tolist(),
        action_limit={"min": 0, "max": FASTEST},
    )
    l2f.parameters_from_json(device, environment, json.dumps(given), made)
    return made


DEVICE, RNG, ENVIRONMENT = l2f.Device(), vector.VectorRng(), vector.VectorEnvironment()
PARAMETERS, START = vector.VectorParameters(), vector.VectorState()
vector.initialize_rng(DEVICE, RNG, 0)
vector.initialize_environment(DEVICE, ENVIRONMENT)
vector.initial_parameters(DEVICE, ENVIRONMENT, PARAMETERS)
PARAMETERS.parameters = [parameters(DEVICE)] * ENVIRONMENT.N_ENVIRONMENTS
vector.initial_state(DEVICE, ENVIRONMENT, PARAMETERS, START)
states = START.states
for state in states:
    state.position = V["start"]
    state.rpm = [0.0] * 4
START.states = states


def fly():
    now, then = vector.VectorState(), vector.VectorState()
    now.assign(START)
    for speeds, count in phases(V["hover"], DT):
        action = np.tile(2 * np.array(speeds, np.float32) / FASTEST - 1, (1024, 1))
        for _ in range(count):
            vector.step(DEVICE, ENVIRONMENT, PARAMETERS, now, action, then, RNG)
            now, then = then, now
    return now.states[0].position.tolist()


judge("single precision, its own integrator", DT, ENVIRONMENT.N_ENVIRONMENTS, fly)
