"""Control a vehicle of `quadcore serve` with Lee's controller.

Usage: lee_client.py PORT [REFERENCE] [SECONDS]
"""

from __future__ import annotations

import sys
from types import SimpleNamespace

from lee import Lee

import quadcore as qc
from quadcore.serve import Client


def main(port: str, reference: str = "circle:radius=1,rate=1", seconds: str = "5") -> None:
    """Command the vehicle in every step; the controller models quadcore's quadrotor."""
    wanted = qc.references.parse(reference)
    lee = Lee()
    lee.reset(qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1}))
    with Client(int(port)) as client:
        row = client.step(steps=0)
        while row[0] < float(seconds) - 1e-9:
            state = SimpleNamespace(
                position=row[1:4],
                orientation=row[4:8],
                linear_velocity=row[8:11],
                angular_velocity=row[11:14],
            )
            row = client.step(lee(row[0], state, wanted(row[0])), 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
