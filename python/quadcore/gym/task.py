"""What an episode is about: how often one acts, what an action means, what is seen and rewarded."""

from __future__ import annotations

import difflib
import math
from numbers import Real
from typing import Any, Mapping, NamedTuple, Sequence, Tuple

import numpy as np
from gymnasium import spaces

from .._core import InputError
from ..control import references
from ..control.inner_loop import AttitudeThrust, InnerLoop
from ..simulation.simulation import Simulation
from .observations import OBSERVATIONS
from .rewards import REWARDS
from .step_data import StepData


class Rules(NamedTuple):
    """How episodes go; both environments take these arguments by name.

    Attributes
    ----------
    observation : sequence of str
        Of `OBSERVATIONS`, one behind another.
    reward : mapping of str to float
        Weights of `REWARDS`, which are summed.
    rate : float
        Actions per second; each is held for a whole number of steps.
    duration : float
        Of an episode, s; it is truncated then.
    spread : float
        The goal is drawn from the cube around the start with edges of twice this, m.
    reach : float
        Farther from the goal a vehicle is lost, m, and the episode terminated.
    authority : float
        An action a commands a rotor a speed of (1 + authority a) times that of hovering; in (0, 1].
    """

    observation: Sequence[str] = ("error", "rotation", "velocity", "rates", "action")
    reward: Mapping[str, float] = {"near": 1.0, "turning": 0.05, "lost": 10.0}
    rate: float = 100.0
    duration: float = 5.0
    spread: float = 1.0
    reach: float = 4.0
    authority: float = 0.5


class Task:
    """The rules, applied to a vehicle.

    Parameters
    ----------
    vehicle : Simulation
        Says what flies: its speed of hovering is what actions are measured by.
    rules : Rules

    Attributes
    ----------
    hover : ndarray (rotors,)
        Commands that carry the vehicle upright in still air, rad/s, signed.
    steps : int
        Of the simulation for each action.
    actions : int
        Of an episode.
    observation_space, action_space : Box

    Raises
    ------
    InputError
        A name that is none, a number out of its range, or a vehicle that cannot hover.
    """

    def __init__(self, vehicle: Simulation, rules: Rules) -> None:
        self._check(rules)
        self.rules = rules
        steps = 1 / (rules.rate * vehicle.dt)
        self.steps = round(steps)
        if self.steps < 1 or not math.isclose(self.steps, steps, rel_tol=1e-6):
            raise InputError(
                f"rate is {rules.rate:g}, which makes {steps:g} steps of {vehicle.dt:g} s an "
                "action; give one that makes whole ones"
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
        """Make the commands of actions (n, rotors), rad/s.

        Raises
        ------
        InputError
            Others than one for each rotor, or one outside of [-1, 1]: nothing is clamped unasked.
        """
        if actions.ndim != 2 or actions.shape[1] != len(self.hover):
            raise InputError(
                f"an action is an array of {actions.shape[1:]}; give {self.hover.shape}"
            )
        if not (np.abs(actions) <= 1).all():
            raise InputError(
                "an action is not within [-1, 1]; clip it, as gymnasium.wrappers.ClipAction does"
            )
        commands: np.ndarray = self.hover * (1 + self.rules.authority * actions)
        return commands

    def observe(self, step: StepData) -> np.ndarray:
        """Give the observations, (n, width)."""
        parts = [OBSERVATIONS[name].compute(step) for name in self.rules.observation]
        return np.concatenate(parts, axis=1).astype(np.float32)

    def reward(self, step: StepData) -> np.ndarray:
        """Give the rewards, (n,)."""
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
                raise InputError(f"{what} is {names!r}; name some of {', '.join(known)}")
            for name in names:
                if name not in known:
                    near = difflib.get_close_matches(str(name), known, 1, 0.0)[0]
                    raise InputError(
                        f"{what} '{name}' is none; the nearest is '{near}' of {', '.join(known)}"
                    )
        for name in ("rate", "duration", "reach", "authority"):
            value = getattr(rules, name)
            if not (isinstance(value, Real) and 0 < float(value) < math.inf):
                raise InputError(f"{name} is {value!r}; give a number > 0")
        if rules.authority > 1:
            raise InputError(f"authority is {rules.authority:g}; give one in (0, 1]")
        if not 0 <= rules.spread < rules.reach / math.sqrt(3):
            raise InputError(
                f"spread is {rules.spread:g} but reach {rules.reach:g} m: a vehicle would be lost "
                "as it starts; give a spread from 0 to less than reach / sqrt(3)"
            )


def split_options(options: Mapping[str, Any]) -> Tuple[Rules, Mapping[str, Any]]:
    """Tell the rules from other arguments."""
    if "seed" in options:
        raise InputError("seed: an environment takes it when it is reset; give it to reset()")
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
