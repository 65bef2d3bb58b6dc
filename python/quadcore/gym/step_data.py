"""States and actions from which observations and rewards are computed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class StepData(NamedTuple):
    """States of n vehicles after an action; each row belongs to one vehicle.

    Attributes
    ----------
    error : ndarray (n, 3)
        Vectors from the goals to the frame origins, world axes, m.
    R_WF : ndarray (n, 3, 3)
        Rotation matrices from frame axes to world axes.
    linear_velocity : ndarray (n, 3)
        Velocities of the frame origins, world axes, m/s.
    angular_velocity : ndarray (n, 3)
        Angular velocities of the frames, body axes, rad/s.
    rotor_velocity : ndarray (n, rotors)
        Joint velocities, rad/s.
    action, action_before : ndarray (n, rotors)
        Current and previous actions; zero at the start.
    lost : ndarray (n,) of bool
        Whether each episode is terminated.
    """

    error: np.ndarray
    R_WF: np.ndarray
    linear_velocity: np.ndarray
    angular_velocity: np.ndarray
    rotor_velocity: np.ndarray
    action: np.ndarray
    action_before: np.ndarray
    lost: np.ndarray
