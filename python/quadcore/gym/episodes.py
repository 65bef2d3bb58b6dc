"""Episodes of n vehicles: goals, last actions and ends."""

from __future__ import annotations

from typing import List, NamedTuple, Sequence

import numpy as np
from gymnasium.utils import seeding

from ..simulation.batch import BatchState
from ..support.rotation import to_matrix
from .step_data import StepData
from .task import Task


class StepResult(NamedTuple):
    """Result of a step, with a row or a number for each vehicle."""

    observation: np.ndarray
    reward: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray


class Episodes:
    """Episodes of vehicles that start at `homes` (n, 3), m.

    Each vehicle has its own random generator, so the vehicles are independent.
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
        """Goals of the vehicles, world axes, m; shape (n, 3)."""
        return self._goals.copy()

    def set_seeds(self, seed: int) -> None:
        """Seed the generator of vehicle i with seed + i."""
        self._generators = [seeding.np_random(seed + i)[0] for i in range(len(self._homes))]

    def set_generators(self, generators: Sequence[np.random.Generator]) -> None:
        """Set the random generators of the vehicles."""
        self._generators = list(generators)

    def begin(self, mask: np.ndarray) -> np.ndarray:
        """Start the episodes of some vehicles, and return the seeds of their noise (n,)."""
        seeds = np.zeros(len(mask), np.uint64)
        for i in np.flatnonzero(mask):
            draw = self._generators[i]
            seeds[i] = draw.integers(2**63)
            self._goals[i] = self._homes[i] + self._task.rules.spread * draw.uniform(-1, 1, 3)
        self._action[mask] = 0
        self._count[mask] = 0
        return seeds

    def observe(self, state: BatchState) -> np.ndarray:
        """Return the observations at the start of an episode."""
        nobody = np.zeros(len(self._homes), bool)
        return self._task.observe(self._make_step(state, self._action, lost=nobody))

    def finish_step(
        self, state: BatchState, actions: np.ndarray, failed: np.ndarray, begun: np.ndarray
    ) -> StepResult:
        """Return the results of actions; new episodes (`begun`) ignore their actions."""
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
            to_matrix(state.orientation),
            state.linear_velocity,
            state.angular_velocity,
            state.rotor_velocity,
            action,
            self._action,
            lost,
        )
