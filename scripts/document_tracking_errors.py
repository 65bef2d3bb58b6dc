#!/usr/bin/env python3
"""Measure the tracking errors of the controllers: ``scripts/document`` runs it. Takes a minute."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any, Iterator, List

from measured import figures, put
from noise import NOISY, THESIS

import quadcore as qc

ENGINES = [name for name, _ in qc.engines()]
WIND = "plugins:\n  drone_plugin: {dragModel: chapter2}\n  wind: {velocity: [3, 0, 0]}\n"


def format_millimetres(error: float) -> str:
    """Write an error (m) in mm."""
    return figures(1e3 * error, 3 if error < 1 else 4)


def measure(
    controller: str, reference: str, column: str = "final_position", slow: int = 1, **options: Any
) -> List[str]:
    """Run in each engine; returns the maximum error of all seeds (mm), or the time of failure."""
    found = qc.evaluate(controller, reference, ENGINES, xacro_args={"sim_slow": slow}, **options)
    cells = []
    for engine in ENGINES:
        rows = [row for row in found.table if row["engine"] == engine]
        times = [re.search(r"t = ([\d.]+) s", row["failure"]) for row in rows if row["failure"]]
        failures = [f"failed at {time[1]} s" for time in times if time]
        cells.append(
            failures[0] if failures else format_millimetres(max(row[column] for row in rows))
        )
    return cells


def measure_vehicles() -> Iterator[Any]:
    """Yield the rows of other vehicles; the small one follows small references."""
    for vehicle, size in (("hexarotor", ""), ("crazyflie", ":radius=0.5")):
        for reference in ("spiral", "circle"):
            cells = measure("geometric", f"{reference}{size}", models=vehicle, duration=15)
            yield f"`{vehicle}`", f"`{reference}{size}`", *cells


def measure_controllers(wind: Path) -> Iterator[Any]:
    """Yield the rows of controllers on references that show their differences."""
    for controller in ("geometric", "lqr", "indi", "pd_compensated", "pd", "pid"):
        yield "`spiral`", f"`{controller}`", *measure(controller, "spiral")
    controller = "geometric:believed_thrust=1.1"
    yield "`spiral`", f"`{controller}`", *measure(controller, "spiral")
    for controller in ("geometric", "geometric:rate_damping=0.81", "pd_compensated", "pd"):
        yield "`circle`", f"`{controller}`", *measure(controller, "circle")
    yield "`eight`", "`geometric`", *measure("geometric", "eight")
    whole = measure("geometric", "waypoints", "max_position", duration=12)
    yield "`waypoints`, whole flight", "`geometric`", *whole
    for controller in ("geometric", "lqr", "indi"):
        yield (
            "`hover`, 3 m/s of wind",
            f"`{controller}`",
            *measure(controller, "hover", vary={"scenario": [wind]}),
        )
    landed = measure("geometric", "takeoff_land", world="default")
    yield "`takeoff_land`, landed", "`geometric`", *landed


def measure_noise() -> Iterator[Any]:
    """Yield the rows of the spiral with odometry noise."""
    for name, noises in (("thesis", THESIS), ("thesis, 5 mm/s and 5 mrad/s", NOISY)):
        yield name, *measure("geometric", "spiral", seeds=20, parameters=noises)


def measure_printed_gains() -> Iterator[Any]:
    """Yield the rows of the gains that the thesis prints."""
    for controller in ("pid_thesis", "pid_thesis:kd_xy=2.5"):
        for slow in (1, 10):
            yield f"`{controller}`", slow, *measure(controller, "spiral", "max_position", slow)


def main() -> None:
    """Run all flights and write the tables."""
    engines = [f"`{engine}`" for engine in ENGINES]
    put("tracking_errors.md", "vehicles", ("vehicle", "reference", *engines), measure_vehicles())
    with tempfile.TemporaryDirectory() as folder:
        wind = Path(folder) / "wind.yaml"
        wind.write_text(WIND)
        put(
            "tracking_errors.md",
            "controllers",
            ("reference", "controller", *engines),
            measure_controllers(wind),
        )
    put("tracking_errors.md", "noise", ("noise", *engines), measure_noise())
    put(
        "tracking_errors.md",
        "printed",
        ("controller", "sim_slow", *engines),
        measure_printed_gains(),
    )


if __name__ == "__main__":
    main()
