"""Gymnasium environments: fly to a goal and stay there.

`Env` steps a `Simulation`, and `VectorEnv` steps a `BatchSimulation`. Importing this module
registers both as ``quadcore/Hover-v0``. `OBSERVATIONS` and `REWARDS` contain the observations and
rewards that can be selected by name.
"""

from .._core import InputError

try:
    from gymnasium.vector import AutoresetMode  # noqa: F401  (new in 1.1)
except ImportError:
    raise InputError(
        "quadcore.gym requires the package gymnasium, 1.1 or newer. Install it: "
        "pip install 'quadcore[gym]'"
    ) from None

import gymnasium

from .env import Env
from .observations import OBSERVATIONS
from .rewards import REWARDS
from .vector_env import VectorEnv

NAME = "quadcore/Hover-v0"
"""Name for `gymnasium.make` and `gymnasium.make_vec`."""

gymnasium.register(
    NAME, entry_point="quadcore.gym:Env", vector_entry_point="quadcore.gym:VectorEnv"
)

__all__ = ["NAME", "OBSERVATIONS", "REWARDS", "Env", "VectorEnv"]
