"""One vehicle as an environment."""

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

    An episode begins at `spawn`, at rest, rotors and all. It is terminated when the vehicle is too
    far from the goal or its flight fails, and truncated at the end of its duration.

    Parameters
    ----------
    model : str, path or Model
        As of `Simulation`.
    engine : str
        "eigen" unless another is named.
    **options
        The members of `task.Rules`: observation, reward, rate, duration, spread, reach, authority.
        Others as of `Simulation`.

    Attributes
    ----------
    simulation : Simulation
        What flies.
    task : Task
        What is observed, rewarded and commanded.

    Raises
    ------
    InputError
        The model, the world or an argument is at fault, or actions are.
    """

    metadata = {"render_modes": []}  # noqa: RUF012  (as Gymnasium has it)

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
        """Where the vehicle is to go, world axes, (3,), m."""
        goal: np.ndarray = self._episodes.goals[0]
        return goal

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Begin an episode; `seed` is that of goals and noise from now on."""
        check_no_options(options)
        super().reset(seed=seed)
        self._episodes.set_generators([self.np_random])
        (noise,) = self._episodes.begin(np.ones(1, bool))
        self.simulation.reset(seed=int(noise))
        self._flies = True
        return self._episodes.observe(self._state())[0], {}

    def step(self, action: np.ndarray) -> Step:
        """Hold an action for 1 / rate seconds.

        The `info` of a flight that failed has the reason as ``failure``; the observation is then of
        the state before.
        """
        if not self._flies:
            raise InputError("the episode has ended, or none has begun; reset the environment")
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
    """Raise `InputError` if a reset is given any."""
    if options:
        raise InputError(f"reset: there is no option {', '.join(map(repr, options))}; give none")
