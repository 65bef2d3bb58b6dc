#!/usr/bin/env python3
"""Fit simulated flights with noise, and compare errors with the stated standard deviations.

usage: benchmarks/fit_uncertainty.py [coverage | noise]

``coverage`` fits the hard manoeuvre with many noise realisations, and prints how often the stated
95 % range contains the true value. ``noise`` fits slow circles and the hard manoeuvre with growing
noise of the rotor speeds, and prints the errors in stated standard deviations.
"""

from __future__ import annotations

import math
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np

import quadcore as qc
from quadcore.studies.fit.recorded import fit_recordings

SEEDS = 40
TRUE = {"frame.ixx": 1.6e-5, "frame.iyy": 1.7e-5, "frame.izz": 2.6e-5}
NOISE = {"position": 5e-4, "rates": 0.05}  # m, rad/s
COLUMNS = {"position": slice(1, 4), "rates": slice(11, 14), "rotors": slice(14, 18)}
NORMAL = 1.959964  # quantile of 95 %


class Excited:
    """The geometric controller with sines on top of its commands."""

    rate = 100.0

    def __init__(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        self.controller = qc.controllers.geometric(rate=self.rate)
        self.phases = random.uniform(0, 2 * np.pi, (4, 4))
        self.rates = random.uniform(1, 6, (4, 4))  # Hz

    def reset(self, simulation: Any) -> None:
        """Start a flight."""
        self.controller.reset(simulation)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Return the commands."""
        sines = np.sin(2 * np.pi * self.rates * t + self.phases).sum(axis=1)
        return self.controller(t, state, reference) * (1 + 0.01 * sines)


def fly(manoeuvre: str) -> qc.Log:
    """Simulate a vehicle with the true parameters for 10 s."""
    parameters = {name: repr(value) for name, value in TRUE.items()}
    simulation = qc.Simulation("crazyflie", engine="eigen", parameters=parameters, spawn=(0, 0, 2))
    if manoeuvre == "hard manoeuvre":
        controller, reference = Excited(0), "eight"
    else:
        controller, reference = qc.controllers.geometric(), "circle:radius=0.5"
    return simulation.run(10, controller=controller, reference=reference, log_every=10)


def fit(flown: qc.Log, rotor_noise: float, seed: int) -> Iterator[Tuple[str, float, float]]:
    """Yield each parameter with its relative error and its error in stated deviations."""
    table = flown.table.copy()
    random = np.random.default_rng(seed)
    for name, noise in {**NOISE, "rotors": rotor_noise}.items():
        columns = COLUMNS[name]
        table[:, columns] += random.normal(0, noise, table[:, columns].shape)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "flight.csv"
        qc.Log(table).to_csv(path)
        found = fit_recordings("crazyflie", [path], free=list(TRUE)).found
    for name, true in TRUE.items():
        error = found.values[name] - true
        yield name, error / true, error / found.deviations[name]


def measure_coverage() -> None:
    """Print the part of the stated 95 % ranges that contain the true value."""
    flown = fly("hard manoeuvre")
    scores: Dict[str, List[float]] = {name: [] for name in TRUE}
    for seed in range(SEEDS):
        for name, _, score in fit(flown, 5.0, seed):
            scores[name].append(score)
        known = [s for each in scores.values() for s in each if math.isfinite(s)]
        inside = np.mean(np.abs(known) < NORMAL)
        print(f"{seed + 1} seeds: {100 * inside:.1f} % of {len(known)} ranges", flush=True)
    for name, each in scores.items():
        print(f"{name}: {100 * np.mean(np.abs(each) < NORMAL):.0f} %, RMS {np.std(each):.2f}")


def measure_noise() -> None:
    """Print the errors of fits to flights with growing noise of the rotor speeds."""
    cases = [("slow circle", noise) for noise in (0.0, 2.0, 5.0, 20.0)]
    for manoeuvre, noise in [*cases, ("hard manoeuvre", 5.0)]:
        flown = fly(manoeuvre)
        for name, relative, score in fit(flown, noise, 1):
            text = f"{100 * relative:.2g} %, {score:.2g} deviations"
            text = text if math.isfinite(score) else "not identifiable"
            print(f"{manoeuvre}, {noise:g} rad/s: {name} {text}", flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore", qc.QuadcoreWarning)
    {"coverage": measure_coverage, "noise": measure_noise}[(sys.argv[1:] or ["coverage"])[0]]()
