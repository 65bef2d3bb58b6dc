"""The learned policy of `foundation-policy` as a controller.

RAPTOR (Eschmann, Albani, Loianno: A Foundation Policy for Quadrotor Control, 2025,
arXiv:2509.11481) was trained on quadrotors of 0.03 to 2.4 kg, without a model of this one.
Install it with ``pip install foundation-policy``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from foundation_policy import Raptor
from scipy.spatial.transform import Rotation

import quadcore as qc

_THRUST_TO_WEIGHT = 2.5  # at the speed of action 1

# The policy's frame P is F rotated by 45 degrees about z. Its rotors lie between its axes, in the
# order front right, back right, back left, front left; they are rotors 1, 2, 3, 4 on the axes of F.
_R_FP = Rotation.from_euler("z", 45, degrees=True).as_matrix()
_SPINS = np.array([1.0, -1.0, 1.0, -1.0])


class Policy:
    """Control a quadrotor with `reactionTorque` ``opposing``."""

    rate = 100.0

    def __init__(self) -> None:
        self._network = Raptor()

    def reset(self, simulation: Any) -> None:
        """Prepare for a flight of this vehicle."""
        tags = {tag.name: tag.value for plugin in simulation.plugins for tag in plugin.parameters}
        if simulation.rotor_count != 4 or tags.get("reactionTorque") != "opposing":
            raise qc.InputError(
                "the learned policy needs four rotors and reactionTorque opposing; "
                "set drone_plugin.reactionTorque"
            )
        weight = simulation.mass * -simulation.world.gravity[2]
        thrust = float(tags["rotorThrustCoeff"])  # N s^2
        self._fastest = np.sqrt(_THRUST_TO_WEIGHT * weight / (4 * thrust))
        self._network.reset()
        self._action = np.zeros(4)

    def __call__(self, t: float, state: qc.Odometry, reference: Any) -> np.ndarray:
        """Return the rotor speeds, rad/s."""
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
