"""The learned policy of `foundation-policy` as a controller.

RAPTOR (Eschmann, Albani, Loianno: A Foundation Policy for Quadrotor Control, 2025,
arXiv:2509.11481), trained on quadrotors of 0.03 to 2.4 kg; nobody told it of this one. Needs
``pip install foundation-policy``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from foundation_policy import Raptor
from scipy.spatial.transform import Rotation

import quadcore as qc

_THRUST_TO_WEIGHT = 2.5  # of the speed that an action of 1 asks for

# The policy's frame P is F turned by 45 degrees about z: it has its rotors between its axes, in the
# order front right, back right, back left, front left, as F has rotors 1, 2, 3, 4 on its axes.
_R_FP = Rotation.from_euler("z", 45, degrees=True).as_matrix()
_SPINS = np.array([1.0, -1.0, 1.0, -1.0])


class Policy:
    """Flies quadrotors whose `reactionTorque` is ``opposing``, as that of the air is."""

    rate = 100.0

    def __init__(self) -> None:
        self._network = Raptor()

    def reset(self, simulation: Any) -> None:
        """Begin anew on a vehicle."""
        tags = {tag.name: tag.value for plugin in simulation.plugins for tag in plugin.parameters}
        if simulation.rotor_count != 4 or tags.get("reactionTorque") != "opposing":
            raise qc.InputError(
                "the learned policy flies four rotors whose reactionTorque is opposing; "
                "set drone_plugin.reactionTorque"
            )
        weight = simulation.mass * -simulation.world.gravity[2]
        thrust = float(tags["rotorThrustCoeff"])  # N s^2
        self._fastest = np.sqrt(_THRUST_TO_WEIGHT * weight / (4 * thrust))
        self._network.reset()
        self._action = np.zeros(4)

    def __call__(self, t: float, state: qc.Odometry, reference: Any) -> np.ndarray:
        """Give the speeds of the rotors, rad/s."""
        R_WP = Rotation.from_quat(state.orientation).as_matrix() @ _R_FP
        observation = np.concatenate(
            [
                state.position - reference.position,
                R_WP.ravel(),
                state.linear_velocity - reference.velocity,
                _R_FP.T @ state.angular_velocity,
                self._action,
            ]
        )
        self._action = self._network.evaluate_step(observation[None])[0]
        return _SPINS * self._fastest * (self._action + 1) / 2
