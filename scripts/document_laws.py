#!/usr/bin/env python3
"""Measure the tracking errors of the controllers: ``scripts/document`` runs it. Takes a minute."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Iterator, List

from measured import figures, put
from noise import NOISY, THESIS

import quadcore as qc

ENGINES = [name for name, _ in qc.engines()]
WIND = "plugins:\n  drone_plugin: {dragModel: chapter2}\n  wind: {velocity: [3, 0, 0]}\n"


def millimetres(error: float) -> str:
    """Write an error (m) in mm."""
    return figures(1e3 * error, 3 if error < 1 else 4)


def fly(
    law: str, reference: str, measure: str = "final_position", slow: int = 1, **options: Any
) -> List[str]:
    """Fly in each engine: the largest error of all seeds (mm), or when the vehicle was lost."""
    found = qc.evaluate(law, reference, ENGINES, xacro_args={"sim_slow": slow}, **options)
    cells = []
    for engine in ENGINES:
        rows = [row for row in found.table if row["engine"] == engine]
        lost = [row["failure"].split(",")[0].replace("t = ", "") for row in rows if row["failure"]]
        cells.append(lost[0] if lost else millimetres(max(row[measure] for row in rows)))
    return cells


def vehicles() -> Iterator[Any]:
    """Fly others than the quadrotor, a small one on small references."""
    for vehicle, size in (("hexarotor", ""), ("crazyflie", ":radius=0.5")):
        for reference in ("spiral", "circle"):
            flown = fly("geometric", f"{reference}{size}", models=vehicle, duration=15)
            yield f"`{vehicle}`", f"`{reference}{size}`", *flown


def reached(wind: Path) -> Iterator[Any]:
    """Fly each law on what tells it from the others."""
    for law in ("geometric", "lqr", "indi", "pd_compensated", "pd", "pid"):
        yield "`spiral`", f"`{law}`", *fly(law, "spiral")
    law = "geometric:believed_thrust=1.1"
    yield "`spiral`", f"`{law}`", *fly(law, "spiral")
    for law in ("geometric", "geometric:rate_damping=0.81", "pd_compensated", "pd"):
        yield "`circle`", f"`{law}`", *fly(law, "circle")
    yield "`eight`", "`geometric`", *fly("geometric", "eight")
    whole = fly("geometric", "waypoints", "max_position", duration=12)
    yield "`waypoints`, whole flight", "`geometric`", *whole
    for law in ("geometric", "lqr", "indi"):
        yield "`hover`, 3 m/s of wind", f"`{law}`", *fly(law, "hover", vary={"scenario": [wind]})
    landed = fly("geometric", "takeoff_land", world="default")
    yield "`takeoff_land`, landed", "`geometric`", *landed


def noise() -> Iterator[Any]:
    """Fly the spiral with what the odometry gets wrong."""
    for name, noises in (("the thesis'", THESIS), ("and 5 mm/s, 5 mrad/s", NOISY)):
        yield name, *fly("geometric", "spiral", seeds=20, parameters=noises)


def printed() -> Iterator[Any]:
    """Fly the gains that the thesis prints."""
    for law in ("pid_thesis", "pid_thesis:kd_xy=2.5"):
        for slow in (1, 10):
            yield f"`{law}`", slow, *fly(law, "spiral", "max_position", slow)


def main() -> None:
    """Fly all, and write the tables."""
    engines = [f"`{engine}`" for engine in ENGINES]
    put("control.md", "vehicles", ("vehicle", "reference", *engines), vehicles())
    with tempfile.TemporaryDirectory() as folder:
        wind = Path(folder) / "wind.yaml"
        wind.write_text(WIND)
        put("control.md", "reached", ("reference", "controller", *engines), reached(wind))
    put("control.md", "noise", ("noise", *engines), noise())
    put("control.md", "printed", ("controller", "sim_slow", *engines), printed())


if __name__ == "__main__":
    main()
