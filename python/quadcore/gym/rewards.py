"""Rewards by name."""

from __future__ import annotations

from typing import Callable, Dict, NamedTuple

import numpy as np

from .step_data import StepData


class Reward(NamedTuple):
    """Reward term for each vehicle."""

    meaning: str
    compute: Callable[[StepData], np.ndarray]
    """Returns the term for each vehicle, shape (n,)."""


def _norm(rows: np.ndarray) -> np.ndarray:
    lengths: np.ndarray = np.sqrt(np.einsum("ni,ni->n", rows, rows))
    return lengths


REWARDS: Dict[str, Reward] = {
    "alive": Reward("1", lambda s: np.ones(len(s.error))),
    "lost": Reward("-1 when the episode is terminated, else 0", lambda s: -1.0 * s.lost),
    "distance": Reward("negative distance to the goal, m", lambda s: -_norm(s.error)),
    "near": Reward("1 / (1 + distance^2), distance in m", lambda s: 1 / (1 + _norm(s.error) ** 2)),
    "upright": Reward("cosine of the tilt", lambda s: s.R_WF[:, 2, 2]),
    "speed": Reward("negative speed, m/s", lambda s: -_norm(s.linear_velocity)),
    "turning": Reward("negative angular speed, rad/s", lambda s: -_norm(s.angular_velocity)),
    "effort": Reward("negative mean square of the action", lambda s: -np.mean(s.action**2, axis=1)),
    "haste": Reward(
        "negative mean square of the change of the action",
        lambda s: -np.mean((s.action - s.action_before) ** 2, axis=1),
    ),
}
