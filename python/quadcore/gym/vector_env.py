"""Environment with many vehicles."""

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
    """Many vehicles, each with its own goal; see `Env`.

    Vehicle i is bit-identical to an `Env` that is reset with seed + i. Autoreset happens in
    the next step (`AutoresetMode.NEXT_STEP`). The step after the end of an episode ignores the
    action, starts the next episode, and returns its first observation with reward 0.

    Parameters
    ----------
    num_envs : int
        Number of vehicles.
    model : str, path or Model
        As for `Simulation`.
    engine : str
        Physics engine.
    **options
        Fields of `task.Rules`, as for `Env`. All other options are those of `BatchSimulation`, so
        parameters and initial poses may differ between vehicles. Actions are relative to the hover
        speed of the model without the parameters that differ.

    Attributes
    ----------
    batch : BatchSimulation
        Simulation of the vehicles.
    task : Task
        Definition of observations, rewards and commands.

    Raises
    ------
    InputError
        As for `Env`.
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
        with suppress_warnings():  # the batch has already issued these warnings
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
        """Goals of the vehicles, world axes, m; shape (num_envs, 3)."""
        return self._episodes.goals

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Start an episode of each vehicle; vehicle i gets the random generator of `seed` + i."""
        check_no_options(options)
        super().reset(seed=seed)
        if seed is not None or not self._has_begun:
            # Without a seed, use a random one.
            self._episodes.set_seeds(int(self.np_random.integers(2**31)) if seed is None else seed)
        self._has_begun = True
        everyone = np.ones(self.num_envs, bool)
        self._begin(everyone)
        self._ended[:] = False
        return self._episodes.observe(self._state()), {}

    def step(self, actions: np.ndarray) -> Step:
        """Apply one action per vehicle for 1 / rate seconds.

        If flights fail, ``infos["failure"]`` contains the reasons, and ``infos["_failure"]`` marks
        these flights. Their observations are those of the previous states.
        """
        if not self._has_begun:
            raise InputError("no episode has started. Reset the environment.")
        actions = np.asarray(actions, dtype=float)
        if actions.shape != self.action_space.shape:
            raise InputError(
                f"actions have shape {actions.shape}. Give shape {self.action_space.shape}."
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
    """Return the `Simulation` arguments that all vehicles of a batch share."""
    alike = {k: v for k, v in options.items() if k in ("world", "dt", "xacro_args", "ignore")}
    parameters = (options.get("parameters") or {}).items()
    return {**alike, "parameters": {k: v for k, v in parameters if np.ndim(v) == 0}}
