"""Environment with one vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Optional, Tuple, Union

import gymnasium
import numpy as np

from .._core import FlightError, InputError, Model
from ..simulation.batch import BatchState
from ..simulation.engines import EngineName
from ..simulation.simulation import Simulation
from .episodes import Episodes
from .task import Task, split_options

_NOBODY = np.zeros(1, bool)

Step = Tuple[np.ndarray, float, bool, bool, Dict[str, Any]]


class Env(gymnasium.Env):
    """Fly from the start to a goal near it, and stay there.

    An episode starts at `spawn`, with vehicle and rotors at rest. It is terminated if the vehicle
    is too far from the goal or the flight fails. It is truncated at the end of its duration.

    Parameters
    ----------
    model : str, path or Model
        As for `Simulation`.
    engine : str
        Physics engine.
    **options
        Fields of `task.Rules`: observation, reward, rate, duration, spread, reach and authority.
        All other options are those of `Simulation`.

    Attributes
    ----------
    simulation : Simulation
        Simulation of the vehicle.
    task : Task
        Definition of observations, rewards and commands.

    Raises
    ------
    InputError
        If the model, the world, an argument or an action is invalid.
    """

    metadata = {"render_modes": []}  # noqa: RUF012  (as in Gymnasium)

    def __init__(
        self,
        model: Union[str, Path, Model] = "quadrotor",
        engine: EngineName = "eigen",
        **options: Any,
    ) -> None:
        rules, others = split_options(options)
        self.simulation = Simulation(model, engine, **others)
        self.task = Task(self.simulation, rules)
        self.observation_space = self.task.observation_space
        self.action_space = self.task.action_space
        self._episodes = Episodes(self.task, self.simulation.state.position[None].copy())
        self._flies = False

    @property
    def goal(self) -> np.ndarray:
        """Goal of the vehicle, world axes, m; shape (3,)."""
        goal: np.ndarray = self._episodes.goals[0]
        return goal

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Start an episode; `seed` sets the random generator of goals and noise."""
        check_no_options(options)
        super().reset(seed=seed)
        self._episodes.set_generators([self.np_random])
        (noise,) = self._episodes.begin(np.ones(1, bool))
        self.simulation.reset(seed=int(noise))
        self._flies = True
        return self._episodes.observe(self._state())[0], {}

    def step(self, action: np.ndarray) -> Step:
        """Apply an action for 1 / rate seconds.

        If the flight fails, ``info["failure"]`` contains the reason, and the observation is that of
        the previous state.
        """
        if not self._flies:
            raise InputError("the episode has ended, or none has started. Reset the environment.")
        actions = np.asarray(action, dtype=float)[None]
        commands = self.task.commands(actions)
        before, info = self._state(), {}
        self.simulation.command(commands[0])
        try:
            self.simulation.step(self.task.steps)
        except FlightError as error:
            info["failure"] = str(error)
        state = before if info else self._state()
        done = self._episodes.finish_step(state, actions, np.array([bool(info)]), _NOBODY)
        terminated, truncated = bool(done.terminated[0]), bool(done.truncated[0])
        self._flies = not (terminated or truncated)
        return done.observation[0], float(done.reward[0]), terminated, truncated, info

    def _state(self) -> BatchState:
        state = self.simulation.state.copy()
        return BatchState(*(getattr(state, name)[None] for name in BatchState._fields))


def check_no_options(options: Optional[Dict[str, Any]]) -> None:
    """Raise `InputError` if options are passed to `reset`."""
    if options:
        raise InputError(f"reset: unknown option {', '.join(map(repr, options))}. Remove it.")
