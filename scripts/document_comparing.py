#!/usr/bin/env python3
"""Draw the figures of docs/comparing.md into docs/images: ``scripts/document`` runs it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable, Tuple

from images import save
from matplotlib.figure import Figure

import quadcore as qc
from quadcore.report.colours import PALETTE
from quadcore.report.plots import dress, png
from quadcore.studies.flight_differences import compute_differences

ROOT = Path(__file__).resolve().parents[1]
COMMANDS = ROOT / "tests" / "data" / "gazebo11" / "commands_S5.csv"
SIM_SLOW = "drone_plugin.sim_slow,motorpid_plugin.sim_slow"
DRAGS = {"induced": 0.01, "profile": 0.005, "translational": 0.0025, "parasitic": 0.003}


def fly(vary: Any, engine: str = "eigen", **options: Any) -> qc.Comparison:
    """Simulate the comparison of the page."""
    return qc.compare("quadrotor", vary, COMMANDS, engine=engine, log_every=5, **options)


def distance(reference: qc.Log, log: qc.Log) -> Any:
    """Distance of the positions (m), for a logarithmic scale."""
    return compute_differences(reference, log)[1:, 0]


def panel(axes: Any, title: str, curves: Iterable[Tuple[Any, Any, int, str]]) -> None:
    """Draw curves, each named where it ends."""
    for time, values, colour, name in curves:
        axes.plot(time, values, color=PALETTE[colour], linewidth=1.4, label=name)
    axes.set_title(title, loc="left", fontsize="medium")
    axes.set_xlabel("time (s)")
    axes.set_xlim(0, 10)
    dress(axes)


def figure() -> Tuple[Figure, Any]:
    """Make two panels side by side."""
    both = Figure(figsize=(8, 2.9), dpi=110)
    margins = {"left": 0.07, "right": 0.98, "top": 0.9, "bottom": 0.16, "wspace": 0.2}
    return both, both.subplots(1, 2, gridspec_kw=margins)


def draw_sim_slow() -> None:
    """Draw the distance from sim_slow 1 in two engines."""
    drawn, panels = figure()
    for axes, engine in zip(panels, ("gazebo11", "eigen")):
        first, *others = fly({SIM_SLOW: [1, 2, 5, 10]}, engine).logs
        curves = [
            (log.time[1:], distance(first, log), i, f"sim_slow {slow}")
            for i, (log, slow) in enumerate(zip(others, (2, 5, 10)))
        ]
        panel(axes, f"{engine}: distance from sim_slow 1 (m)", curves)
        axes.set_yscale("log")
        axes.set_ylim(1e-5, 30)
    panels[0].legend(frameon=False, loc="upper left", fontsize="small")
    save("comparing_sim_slow", png(drawn))


def draw_drags() -> None:
    """Draw the distance from the flight with all drags when one is off, and the speed."""
    drawn, (apart, speed) = figure()
    distances, speeds = [], []
    for i, (name, value) in enumerate(DRAGS.items()):
        options = {"xacro_args": {"sim_slow": 1}}
        all_drags, without = fly({f"drone_plugin.{name}DragCoeff": [value, 0]}, **options).logs
        time = without.time[1:]
        distances.append((time, distance(all_drags, without), i, f"no {name} drag"))
        if not speeds:
            speeds.append((all_drags.time, norm(all_drags), 6, "all drags"))
        speeds.append((without.time, norm(without), i, f"no {name} drag"))
    panel(apart, "distance from the flight with all (m)", distances)
    apart.set_yscale("log")
    apart.set_ylim(1e-5, 60)
    panel(speed, "speed (m/s)", speeds)
    speed.legend(frameon=False, loc="upper left", fontsize="small")
    save("comparing_drags", png(drawn))


def norm(log: qc.Log) -> Any:
    """Speed of the frame (m/s)."""
    return (log.linear_velocity**2).sum(axis=1) ** 0.5


def draw_gain() -> None:
    """Draw how the motor gain changes the start and the rest."""
    drawn, (rotor, height) = figure()
    gains = (0.00025, 0.0005, 0.001, 0.005)
    logs = fly({"motorpid_plugin.kp": gains}, xacro_args={"sim_slow": 1}).logs
    speeds = [(log.time, log.rotor_velocity[:, 0], i, "") for i, log in enumerate(logs)]
    panel(rotor, "rotor 1 (rad/s), the first half second", speeds)
    rotor.set_xlim(0, 0.5)
    heights = [
        (log.time, log.position[:, 2], i, f"kp {gain:g}")
        for i, (log, gain) in enumerate(zip(logs, gains))
    ]
    panel(height, "height (m)", heights)
    height.legend(frameon=False, loc="lower left", fontsize="small")
    save("comparing_gain", png(drawn))


if __name__ == "__main__":
    draw_sim_slow()
    draw_drags()
    draw_gain()
