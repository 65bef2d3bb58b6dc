"""Many vehicles as one environment."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Tuple, Union

import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector import VectorEnv as _VectorEnv
from gymnasium.vector.utils import batch_space

from .._core import InputError, Model
from ..simulation.batch import BatchSimulation, BatchState
from ..simulation.engines import EngineName
from ..simulation.simulation import Simulation
from ..support.warning import suppress_warnings
from .env import check_no_options
from .episodes import Episodes
from .task import Task, split_options

Step = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Dict[str, Any]]


class VectorEnv(_VectorEnv):
    """Many vehicles, each on its way to a goal of its own; see `Env`.

    Vehicle i flies, to the last bit, as an `Env` does that is reset with seed + i. Autoreset is
    that of the next step (`AutoresetMode.NEXT_STEP`): the step after the last one of an episode
    begins the next episode, whatever the action, and gives its first observation with reward 0.

    Parameters
    ----------
    num_envs : int
        Vehicles.
    model : str, path or Model
        As of `Simulation`.
    engine : str
        "eigen" unless another is named.
    **options
        The members of `task.Rules`, as for `Env`; others as of `BatchSimulation`, so that
        parameters and starts may be each vehicle's own. Actions mean the same for all: the speed of
        hovering that they are measured by is that of the model without parameters that differ.

    Attributes
    ----------
    batch : BatchSimulation
        What flies.
    task : Task
        What is observed, rewarded and commanded.

    Raises
    ------
    InputError
        As of `Env`.
    """

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012

    def __init__(
        self,
        num_envs: int = 1,
        model: Union[str, Path, Model] = "quadrotor",
        engine: EngineName = "eigen",
        **options: Any,
    ) -> None:
        rules, others = split_options(options)
        self.batch = BatchSimulation(model, num_envs, engine, **others)
        with suppress_warnings():  # it has been said of the batch
            self.task = Task(Simulation(model, engine, **_pick_common(others)), rules)
        self.num_envs = self.batch.n
        self.single_observation_space = self.task.observation_space
        self.single_action_space = self.task.action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._rows = self.batch.read_state()
        self._episodes = Episodes(self.task, self._state().position.copy())
        self._ended = np.zeros(self.num_envs, bool)
        self._has_begun = False

    @property
    def goals(self) -> np.ndarray:
        """Where the vehicles are to go, world axes, (num_envs, 3), m."""
        return self._episodes.goals

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Begin an episode of each vehicle; `seed` + i is that of vehicle i from now on."""
        check_no_options(options)
        super().reset(seed=seed)
        if seed is not None or not self._has_begun:
            # Without a seed, one that nobody can foresee.
            self._episodes.set_seeds(int(self.np_random.integers(2**31)) if seed is None else seed)
        self._has_begun = True
        everyone = np.ones(self.num_envs, bool)
        self._begin(everyone)
        self._ended[:] = False
        return self._episodes.observe(self._state()), {}

    def step(self, actions: np.ndarray) -> Step:
        """Hold an action of each vehicle for 1 / rate seconds.

        `infos` has the reasons of flights that failed as ``failure``, and as ``_failure`` which
        they are; their observations are then of the state before.
        """
        if not self._has_begun:
            raise InputError("no episode has begun; reset the environment")
        actions = np.asarray(actions, dtype=float)
        if actions.shape != self.action_space.shape:
            raise InputError(
                f"actions are an array of {actions.shape}; give {self.action_space.shape}"
            )
        commands, ended = self.task.commands(actions), self._ended
        before = self._rows.copy()
        self.batch.step(commands, self.task.steps)
        if ended.any():
            self._begin(ended)
        failures = self.batch.failures
        failed = np.array([bool(why) for why in failures])
        self.batch.read_state(self._rows)
        self._rows[failed] = before[failed]
        done = self._episodes.finish_step(self._state(), actions, failed, begun=ended)
        self._ended = done.terminated | done.truncated
        infos = {"failure": np.array(failures, object), "_failure": failed} if failed.any() else {}
        return (*done, infos)

    def _begin(self, chosen: np.ndarray) -> None:
        self.batch.reset(chosen, self._episodes.begin(chosen))
        self.batch.read_state(self._rows)

    def _state(self) -> BatchState:
        return BatchState.of(self._rows)


def _pick_common(options: Mapping[str, Any]) -> Dict[str, Any]:
    """Give the arguments of a `Simulation` in which all vehicles of a batch agree."""
    alike = {k: v for k, v in options.items() if k in ("world", "dt", "xacro_args", "ignore")}
    parameters = (options.get("parameters") or {}).items()
    return {**alike, "parameters": {k: v for k, v in parameters if np.ndim(v) == 0}}
