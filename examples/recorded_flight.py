"""Compare every engine with a recording of real Gazebo 11.

Usage: recorded_flight.py OUT
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import quadcore as qc

DATA = Path(__file__).resolve().parent.parent / "tests" / "data" / "gazebo11"
COMMANDS = DATA / "commands_S5.csv"
RECORDING = DATA / "S5_slow1_all.csv.gz"


def main(out: Path) -> None:
    """Simulate the manoeuvre, print a table, and write logs and plots."""
    recording = np.loadtxt(RECORDING, delimiter=",", skiprows=1)
    table = Table(title="10 s of commands_S5, the thesis' quadrotor, sim_slow 1")
    for heading in (
        "engine",
        "from Gazebo 11: maximum (m)",
        "at 10 s (m)",
        "steps/s",
        "x real time",
    ):
        table.add_column(heading, justify="right", no_wrap=True)
    written = []
    for engine, _ in qc.engines():
        sim = qc.Simulation("quadrotor", engine=engine, xacro_args={"sim_slow": 1})
        begin = time.perf_counter()
        log = sim.run(10.0, commands=COMMANDS)
        elapsed = time.perf_counter() - begin
        rows = np.searchsorted(log.time, recording[:, 0] - sim.dt / 2)
        distance = np.linalg.norm(log.position[rows] - recording[:, 1:4], axis=1)
        steps = len(log.time) - 1
        table.add_row(
            engine,
            f"{distance.max():.2g}",
            f"{distance[-1]:.2g}",
            f"{steps / elapsed:,.0f}",
            f"{steps * sim.dt / elapsed:,.0f}",
        )
        folder = out / engine
        folder.mkdir(parents=True, exist_ok=True)
        log.to_csv(folder / "log.csv")
        written += log.plot(folder)
    console = Console(width=None if sys.stdout.isatty() else 120)
    console.print(table)
    console.print(
        "gazebo11 reproduces the recording, including its artificial damping of roll and pitch.\n"
        "The other engines do not have that bug, so their flights differ."
    )
    console.print(f"{len(written)} plots and {len(qc.engines())} logs are in {out}/")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
