"""Train a network that imitates the built-in controller `geometric`: a few seconds on one core.

    python train_policy.py [--out policy.onnx]

The controller commands random states near hover. A least-squares fit finds the output weights of
a network with one hidden layer, whose other weights are random (extreme learning machine; Huang,
Zhu, Siew, Neurocomputing 70, 2006). Install the requirements with ``pip install 'quadcore[onnx]'``.
"""

from __future__ import annotations

import argparse
from types import SimpleNamespace
from typing import Tuple

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

import quadcore as qc

SAMPLES, HIDDEN = 2000, 64
SPREAD = np.repeat([0.03, 0.1, 0.02, 0.2], 3)
"""Standard deviations of position error (m), velocity error (m/s), half the rotation vector (rad)
and angular velocity (rad/s)."""


def imitate(seed: int = 1) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the weights and biases of both layers."""
    generator = np.random.default_rng(seed)
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    teacher = qc.controllers.geometric(integral=False, lead=False)
    observations = generator.normal(size=(SAMPLES, len(SPREAD))) * SPREAD
    teacher.reset(simulation)
    speeds = np.array([ask_teacher(teacher, observation) for observation in observations])
    weights = generator.normal(size=(len(SPREAD), HIDDEN)) / (10 * SPREAD[:, None])
    biases = generator.uniform(-1, 1, HIDDEN)
    hidden = np.column_stack([np.tanh(observations @ weights + biases), np.ones(SAMPLES)])
    fitted = np.linalg.lstsq(hidden, speeds / simulation.hover_speed, rcond=None)[0]
    return weights, biases, fitted[:-1], fitted[-1]


def ask_teacher(teacher: qc.controllers.BuiltInController, observation: np.ndarray) -> np.ndarray:
    """Return the rotor speeds of the controller for an observation, rad/s."""
    position, velocity, half_turn, rates = observation.reshape(4, 3)
    state = SimpleNamespace(
        time=0.0,
        position=-position,
        linear_velocity=-velocity,
        orientation=np.append(half_turn, np.sqrt(1 - half_turn @ half_turn)),
        angular_velocity=rates,
    )
    return teacher(0.0, state, qc.Reference())


def make_model(
    weights: np.ndarray, biases: np.ndarray, output: np.ndarray, offset: np.ndarray
) -> onnx.ModelProto:
    """Return the network: observations (n, 12) to speeds (n, rotors) divided by those of hover."""
    constants = {"weights": weights, "biases": biases, "output": output, "offset": offset}
    nodes = [
        helper.make_node("Gemm", ["observations", "weights", "biases"], ["sums"]),
        helper.make_node("Tanh", ["sums"], ["hidden"]),
        helper.make_node("Gemm", ["hidden", "output", "offset"], ["speeds"]),
    ]
    graph = helper.make_graph(
        nodes,
        "policy",
        [_describe("observations", len(weights))],
        [_describe("speeds", len(offset))],
        [numpy_helper.from_array(value, name) for name, value in constants.items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=7)
    onnx.checker.check_model(model)
    return model


def _describe(name: str, width: int) -> onnx.ValueInfoProto:
    return helper.make_tensor_value_info(name, TensorProto.DOUBLE, ["n", width])


def main() -> None:
    """Train, and write the network."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--out", default="policy.onnx")
    arguments = parser.parse_args()
    onnx.save(make_model(*imitate()), arguments.out)
    print(f"written {arguments.out}")


if __name__ == "__main__":
    main()
