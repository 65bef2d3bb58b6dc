"""A network in an ONNX file that commands all seeds of a study at once.

ONNX Runtime computes the network. Install it with ``pip install 'quadcore[onnx]'``, and make the
file with ``python train_policy.py``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime

import quadcore as qc

FILE = "policy.onnx"


class Policy:
    """Hold the position of the reference at yaw 0, for any number of vehicles."""

    vectorized = True

    def reset(self, simulation: Any) -> None:
        """Read the network, and prepare for flights of this vehicle."""
        if not Path(FILE).is_file():
            raise qc.InputError(f"{FILE}: there is no such file. Run train_policy.py to make it.")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1  # studies run one process for each core
        self._network = onnxruntime.InferenceSession(FILE, options, ["CPUExecutionProvider"])
        self._hover = simulation.hover_speed

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the rotor speeds (n, rotors), rad/s, for states of n vehicles."""
        observations = np.hstack(
            [
                reference.position - state.position,
                reference.velocity - state.linear_velocity,
                state.orientation[:, :3] * np.sign(state.orientation[:, 3:]),
                state.angular_velocity,
            ]
        )
        speeds: np.ndarray = self._network.run(None, {"observations": observations})[0]
        return speeds * self._hover
