"""Task of an episode: action rate, scaling of actions, observations and rewards."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any, Mapping, NamedTuple, Sequence, Tuple

import numpy as np
from gymnasium import spaces

from .._core import InputError
from ..control import references
from ..control.inner_loop import AttitudeThrust, InnerLoop
from ..simulation.simulation import Simulation
from ..support.parameters import suggest
from .observations import OBSERVATIONS
from .rewards import REWARDS
from .step_data import StepData


class Rules(NamedTuple):
    """Rules of episodes; both environments accept these fields as keyword arguments.

    Attributes
    ----------
    observation : sequence of str
        Names in `OBSERVATIONS`; the observations are concatenated.
    reward : mapping of str to float
        Weights of terms in `REWARDS`; the weighted terms are summed.
    rate : float
        Actions per simulated second, 1/s. Each action lasts a whole number of steps.
    duration : float
        Duration after which an episode is truncated, s.
    spread : float
        Half the edge length of the cube around the start in which the goal is sampled, m.
    reach : float
        Distance from the goal beyond which an episode is terminated, m.
    authority : float
        Scale of actions in (0, 1]: an action a commands (1 + authority a) times the hover speed.
    """

    observation: Sequence[str] = ("error", "rotation", "velocity", "rates", "action")
    reward: Mapping[str, float] = {"near": 1.0, "turning": 0.05, "lost": 10.0}
    rate: float = 100.0
    duration: float = 5.0
    spread: float = 1.0
    reach: float = 4.0
    authority: float = 0.5


class Task:
    """Application of the rules to a vehicle.

    Parameters
    ----------
    vehicle : Simulation
        Vehicle. Actions are relative to its hover speed.
    rules : Rules

    Attributes
    ----------
    hover : ndarray (rotors,)
        Signed commands for hover in still air, rad/s.
    steps : int
        Number of simulation steps per action.
    actions : int
        Maximum number of actions in an episode.
    observation_space, action_space : Box

    Raises
    ------
    InputError
        If a name does not exist, a number is out of range, or the vehicle cannot hover.
    """

    def __init__(self, vehicle: Simulation, rules: Rules) -> None:
        self._check(rules)
        self.rules = rules
        steps = 1 / (rules.rate * vehicle.dt)
        self.steps = round(steps)
        if self.steps < 1 or not math.isclose(self.steps, steps, rel_tol=1e-6):
            raise InputError(
                f"rate is {rules.rate:g}: an action lasts {steps:g} steps of {vehicle.dt:g} s. "
                "Give a rate with whole steps."
            )
        self.actions = max(1, round(rules.duration * rules.rate))
        self.hover = _hover_commands(vehicle)
        rotors = len(self.hover)
        seen = [OBSERVATIONS[name] for name in rules.observation]
        widths = [one.compute(_make_empty_step(rotors)).shape[1] for one in seen]
        bounds = np.repeat([one.bound for one in seen], widths).astype(np.float32)
        self.observation_space = spaces.Box(-bounds, bounds, dtype=np.float32)
        self.action_space = spaces.Box(-1, 1, (rotors,), np.float32)

    def commands(self, actions: np.ndarray) -> np.ndarray:
        """Return the commands (n, rotors) for actions (n, rotors), rad/s.

        Raises
        ------
        InputError
            If an action has the wrong shape or exceeds [-1, 1]. Actions are not clipped.
        """
        if actions.ndim != 2 or actions.shape[1] != len(self.hover):
            raise InputError(
                f"an action has shape {actions.shape[1:]}. Give shape {self.hover.shape}."
            )
        if not (np.abs(actions) <= 1).all():
            raise InputError(
                "an action is not within [-1, 1]. Clip it, for example with "
                "gymnasium.wrappers.ClipAction."
            )
        commands: np.ndarray = self.hover * (1 + self.rules.authority * actions)
        return commands

    def observe(self, step: StepData) -> np.ndarray:
        """Return the observations, shape (n, width)."""
        parts = [OBSERVATIONS[name].compute(step) for name in self.rules.observation]
        return np.concatenate(parts, axis=1).astype(np.float32)

    def reward(self, step: StepData) -> np.ndarray:
        """Return the rewards, shape (n,)."""
        total = np.zeros(len(step.error))
        for name, weight in self.rules.reward.items():
            total += weight * REWARDS[name].compute(step)
        return total

    @staticmethod
    def _check(rules: Rules) -> None:
        for what, names, known in (
            ("observation", rules.observation, OBSERVATIONS),
            ("reward", rules.reward, REWARDS),
        ):
            if isinstance(names, str) or not names:
                raise InputError(f"{what} is {names!r}. Name some of {', '.join(known)}.")
            for name in names:
                if name not in known:
                    near = suggest(str(name), list(known))
                    raise InputError(
                        f"{what} '{name}' does not exist.{near} Use some of {', '.join(known)}."
                    )
        for name in ("rate", "duration", "reach", "authority"):
            value = getattr(rules, name)
            if not (isinstance(value, Real) and 0 < float(value) < math.inf):
                raise InputError(f"{name} is {value!r}. Give a number > 0.")
        if rules.authority > 1:
            raise InputError(f"authority is {rules.authority:g}. Give a number in (0, 1].")
        if not 0 <= rules.spread < rules.reach / math.sqrt(3):
            raise InputError(
                f"spread is {rules.spread:g} m but reach {rules.reach:g} m: an episode could end "
                "at its start. Give a spread from 0 to less than reach / sqrt(3)."
            )


def split_options(options: Mapping[str, Any]) -> Tuple[Rules, Mapping[str, Any]]:
    """Split options into rules and other arguments."""
    if "seed" in options:
        raise InputError("seed is an argument of reset(), not of the environment. Pass it there.")
    own = {name: value for name, value in options.items() if name in Rules._fields}
    return Rules(**own), {name: value for name, value in options.items() if name not in own}


def _hover_commands(vehicle: Simulation) -> np.ndarray:
    hovering = references.start(vehicle, references.hover())
    weight = vehicle.mass * float(np.linalg.norm(vehicle.world.gravity))
    upright = AttitudeThrust((0, 0, 0, 1), weight)
    return InnerLoop().speeds(vehicle, vehicle.dt, hovering, upright)


def _make_empty_step(rotors: int) -> StepData:
    zero, none = np.zeros((1, 3)), np.zeros((1, rotors))
    return StepData(zero, np.eye(3)[None], zero, zero, none, none, none, np.zeros(1, bool))
