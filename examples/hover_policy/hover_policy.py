"""Train a policy that hovers, by a search over its weights: a minute on one core.

    python hover_policy.py [--generations N] [--out policy.npy]

CMA-ES (Hansen, arXiv:1604.00772) samples policies around the best. Each policy controls a few
vehicles of one batch, from one start to different goals. The policies with the most reward guide
the next sample. A policy is a matrix: its product with the observation, clipped to [-1, 1], is the
action. Install the requirements with ``pip install 'quadcore[gym,tune]'``.
"""

from __future__ import annotations

import argparse
from typing import Any, Callable

import cma
import numpy as np

import quadcore as qc
import quadcore.gym

OBSERVATION = ("body_error", "body_velocity", "up", "rates")
WIDTH, ROTORS = 12, 4
RULES = {
    "observation": OBSERVATION,
    "reward": {"near": 1.0, "distance": 0.2, "turning": 0.02, "lost": 100.0},
    "rate": 50.0,
    "duration": 4.0,
    "xacro_args": {"sim_slow": 1},
    "parameters": {"drone_plugin.dragModel": "chapter2"},
}
POLICIES, GOALS = 32, 8  # policies of a generation, goals of a policy


def act(weights: np.ndarray, observations: np.ndarray) -> np.ndarray:
    """Return actions; weights are (policies, rotors, width), a policy's rows are adjacent."""
    rows = observations.reshape(len(weights), -1, WIDTH)
    actions = np.clip(np.einsum("prw,pgw->pgr", weights, rows), -1, 1)
    return actions.reshape(-1, ROTORS)


def fly_episodes(envs: quadcore.gym.VectorEnv, weights: np.ndarray, seed: int) -> np.ndarray:
    """Run an episode of every vehicle; return the mean return of each policy."""
    observations, _ = envs.reset(seed=seed)
    total, flies = np.zeros(envs.num_envs), np.ones(envs.num_envs, bool)
    while flies.any():
        observations, rewards, terminated, truncated, _ = envs.step(act(weights, observations))
        total += flies * rewards
        flies &= ~(terminated | truncated)
    return total.reshape(len(weights), -1).mean(axis=1)


def train(
    generations: int = 120, seed: int = 1, report: Callable[[int, float], Any] = lambda *_: None
) -> np.ndarray:
    """Search for the weights of a policy; returns them, (rotors, width)."""
    envs = quadcore.gym.VectorEnv(POLICIES * GOALS, threads=1, **RULES)
    options = {"popsize": POLICIES, "seed": seed, "verbose": -9}
    search = cma.CMAEvolutionStrategy(np.zeros(ROTORS * WIDTH), 0.2, options)
    for generation in range(generations):
        tried = search.ask()
        weights = np.reshape(tried, (POLICIES, ROTORS, WIDTH))
        rewards = fly_episodes(envs, weights, seed=1000 * generation)
        search.tell(tried, list(-rewards))
        report(generation, rewards.max())
    return np.reshape(search.mean, (ROTORS, WIDTH))


def measure_distances(weights: np.ndarray, vehicles: int = 100, seed: int = 10**6) -> np.ndarray:
    """Return the final distance of each vehicle from its goal, m; infinite if terminated."""
    envs = quadcore.gym.VectorEnv(vehicles, **RULES)
    observations, _ = envs.reset(seed=seed)
    lost = np.zeros(vehicles, bool)
    for _ in range(envs.task.actions):
        actions = act(weights[None], observations)
        observations, _, terminated, _, _ = envs.step(actions)
        lost |= terminated
    away = np.linalg.norm(envs.batch.state.position - envs.goals, axis=1)
    return np.where(lost, np.inf, away)


def main() -> None:
    """Train, report the final distances, and write the weights."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--generations", type=int, default=120)
    parser.add_argument("--out", default="policy.npy")
    arguments = parser.parse_args()

    def report(generation: int, best: float) -> None:
        if generation % 10 == 0:
            print(f"generation {generation:4d}: best reward {best:8.1f}", flush=True)

    try:
        weights = train(arguments.generations, report=report)
    except qc.QuadcoreError as error:
        raise SystemExit(f"error: {error}") from None
    away = measure_distances(weights)
    print(
        f"terminated {np.isinf(away).sum()} of {len(away)}; median distance {np.median(away):.3f} m"
    )
    np.save(arguments.out, weights)
    print(f"written {arguments.out}")


if __name__ == "__main__":
    main()
