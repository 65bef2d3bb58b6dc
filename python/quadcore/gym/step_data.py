"""What observations and rewards are made of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class StepData(NamedTuple):
    """Where n vehicles are after an action, a row for each.

    Attributes
    ----------
    error : ndarray (n, 3)
        From the goal to the frame origin, world axes, m.
    R_WF : ndarray (n, 3, 3)
        Turns vectors from frame axes to world axes.
    linear_velocity : ndarray (n, 3)
        Of the frame origins, world axes, m/s.
    angular_velocity : ndarray (n, 3)
        Of the frames, body axes, rad/s.
    rotor_velocity : ndarray (n, rotors)
        Joint velocities as the engine has them, rad/s.
    action, action_before : ndarray (n, rotors)
        The one that led here, and the one before; zero at the start.
    lost : ndarray (n,) of bool
        Whether the episode ends because the vehicle is lost.
    """

    error: np.ndarray
    R_WF: np.ndarray
    linear_velocity: np.ndarray
    angular_velocity: np.ndarray
    rotor_velocity: np.ndarray
    action: np.ndarray
    action_before: np.ndarray
    lost: np.ndarray
