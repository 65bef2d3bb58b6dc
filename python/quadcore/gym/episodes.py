"""The episodes of n vehicles: their goals, what they did last, and when they end."""

from __future__ import annotations

from typing import List, NamedTuple, Sequence

import numpy as np
from gymnasium.utils import seeding

from ..simulation.batch import BatchState
from ..support.rotation import matrix
from .step_data import StepData
from .task import Task


class StepResult(NamedTuple):
    """Of an action, a row or a number for each vehicle."""

    observation: np.ndarray
    reward: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray


class Episodes:
    """Of vehicles that begin at `homes`, (n, 3), m.

    Each draws from a generator of its own: what befalls one does not depend on the others.
    """

    def __init__(self, task: Task, homes: np.ndarray) -> None:
        n = len(homes)
        self._task, self._homes = task, homes
        self._goals = homes.copy()
        self._action = np.zeros((n, len(task.hover)))
        self._count = np.zeros(n, int)
        self._generators: List[np.random.Generator] = []

    @property
    def goals(self) -> np.ndarray:
        """Where the vehicles are to go, world axes, (n, 3), m."""
        return self._goals.copy()

    def set_seeds(self, seed: int) -> None:
        """Give vehicle i the generator of seed + i."""
        self._generators = [seeding.np_random(seed + i)[0] for i in range(len(self._homes))]

    def set_generators(self, generators: Sequence[np.random.Generator]) -> None:
        """Take over generators."""
        self._generators = list(generators)

    def begin(self, mask: np.ndarray) -> np.ndarray:
        """Begin the episodes of some vehicles; returns the seeds of their noise, (n,)."""
        seeds = np.zeros(len(mask), np.uint64)
        for i in np.flatnonzero(mask):
            draw = self._generators[i]
            seeds[i] = draw.integers(2**63)
            self._goals[i] = self._homes[i] + self._task.rules.spread * draw.uniform(-1, 1, 3)
        self._action[mask] = 0
        self._count[mask] = 0
        return seeds

    def observe(self, state: BatchState) -> np.ndarray:
        """Give the observations of vehicles that have begun."""
        nobody = np.zeros(len(self._homes), bool)
        return self._task.observe(self._make_step(state, self._action, lost=nobody))

    def finish_step(
        self, state: BatchState, actions: np.ndarray, failed: np.ndarray, begun: np.ndarray
    ) -> StepResult:
        """Say what came of actions, which those that have just begun did not take."""
        actions = np.where(begun[:, None], 0.0, actions)
        self._count += ~begun
        away = np.linalg.norm(state.position - self._goals, axis=1)
        lost = failed | ~(away <= self._task.rules.reach)
        step = self._make_step(state, actions, lost)
        self._action = actions
        return StepResult(
            self._task.observe(step),
            np.where(begun, 0.0, self._task.reward(step)),
            lost,
            ~lost & (self._count >= self._task.actions),
        )

    def _make_step(self, state: BatchState, action: np.ndarray, lost: np.ndarray) -> StepData:
        return StepData(
            state.position - self._goals,
            matrix(state.orientation),
            state.linear_velocity,
            state.angular_velocity,
            state.rotor_velocity,
            action,
            self._action,
            lost,
        )
