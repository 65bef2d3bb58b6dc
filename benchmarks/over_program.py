"""Processor time of a step of the engine eigen over that of a program that flies a quadrotor.

    .venv/bin/python benchmarks/over_program.py PROGRAM [ROUNDS]

The program is run as `PROGRAM rk4 bench STEPS`, makes so many steps of the classical Runge-Kutta
method, and prints its processor time as `cpu_s=SECONDS`. Both fly in turns, and the median of the
ratios is told: a program written by hand for one vehicle is the floor under an engine that takes
any.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import time

import quadcore as qc

STEPS = 20_000  # short, because a processor changes its clock between slices
SPEEDS = [480, -480, 480, -480]


def of_program(program: str) -> float:
    """Seconds a step."""
    command = [program, "rk4", "bench", str(STEPS)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = re.search(r"cpu_s=(\S+)", said)
    if not found:
        raise SystemExit(f"error: {' '.join(command)} does not print cpu_s=SECONDS")
    return float(found.group(1)) / STEPS


def of_eigen(drag: str) -> float:
    """Seconds a step."""
    simulation = qc.Simulation(
        "quadrotor",
        engine="eigen",
        spawn=(0, 0, 10),
        parameters={"drone_plugin.dragModel": drag},
    )
    spent = 0.0
    for _ in range(STEPS // 2000):  # before it is far away
        simulation.reset()
        simulation.command(SPEEDS)
        start = time.thread_time()
        simulation.step(2000)
        spent += time.thread_time() - start
    return spent / STEPS


def main() -> None:
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 201
    for drag in ("chapter2", "appendix"):
        pairs = [(of_program(sys.argv[1]), of_eigen(drag)) for _ in range(rounds)]
        ratios = [eigen / program for program, eigen in pairs]
        fastest = min(eigen for _, eigen in pairs) / min(program for program, _ in pairs)
        lower, median, upper = statistics.quantiles(ratios, n=4)
        print(
            f"eigen, {drag}: {median:.3f} of the program's time (quartiles {lower:.3f}, "
            f"{upper:.3f}; of the fastest runs {fastest:.3f})"
        )


if __name__ == "__main__":
    main()
